#pragma once

#include <filesystem>
#include <string>

#include "export/cache_writer.h"
#include "export/usd/usd_writer.h"

namespace toile::exports {

/// Writes a cache as one binary USD file without value clips. Frames wait in a .usda beside it, which Python
/// with USD converts at the end.
class UsdcWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer(), and where there is no Python with USD.
    UsdcWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override { frames_.write(frame, sample); }
    std::filesystem::path complete() override;
    void keep() override { frames_.keep(); }
    int readable_samples() const override { return frames_.readable_samples(); }
    void publish() override;
    std::filesystem::path partial() const override { return frames_.partial(); }

    /// The .usda: skirt.usdc.usda, which is never published.
    static std::filesystem::path waiting(const std::filesystem::path& file);

private:
    std::filesystem::path file_, partial_;
    UsdWriter frames_;
};

} // namespace toile::exports
