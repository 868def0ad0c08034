#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "export/binary_file.h"

namespace toile::exports {

/// Place of a node in an Ogawa file: the offset of a group, or of data with bit 63 set. An empty group has
/// the offset 0, empty data as well.
using OgawaNode = std::uint64_t;
inline constexpr OgawaNode kOgawaData = OgawaNode{1} << 63, kOgawaNothing = 0;

/// Appends nodes to a file in Ogawa, the container of Alembic: a tree of groups whose leaves are data
/// [Alembic 1.8, lib/Alembic/Ogawa]. Integers are little endian.
///
///   0 "Ogawa"  5 0xff: complete  6 {0, 1} version  8 u64 offset of the root group
///   group: u64 n, n nodes        data: u64 size, bytes
///
/// Nodes are never changed. set_root() makes the file complete with the tree below a new root; a process that
/// is killed later leaves it so, with what it appended since behind the tree.
class OgawaFile {
public:
    /// Creates the file, or empties it. Readers refuse it until set_root().
    explicit OgawaFile(const std::filesystem::path& file);

    OgawaNode add_data(std::string_view bytes);
    OgawaNode add_group(std::span<const OgawaNode> children);
    void set_root(OgawaNode group);
    void sync() { file_.sync(); }

    /// @throws DeviceError if the path does not lead to this file any more
    void require_in_place() const { file_.require_in_place(); }

private:
    std::uint64_t place() const { return written_ + waiting_.size(); }
    void flush();

    BinaryFile file_;
    std::uint64_t written_ = 0; ///< [bytes]
    std::string waiting_;       ///< bytes behind them
};

} // namespace toile::exports
