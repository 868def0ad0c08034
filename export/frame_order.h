#pragma once

#include <filesystem>

#include "core/compute/types.h"
#include "export/cache_writer.h"

namespace toile::exports {

/// Counts the frames of a cache and rejects a frame that would leave a gap.
class FrameOrder {
public:
    FrameOrder(std::filesystem::path file, const CacheLayout& layout);

    int next() const { return next_; }

    /// @throws InvalidInput unless this is the next frame, planned, and of the right size.
    void require_next(int frame, const SampleView& sample) const;
    void advance() { ++next_; }

    /// @throws InvalidInput naming the partial if frames are missing.
    void require_complete(const std::filesystem::path& partial) const;

private:
    std::filesystem::path file_;
    int vertex_count_;
    int attribute_count_;
    int frame_count_;
    int next_;
};

} // namespace toile::exports
