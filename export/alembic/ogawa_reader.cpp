#include "export/alembic/ogawa_reader.h"

#include "core/base/error.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::uint64_t kHeader = 16;

} // namespace

OgawaReader::OgawaReader(const std::filesystem::path& file)
    : file_(file, BinaryFile::Mode::Read), size_(std::uint64_t(file_.size()))
{
    std::string head(size_t(std::min(size_, kHeader)), '\0');
    file_.read_at(0, head.data(), head.size());
    if (head.starts_with("\x89HDF"))
        throw InvalidInput(file.string() + ": is an Alembic archive of the old HDF5 kind; convert it to "
                                           "Ogawa, the kind that programs write by default since 2013, with "
                                           "abcconvert -toOgawa");
    if (head.size() < kHeader || !head.starts_with("Ogawa"))
        throw InvalidInput(file.string() +
                           ": does not start with Ogawa (byte 0); this is no Alembic archive");
    if (head[5] != '\xff')
        throw InvalidInput(file.string() +
                           ": its writer has not completed it (byte 5); export the archive again");
    root_ = word_at(8);
}

void OgawaReader::refuse(OgawaNode node, const std::string& why) const
{
    throw InvalidInput(path().string() + ": byte " + std::to_string(node & ~kOgawaData) + ": " + why +
                       "; export the archive again");
}

std::uint64_t OgawaReader::word_at(std::uint64_t offset) const
{
    std::string bytes(8, '\0');
    file_.read_at(std::int64_t(offset), bytes.data(), bytes.size());
    return take<std::uint64_t>(bytes.data());
}

/// Number of items of a node that lie within the file.
std::uint64_t OgawaReader::count_at(OgawaNode node, std::uint64_t size_of_item) const
{
    const std::uint64_t offset = node & ~kOgawaData;
    if (offset < kHeader || offset > size_ || size_ - offset < 8)
        refuse(node, "a node lies outside the file of " + std::to_string(size_) + " bytes");
    const std::uint64_t count = word_at(offset);
    if (count > (size_ - offset - 8) / size_of_item)
        refuse(node, "a node ends beyond the file of " + std::to_string(size_) + " bytes");
    return count;
}

std::vector<OgawaNode> OgawaReader::group(OgawaNode node) const
{
    if (is_data(node))
        refuse(node, "is data where a group should be");
    if (node == kOgawaNothing)
        return {};
    const std::uint64_t count = count_at(node, sizeof(OgawaNode));
    std::string bytes(size_t(count) * sizeof(OgawaNode), '\0');
    file_.read_at(std::int64_t(node + 8), bytes.data(), bytes.size());
    std::vector<OgawaNode> children;
    for (size_t k = 0; k < count; ++k)
        children.push_back(take<OgawaNode>(&bytes[k * sizeof(OgawaNode)]));
    return children;
}

std::uint64_t OgawaReader::size(OgawaNode node) const
{
    if (!is_data(node))
        refuse(node, "is a group where data should be");
    return node == kOgawaData ? 0 : count_at(node, 1);
}

std::string OgawaReader::data(OgawaNode node, std::uint64_t first, std::uint64_t count) const
{
    if (const std::uint64_t all = size(node); first > all || count > all - first)
        refuse(node,
               "has " + std::to_string(all) + " bytes where " + std::to_string(first + count) + " should be");
    std::string bytes(size_t(count), '\0');
    if (count > 0)
        file_.read_at(std::int64_t((node & ~kOgawaData) + 8 + first), bytes.data(), bytes.size());
    return bytes;
}

} // namespace toile::exports
