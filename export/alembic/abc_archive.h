#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "export/alembic/abc_mesh.h"

namespace toile::exports {

/// A new Alembic archive of moving meshes. It is readable at any moment from the second frame on: up to the
/// last frame but one for the first ten frames, then up to all but the last eleven, and beyond frame 320 all
/// but a thirtieth, because each index names all frames before it.
///
/// Velocities are central differences, so that a frame is written when the next one arrives; the first and
/// the last are one-sided.
class AbcArchive {
public:
    struct Layout {
        double fps = 24.0;        ///< [frames/s]
        double start_frame = 0.0; ///< of the first frame; its time is start_frame / fps
        std::string application;  ///< that writes
        std::vector<std::string> names;
        std::vector<ObjMesh> faces; ///< [names] positions are ignored
    };

    /// Creates the file, or empties it.
    /// @throws InvalidInput if it can't be opened, or two names become one
    AbcArchive(const std::filesystem::path& file, const Layout& layout);

    /// Appends a frame. @param positions  [meshes][vertices] [m]
    void write(std::vector<std::vector<Vec3>> positions);

    /// Writes what waits. Every byte is then on the disk.
    void complete();

private:
    void write_waiting(const std::vector<std::vector<Vec3>>& next);
    void write_index();

    OgawaFile file_;
    Layout layout_;
    std::vector<AbcMesh> meshes_;
    std::vector<std::vector<Vec3>> before_, waiting_; ///< frames; empty: none
    int frames_ = 0, indexed_ = 0;
};

} // namespace toile::exports
