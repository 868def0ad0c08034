#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "export/ply/ply_header.h"

namespace toile::exports {

/// Values of a PLY file behind its header, one after the other, whatever their encoding.
class PlyValues {
public:
    /// @param bytes  of the whole file, which outlive this
    PlyValues(const std::filesystem::path& file, const PlyHeader& header, std::string_view bytes)
        : file_(file), encoding_(header.encoding), bytes_(bytes), at_(header.size)
    {
    }

    /// Refuses an element of more values than the rest of the file can hold.
    void require_room(const PlyElement& element) const;

    /// @throws InvalidInput naming the byte, for this and the others: the end of the file, or no number
    double scalar(PlyType type);
    void list(const PlyProperty& property, std::vector<double>& values);

    /// Reads a property without use: words of text may be any.
    void skip(const PlyProperty& property);

    [[noreturn]] void refuse(const std::string& why) const;

private:
    std::size_t room() const { return bytes_.size() - at_; }
    std::size_t smallest_size(PlyType type) const;
    std::size_t count_of(const PlyProperty& property);
    std::string_view word();

    template <typename T>
    double binary();

    const std::filesystem::path& file_;
    PlyHeader::Encoding encoding_;
    std::string_view bytes_;
    std::size_t at_;
};

} // namespace toile::exports
