#pragma once

#include <filesystem>

#include "export/cache_writer.h"
#include "export/pc2_writer.h"

namespace toile::exports {

/// Lightwave MDD, big endian: int frames, int points, float times[frames] [s], then frames x points x 3
/// floats.
///
/// The times precede the first frame, so an unfinished MDD can't be valid for fewer frames than planned. The
/// frames are therefore stored in a PC2, and finish() copies them; both formats store the same floats.
class MddWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    MddWriter(std::filesystem::path file, const std::filesystem::path& partial, const CacheLayout& layout);

    void write(int frame, View<const Vec3> positions) override { frames_.write(frame, positions); }
    void finish() override;
    std::filesystem::path partial() const override { return frames_.partial(); }

private:
    std::filesystem::path file_;
    CacheLayout layout_;
    std::filesystem::path complete_; ///< finished PC2, source of the copy
    Pc2Writer frames_;
};

} // namespace toile::exports
