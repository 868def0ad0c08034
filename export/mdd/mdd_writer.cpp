#include "export/mdd/mdd_writer.h"

#include <string>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "export/binary_file.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::endian kBig = std::endian::big;

std::string mdd_header(const CacheLayout& layout)
{
    std::string header(8 + 4 * std::size_t(layout.frame_count), '\0');
    put<kBig>(&header[0], std::int32_t{layout.frame_count});
    put<kBig>(&header[4], std::int32_t{layout.vertex_count()});
    for (int frame = 0; frame < layout.frame_count; ++frame)
        put<kBig>(&header[8 + 4 * std::size_t(frame)], float(layout.frame_of(frame) / layout.fps));
    return header;
}

} // namespace

MddWriter::MddWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), layout_(layout), converted_(partial_beside(file_)),
      frames_(file_, file_.string() + ".partial.pc2", layout)
{
    layout_.meshes.front().faces = {};
}

std::filesystem::path MddWriter::complete()
{
    const BinaryFile source(frames_.complete(), BinaryFile::Mode::Read);
    try {
        convert(source);
    } catch (...) {
        std::error_code missing;
        std::filesystem::remove(converted_, missing);
        throw;
    }
    return converted_;
}

/// Copies the frames in the other byte order.
void MddWriter::convert(const BinaryFile& source) const
{
    BinaryFile target(converted_, BinaryFile::Mode::Create);
    const std::string header = mdd_header(layout_);
    target.write_at(0, header);

    std::string sample(12 * std::size_t(layout_.vertex_count()), '\0');
    for (int frame = 0; frame < layout_.frame_count; ++frame) {
        const std::int64_t offset = std::int64_t(sample.size()) * frame;
        source.read_at(kPc2HeaderSize + offset, sample.data(), sample.size());
        for (std::size_t at = 0; at < sample.size(); at += 4)
            put<kBig>(&sample[at], get<std::endian::little, std::uint32_t>(&sample[at]));
        target.write_at(std::int64_t(header.size()) + offset, sample);
    }
    target.sync();
}

void MddWriter::publish()
{
    move_into_place(converted_, file_);
    std::error_code gone_already;
    std::filesystem::remove(partial(), gone_already);
}

} // namespace toile::exports
