#pragma once

#include <filesystem>

#include "export/archive/frame_velocities.h"
#include "export/cache_writer.h"
#include "export/frame_order.h"
#include "export/sequence/mesh_files.h"
#include "export/vtk/pvd_file.h"
#include "export/vtk/vtu_file.h"

namespace toile::exports {

/// Writes a cache for ParaView: a .vtu for each frame, numbered from the layout's start frame, and skirt.pvd,
/// which lists them with their times. All wait in the folder skirt.partial/, with a list of the frames so
/// far. With velocities a frame is written when the next one arrives. Texture coordinates and groups are not
/// written.
class VtkWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    VtkWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void keep() override;
    void publish() override;
    std::filesystem::path partial() const override { return files_.partial(); }
    int readable_samples() const override { return written_; }

private:
    void write_frame(const MovingSample& sample);

    std::filesystem::path file_;
    CacheLayout layout_; ///< without faces
    FrameOrder order_;
    VtuFile mesh_;
    MeshSequenceCache files_;
    PvdFile list_;
    FrameVelocities moving_;
    View<const Vec3> velocities_; ///< of the frame that is being written
    int written_ = 0;
};

} // namespace toile::exports
