#pragma once

#include <filesystem>

#include "export/cache_writer.h"
#include "export/gltf/principal_shapes.h"
#include "export/pc2/pc2_writer.h"

namespace toile::exports {

/// Most morph targets of a file: beyond that graphics programs become slow or refuse.
inline constexpr int kMaxGlbShapes = 64;

/// Writes a cache as a binary glTF file: at most 64 shapes with weights, as many as keep every vertex within
/// CacheLayout::max_error of its place in every frame.
///
/// The shapes need all frames, which are therefore stored in a PC2 (skirt.glb.partial.pc2). complete() reads
/// them several times and writes skirt.partial.glb; in memory are the shapes alone.
class GlbWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    GlbWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override { frames_.write(frame, sample); }

    /// @throws InvalidInput also if 64 shapes do not keep to the error: the number that would be needed, and
    ///         the error that can be kept
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return frames_.partial(); }
    int readable_samples() const override { return frames_.readable_samples(); }
    std::string note() const override { return note_; }

private:
    ShapeAnimation shapes_of(const FrameSource& source) const;

    std::filesystem::path file_;
    CacheLayout layout_;
    std::filesystem::path converted_; ///< the GLB until publish()
    Pc2Writer frames_;
    std::string note_;
};

} // namespace toile::exports
