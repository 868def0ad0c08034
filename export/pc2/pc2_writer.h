#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "export/binary_file.h"
#include "export/cache_writer.h"
#include "export/frame_order.h"

namespace toile::exports {

/// Size of a PC2 header [bytes], little endian:
///   0 "POINTCACHE2\0"   12 int version = 1     16 int points
///  20 float start frame 24 float sample rate   28 int samples
/// Samples of points x 3 floats follow. The sample rate is the length of a sample in frames.
inline constexpr int kPc2HeaderSize = 32;
inline constexpr int kPc2SampleCountAt = 28;

/// Appends frames to a PC2 whose header counts completed frames only, so that it is valid at any moment.
class Pc2Writer final : public CacheWriter {
public:
    /// @param file     the cache, which publish() creates or replaces
    /// @param partial  file for the frames until then
    /// @throws InvalidInput as make_cache_writer().
    Pc2Writer(std::filesystem::path file, const std::filesystem::path& partial, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return partial_; }
    int readable_samples() const override { return order_.next(); }

private:
    void create(std::string_view first_sample);
    void keep_earlier_frames(const CacheLayout& layout);
    void set_sample_count(int samples);

    std::filesystem::path file_;
    std::filesystem::path partial_;
    FrameOrder order_;
    std::string header_;               ///< of a cache with one frame
    std::optional<BinaryFile> stream_; ///< the partial; empty before the first frame
    std::string sample_;               ///< one frame in file byte order, a member to avoid allocation
};

} // namespace toile::exports
