#include "export/alembic/ogawa_file.h"

#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::int64_t kCompleteAt = 5, kRootAt = 8;

/// Bytes that wait at most, but for one node.
constexpr std::size_t kMaxWaiting = 1 << 20;

} // namespace

OgawaFile::OgawaFile(const std::filesystem::path& file) : file_(file, BinaryFile::Mode::Create)
{
    waiting_.assign("Ogawa\0\0\1", 8);
    append(waiting_, kOgawaNothing);
    flush();
}

OgawaNode OgawaFile::add_data(std::string_view bytes)
{
    if (bytes.empty())
        return kOgawaData;
    const OgawaNode node = kOgawaData | place();
    append(waiting_, std::uint64_t{bytes.size()});
    waiting_.append(bytes);
    if (waiting_.size() > kMaxWaiting)
        flush();
    return node;
}

OgawaNode OgawaFile::add_group(std::span<const OgawaNode> children)
{
    if (children.empty())
        return kOgawaNothing;
    const OgawaNode node = place();
    append(waiting_, std::uint64_t{children.size()});
    for (const OgawaNode child : children)
        append(waiting_, child);
    return node;
}

void OgawaFile::set_root(OgawaNode group)
{
    flush();
    std::string root;
    append(root, group);
    file_.write_at(kRootAt, root);
    file_.write_at(kCompleteAt, "\xff");
}

void OgawaFile::flush()
{
    file_.write_at(std::int64_t(written_), waiting_);
    written_ += waiting_.size();
    waiting_.clear();
}

} // namespace toile::exports
