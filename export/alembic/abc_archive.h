#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "export/alembic/abc_mesh.h"
#include "export/archive/frame_velocities.h"
#include "export/cache_layout.h"

namespace toile::exports {

/// A new Alembic archive of moving meshes. It is readable at any moment from the second frame on: up to the
/// last frame but one for the first ten frames, then up to all but the last eleven, and beyond frame 320 all
/// but a thirtieth, because each index names all frames before it.
///
/// A frame is written when the next one arrives, which gives its velocity.
class AbcArchive {
public:
    /// Creates the file, or empties it.
    /// @param layout       with distinct names; sample k is at the time frame_of(k) / fps
    /// @param application  that writes
    /// @throws InvalidInput if it can't be opened
    AbcArchive(const std::filesystem::path& file, const CacheLayout& layout, std::string application);
    AbcArchive(const AbcArchive&) = delete;
    AbcArchive& operator=(const AbcArchive&) = delete;

    /// Appends a frame of all meshes.
    void write(const SampleView& sample);

    /// Writes what waits. Every byte is then on the disk.
    void complete();

    int readable_frames() const { return indexed_; }

private:
    void write_sample();
    void write_index();
    std::vector<AbcObject> add_objects();

    OgawaFile file_;
    CacheLayout layout_; ///< without faces
    std::string application_;
    std::vector<AbcMesh> meshes_;
    FrameVelocities moving_;
    int frames_ = 0, indexed_ = 0;
};

} // namespace toile::exports
