#include "export/pc2/pc2_writer.h"

#include <array>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/byte_order.h"
#include "export/point_cache.h"

namespace toile::exports {

namespace {

constexpr std::endian kLittle = std::endian::little;

std::string header_of_one_frame(const CacheLayout& layout)
{
    std::string header = "POINTCACHE2"; // terminated by a zero byte from the padding
    header.resize(kPc2HeaderSize, '\0');
    put<kLittle>(&header[12], std::int32_t{1});
    put<kLittle>(&header[16], std::int32_t{layout.vertex_count()});
    put<kLittle>(&header[20], float(layout.start_frame));
    put<kLittle>(&header[24], float(1.0 / layout.subframes));
    put<kLittle>(&header[kPc2SampleCountAt], std::int32_t{1});
    return header;
}

} // namespace

Pc2Writer::Pc2Writer(std::filesystem::path file, const std::filesystem::path& partial,
                     const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial), order_(file_, layout), header_(header_of_one_frame(layout)),
      sample_(12 * std::size_t(layout.vertex_count()), '\0')
{
    require_writable(partial_);
    if (layout.resume_at > 0)
        keep_earlier_frames(layout);
}

/// The file appears with its first frame: it is readable from the beginning, and until then the partial of an
/// earlier run stays.
void Pc2Writer::create(std::string_view first_sample)
{
    write_atomically(partial_, std::array<std::string_view, 2>{header_, first_sample});
    stream_.emplace(partial_, BinaryFile::Mode::Continue);
}

void Pc2Writer::keep_earlier_frames(const CacheLayout& layout)
{
    stream_.emplace(partial_, BinaryFile::Mode::Continue);
    const PointCache earlier = read_cache(partial_);
    if (earlier.vertex_count() != layout.vertex_count() || earlier.frame_count() < layout.resume_at)
        throw InvalidInput(partial_.string() + ": holds " + std::to_string(earlier.frame_count()) +
                           " frames of " + std::to_string(earlier.vertex_count()) +
                           " vertices; resuming at " + std::to_string(layout.resume_at) +
                           " needs that many frames of " + std::to_string(layout.vertex_count()) +
                           " vertices; start the run anew");
    set_sample_count(layout.resume_at);
    stream_->resize(kPc2HeaderSize + std::int64_t(sample_.size()) * layout.resume_at);
}

void Pc2Writer::set_sample_count(int samples)
{
    char count[4];
    put<kLittle>(count, std::int32_t{samples});
    stream_->write_at(kPc2SampleCountAt, std::string_view(count, sizeof count));
}

void Pc2Writer::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    for (int v = 0; v < sample.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            put<kLittle>(&sample_[12 * std::size_t(v) + 4 * std::size_t(axis)],
                         float(sample.positions[v][axis]));

    if (stream_) {
        stream_->require_in_place();
        // Write the count after the data: if killed in between, the header counts only frames that exist.
        stream_->write_at(kPc2HeaderSize + std::int64_t(sample_.size()) * frame, sample_);
        set_sample_count(frame + 1);
    } else {
        create(sample_);
    }
    order_.advance();
}

std::filesystem::path Pc2Writer::complete()
{
    order_.require_complete(partial_);
    stream_->sync();
    stream_->require_in_place();
    return partial_;
}

void Pc2Writer::publish() { move_into_place(partial_, file_); }

} // namespace toile::exports
