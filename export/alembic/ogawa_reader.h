#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "export/alembic/ogawa_file.h"

namespace toile::exports {

/// Reads the nodes of an Ogawa file. Sizes are checked against the file before memory is taken.
class OgawaReader {
public:
    /// @throws InvalidInput for a file that is no Ogawa, or was never completed
    explicit OgawaReader(const std::filesystem::path& file);

    OgawaNode root() const { return root_; }
    static bool is_data(OgawaNode node) { return (node & kOgawaData) != 0; }

    /// @throws InvalidInput for data, or for a node that leaves the file
    std::vector<OgawaNode> group(OgawaNode node) const;

    /// Size of data [bytes]; its bytes; `count` of them from `first` on.
    /// @throws InvalidInput for a group, or for a node that leaves the file
    std::uint64_t size(OgawaNode node) const;
    std::string data(OgawaNode node) const { return data(node, 0, size(node)); }
    std::string data(OgawaNode node, std::uint64_t first, std::uint64_t count) const;

    /// Refuses the file, naming the byte of a node.
    [[noreturn]] void refuse(OgawaNode node, const std::string& why) const;
    const std::filesystem::path& path() const { return file_.path(); }

private:
    std::uint64_t word_at(std::uint64_t offset) const;
    std::uint64_t count_at(OgawaNode node, std::uint64_t size_of_item) const;

    BinaryFile file_;
    std::uint64_t size_;
    OgawaNode root_;
};

} // namespace toile::exports
