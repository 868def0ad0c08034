#include "export/frame_order.h"

#include <string>
#include <utility>

#include "core/base/error.h"

namespace toile::exports {

FrameOrder::FrameOrder(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), vertex_count_(layout.vertex_count()),
      attribute_count_(layout.attribute_count()), frame_count_(layout.frame_count), next_(layout.resume_at)
{
}

void FrameOrder::require_next(int frame, const SampleView& sample) const
{
    if (frame != next_ || frame >= frame_count_)
        throw InvalidInput(file_.string() + ": frame " + std::to_string(frame) + " came where frame " +
                           std::to_string(next_) + " of " + std::to_string(frame_count_) +
                           " was due; write the frames in order");
    if (sample.positions.size() != vertex_count_)
        throw InvalidInput(file_.string() + ": frame " + std::to_string(frame) + " has " +
                           std::to_string(sample.positions.size()) + " vertices and the cache " +
                           std::to_string(vertex_count_) + "; a cache can't change its vertex count");
    if (sample.attributes.size() != attribute_count_)
        throw InvalidInput(file_.string() + ": frame " + std::to_string(frame) + " has " +
                           std::to_string(sample.attributes.size()) +
                           " numbers of attributes and the cache " + std::to_string(attribute_count_) +
                           "; give one for each vertex and attribute");
}

void FrameOrder::require_complete(const std::filesystem::path& partial) const
{
    if (next_ < frame_count_)
        throw InvalidInput(file_.string() + ": only " + std::to_string(next_) + " of " +
                           std::to_string(frame_count_) + " frames were written; they are kept in " +
                           partial.string());
}

} // namespace toile::exports
