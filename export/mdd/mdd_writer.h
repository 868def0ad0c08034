#pragma once

#include <filesystem>

#include "export/cache_writer.h"
#include "export/pc2/pc2_writer.h"

namespace toile::exports {

/// Lightwave MDD, big endian: int frames, int points, float times[frames] [s], then frames x points x 3
/// floats.
///
/// The times precede the first frame, so an unfinished MDD can't be valid for fewer frames than planned. The
/// frames are therefore stored in a PC2 (skirt.mdd.partial.pc2), and complete() copies them into
/// skirt.partial.mdd; both formats store the same floats.
class MddWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    MddWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override { frames_.write(frame, sample); }
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return frames_.partial(); }
    int readable_samples() const override { return frames_.readable_samples(); }

private:
    void convert(const BinaryFile& source) const;

    std::filesystem::path file_;
    CacheLayout layout_;
    std::filesystem::path converted_; ///< the MDD until publish()
    Pc2Writer frames_;
};

} // namespace toile::exports
