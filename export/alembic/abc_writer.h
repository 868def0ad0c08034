#pragma once

#include <filesystem>
#include <optional>

#include "export/alembic/abc_archive.h"
#include "export/cache_writer.h"
#include "export/frame_order.h"

namespace toile::exports {

/// Writes a cache as an Alembic archive. A mesh without a name is called as the file.
class AbcWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    AbcWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void keep() override;
    int readable_samples() const override { return archive_ ? archive_->readable_frames() : 0; }
    void publish() override;
    std::filesystem::path partial() const override { return partial_; }

private:
    std::filesystem::path file_, partial_;
    FrameOrder order_;
    CacheLayout layout_;                ///< until the first frame
    std::optional<AbcArchive> archive_; ///< in the partial; empty before the first frame
};

} // namespace toile::exports
