#include "core/quadrature/tables/table_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "core/base/atomic_file.h"

namespace toile {

namespace {

/// Raise this when the layout changes.
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kOrder = 0x01020304;
constexpr char kMagic[] = "toiletab"; // written without the terminating zero

struct Header {
    char magic[8];
    std::uint32_t version, order;
    Hash128 key, shape;
    std::uint64_t rank, leaves, near_count, far_count;
    Hash128 checksum;
};
static_assert(sizeof(Header) == 96 && std::is_trivially_copyable_v<Header>);

/// Hash of what the kernel refers to: the nodes' order and the clusters' functions.
Hash128 shape_of(const QuadratureTables& tables)
{
    Hasher hasher;
    hasher.add(tables.tree.nodes());
    hasher.add(tables.basis.leaves());
    hasher.add(tables.basis.transfers());
    return hasher.result();
}

/// Calls visit(array) for the arrays of a kernel in the file's order.
template <typename Kernel, typename Visit>
void for_each_array(Kernel& kernel, const Visit& visit)
{
    visit(kernel.near_first);
    visit(kernel.near_leaf);
    visit(kernel.far_first);
    visit(kernel.far_cluster);
    visit(kernel.near_weights);
    visit(kernel.far_weights);
}

template <typename T>
std::string_view bytes_of(const std::vector<T>& array)
{
    return {reinterpret_cast<const char*>(array.data()), array.size() * sizeof(T)};
}

Hash128 checksum_of(const Header& header, const KernelTable& kernel)
{
    Hasher hasher;
    hasher.add_bytes(&header, offsetof(Header, checksum));
    for_each_array(kernel,
                   [&](const auto& array) { hasher.add_bytes(array.data(), bytes_of(array).size()); });
    return hasher.result();
}

void resize(KernelTable& kernel, const Header& header)
{
    kernel.rank = int(header.rank);
    kernel.near_first.resize(header.leaves + 1);
    kernel.near_leaf.resize(header.near_count);
    kernel.far_first.resize(header.leaves + 1);
    kernel.far_cluster.resize(header.far_count);
    kernel.near_weights.resize(header.near_count * KernelTable::kNearWeights);
    kernel.far_weights.resize(header.far_count * header.rank * KernelTable::kTargets);
}

/// Size [bytes] of a file with this header, whose numbers are valid.
std::uint64_t file_size(const Header& header)
{
    return sizeof(Header) + 4 * (2 * (header.leaves + 1) + header.near_count + header.far_count +
                                 header.near_count * KernelTable::kNearWeights +
                                 header.far_count * header.rank * KernelTable::kTargets);
}

/// Fault of a header for these tables and a file of `size` bytes; empty if it is valid.
std::string fault_of(const Header& header, const Hash128& key, const QuadratureTables& tables,
                     std::uint64_t size)
{
    const std::uint64_t leaves = tables.tree.leaf_count(), clusters = tables.tree.cluster_count();
    if (header.key != key)
        return "holds the tables of another key";
    if (header.shape != shape_of(tables) || header.leaves != leaves ||
        header.rank != std::uint64_t(tables.basis.rank()))
        return "belongs to another tree of clusters";
    if (header.near_count > leaves * leaves || header.far_count > leaves * clusters)
        return "has impossible sizes";
    if (size != file_size(header))
        return "has " + std::to_string(size) + " bytes instead of " + std::to_string(file_size(header));
    return {};
}

/// True if `first` ascends from 0 to the size of `items`, which are all in [0, limit).
bool is_list(const std::vector<int>& first, const std::vector<int>& items, int limit)
{
    return first.front() == 0 && first.back() == int(items.size()) &&
           std::is_sorted(first.begin(), first.end()) &&
           std::all_of(items.begin(), items.end(), [&](int item) { return item >= 0 && item < limit; });
}

TableFileOutcome corrupt(std::string reason)
{
    return {TableFileOutcome::Status::Corrupt, std::move(reason)};
}

} // namespace

void write_table_file(const std::filesystem::path& file, const Hash128& key, const QuadratureTables& tables)
{
    const KernelTable& kernel = tables.kernel;
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof header.magic);
    header.version = kVersion;
    header.order = kOrder;
    header.key = key;
    header.shape = shape_of(tables);
    header.rank = std::uint64_t(kernel.rank);
    header.leaves = std::uint64_t(tables.tree.leaf_count());
    header.near_count = kernel.near_leaf.size();
    header.far_count = kernel.far_cluster.size();
    header.checksum = checksum_of(header, kernel);

    std::vector<std::string_view> pieces{{reinterpret_cast<const char*>(&header), sizeof header}};
    for_each_array(kernel, [&](const auto& array) { pieces.push_back(bytes_of(array)); });
    write_atomically(file, pieces);
}

TableFileOutcome read_table_file(const std::filesystem::path& file, const Hash128& key,
                                 QuadratureTables& tables)
{
    // Ask the open stream for the size: the name may refer to another file by then.
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream)
        return {};
    const auto size = std::uint64_t(stream.tellg());
    stream.seekg(0);
    Header header{};
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof header))
        return corrupt("is cut off");
    if (std::memcmp(header.magic, kMagic, sizeof header.magic) != 0)
        return corrupt("is no table file");
    if (header.version != kVersion || header.order != kOrder)
        return {TableFileOutcome::Status::OtherVersion, ""};
    if (const std::string fault = fault_of(header, key, tables, size); !fault.empty())
        return corrupt(fault);

    KernelTable kernel;
    resize(kernel, header);
    for_each_array(kernel, [&](auto& array) {
        stream.read(reinterpret_cast<char*>(array.data()), std::streamsize(bytes_of(array).size()));
    });
    if (!stream)
        return corrupt("can't be read to its end");
    if (checksum_of(header, kernel) != header.checksum)
        return corrupt("does not have the content that its checksum is of");
    if (!is_list(kernel.near_first, kernel.near_leaf, tables.tree.leaf_count()) ||
        !is_list(kernel.far_first, kernel.far_cluster, tables.tree.cluster_count()))
        return corrupt("points beyond its tree");
    tables.kernel = std::move(kernel);
    return {TableFileOutcome::Status::Read, ""};
}

} // namespace toile
