#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/compute/types.h"
#include "export/cache_layout.h"
#include "export/mesh/cache_sample.h"

namespace toile::exports {

/// Takes a simulation's frames in order and creates a point cache in vertex order.
///
/// Until publish() everything goes into a partial beside the cache (skirt.partial.pc2 for skirt.pc2). A cache
/// of the same name from an earlier run stays unchanged, and so does its partial until the first frame.
/// Destruction without publish() keeps the partial. It can be read at any moment, also after SIGKILL, up to
/// readable_samples(): all of PC2, MDD, OBJ, PLY and glTF; all but the last of VTK with velocities; whole
/// clips of 50 of USD, and none of a USD cache without clips; Alembic as AbcArchive says. A run that can
/// still act calls keep(), and then all can be read.
///
/// Nothing keeps a second writer of the same cache out: hold a FolderLock (folder_lock.h) where there may be
/// one.
class CacheWriter {
public:
    virtual ~CacheWriter() = default;

    /// Appends a sample. Samples come in order, from CacheLayout::resume_at on.
    /// @param sample  of all meshes; positions alone where no mesh has attributes
    /// @throws InvalidInput for a frame out of order or of another size, DeviceError if the disk refuses.
    virtual void write(int frame, const SampleView& sample) = 0;

    /// Completes the partial: every byte of the cache is on the disk.
    /// @return the complete cache under its partial name, for read_cache() where CacheFeatures::read_back
    /// @throws InvalidInput if frames are missing; the message names the partial, which is kept. DeviceError
    ///         if the disk refuses.
    virtual std::filesystem::path complete() = 0;

    /// Ends a cache early: what waits for later samples is written, so that a reader of partial() finds all.
    /// Neither write() nor complete() may follow. Not for a writer whose write() has failed.
    /// @throws DeviceError if the disk refuses
    virtual void keep() {}

    /// Samples that a reader of partial() finds now.
    virtual int readable_samples() const = 0;

    /// Moves the complete cache to its final name.
    /// @throws DeviceError if the system refuses
    virtual void publish() = 0;

    void finish()
    {
        complete();
        publish();
    }

    /// Location of the frames until complete(): a file, or a folder for a sequence.
    virtual std::filesystem::path partial() const = 0;

    /// What is to be known of a complete cache, for instance its largest error; empty: nothing.
    virtual std::string note() const { return {}; }

protected:
    CacheWriter() = default;
    CacheWriter(const CacheWriter&) = delete;
    CacheWriter& operator=(const CacheWriter&) = delete;
};

/// Creates the writer for the extension of `file`:
///   .pc2   Point Cache 2
///   .mdd   Lightwave MDD; its partial is a PC2 (skirt.mdd.partial.pc2), see docs/guide/caches.md
///   .abc   Alembic, of one or several meshes; can't be resumed
///   .usda  USD in text, of one or several meshes, with value clips beyond 50 samples; can't be resumed
///   .usdc  the same as one binary file; needs Python with USD
///   .obj   one OBJ for one frame, else a sequence: skirt.obj stands for skirt_####.obj, each # a digit
///   .ply   the same in PLY, binary
///   .glb   glTF, of one or several meshes: shapes with weights; its partial is a PC2 as that of .mdd
///   .pvd   a list of numbered .vtu files for ParaView; can't be resumed
/// @throws InvalidInput before the simulation: an unknown extension, an unwritable location, a layout
///         without vertices, frames or (all but PC2 and MDD) faces, several meshes where the format holds
///         one, attributes where it has none, panels that are not those of the faces, no cache to resume.
std::unique_ptr<CacheWriter> make_cache_writer(const std::filesystem::path& file, const CacheLayout& layout);

} // namespace toile::exports
