#include "export/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "core/base/error.h"

namespace toile::exports {

namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::Int8},
                                                                       {"int8", PlyType::Int8},
                                                                       {"uchar", PlyType::Uint8},
                                                                       {"uint8", PlyType::Uint8},
                                                                       {"short", PlyType::Int16},
                                                                       {"int16", PlyType::Int16},
                                                                       {"ushort", PlyType::Uint16},
                                                                       {"uint16", PlyType::Uint16},
                                                                       {"int", PlyType::Int32},
                                                                       {"int32", PlyType::Int32},
                                                                       {"uint", PlyType::Uint32},
                                                                       {"uint32", PlyType::Uint32},
                                                                       {"float", PlyType::Float32},
                                                                       {"float32", PlyType::Float32},
                                                                       {"double", PlyType::Float64},
                                                                       {"float64", PlyType::Float64}}};

const std::array<Axes, 4> kKnownAxes{{{"m", "y"}, {"m", "z"}, {"cm", "y"}, {"cm", "z"}}};

bool is_integer(PlyType type) { return type != PlyType::Float32 && type != PlyType::Float64; }

class HeaderReader {
public:
    HeaderReader(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    PlyHeader read()
    {
        if (next_line() != "ply")
            refuse("does not start with \"ply\"; this is no PLY file");
        PlyHeader header;
        bool has_format = false;
        while (true) {
            const std::string_view line = next_line();
            split(line);
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") {
                for (const Axes& axes : kKnownAxes)
                    if (line == axes_comment(axes))
                        header.axes = axes;
                continue;
            }
            if (words_[0] == "end_header")
                break;
            if (words_[0] == "format") {
                header.encoding = encoding();
                has_format = true;
            } else if (words_[0] == "element") {
                header.elements.push_back(element());
            } else if (words_[0] == "property" && !header.elements.empty()) {
                header.elements.back().properties.push_back(property());
            } else {
                refuse("says \"" + std::string(words_[0]) +
                       "\", where format, element, property or end_header is due");
            }
        }
        if (!has_format)
            refuse("ends a header without a line \"format\"; export it again");
        header.size = at_;
        return header;
    }

private:
    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InvalidInput(file_.string() + ":" + std::to_string(line_) + ": " + why);
    }

    std::string_view next_line()
    {
        ++line_;
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos)
            refuse("ends within the header, before end_header; export it again");
        std::string_view line = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (line.ends_with('\r'))
            line.remove_suffix(1);
        return line;
    }

    void split(std::string_view line)
    {
        words_.clear();
        while (!line.empty()) {
            const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
            line.remove_prefix(begin);
            const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
            if (end > 0)
                words_.push_back(line.substr(0, end));
            line.remove_prefix(end);
        }
    }

    void require_words(std::size_t count) const
    {
        if (words_.size() < count)
            refuse("\"" + std::string(words_[0]) + "\" needs " + std::to_string(count - 1) +
                   " words behind it");
    }

    PlyHeader::Encoding encoding() const
    {
        require_words(2);
        if (words_[1] == "ascii")
            return PlyHeader::Encoding::Ascii;
        if (words_[1] == "binary_little_endian")
            return PlyHeader::Encoding::LittleEndian;
        if (words_[1] == "binary_big_endian")
            return PlyHeader::Encoding::BigEndian;
        refuse("unknown format \"" + std::string(words_[1]) +
               "\"; known are ascii, binary_little_endian and binary_big_endian");
    }

    PlyElement element() const
    {
        require_words(3);
        PlyElement element{std::string(words_[1]), 0, {}};
        const std::string_view count = words_[2];
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc{} || end != count.data() + count.size() || element.count < 0 ||
            element.count > std::numeric_limits<int>::max())
            refuse("\"" + std::string(count) + "\" is no number of elements");
        return element;
    }

    PlyType type(std::string_view word) const
    {
        const auto known = std::find_if(kTypes.begin(), kTypes.end(),
                                        [&](const auto& entry) { return entry.first == word; });
        if (known == kTypes.end())
            refuse("unknown type \"" + std::string(word) + "\"");
        return known->second;
    }

    PlyProperty property() const
    {
        require_words(3);
        if (words_[1] != "list")
            return {std::string(words_[2]), type(words_[1]), std::nullopt};
        require_words(5);
        const PlyType count_type = type(words_[2]);
        if (!is_integer(count_type))
            refuse("a list is counted by " + std::string(words_[2]) + "; it must be an integer");
        return {std::string(words_[4]), type(words_[3]), count_type};
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    std::size_t at_ = 0;
    int line_ = 0;
    std::vector<std::string_view> words_; ///< of the line
};

} // namespace

int size_of(PlyType type)
{
    switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
        return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
        return 2;
    case PlyType::Int32:
    case PlyType::Uint32:
    case PlyType::Float32:
        return 4;
    case PlyType::Float64:
        return 8;
    }
    return 0;
}

int PlyElement::find(const std::vector<std::string>& names, bool is_list) const
{
    for (std::size_t k = 0; k < properties.size(); ++k)
        if (properties[k].count_type.has_value() == is_list &&
            std::find(names.begin(), names.end(), properties[k].name) != names.end())
            return int(k);
    return -1;
}

std::string axes_comment(const Axes& axes) { return "comment toile, unit " + axes.unit + ", up " + axes.up; }

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes)
{
    return HeaderReader(file, bytes).read();
}

} // namespace toile::exports
