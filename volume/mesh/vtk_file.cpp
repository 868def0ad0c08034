#include "volume/mesh/vtk_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/number.h"

namespace toile::volume {

namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string in_lower_case(std::string_view word)
{
    std::string lower(word);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return char(std::tolower(letter)); });
    return lower;
}

template <typename Stored>
Stored from_big_endian(const char* bytes)
{
    std::array<char, sizeof(Stored)> ordered;
    std::memcpy(ordered.data(), bytes, sizeof(Stored));
    if constexpr (std::endian::native == std::endian::little)
        std::reverse(ordered.begin(), ordered.end());
    return std::bit_cast<Stored>(ordered);
}

std::string in_quotes(std::string_view word)
{
    constexpr size_t kLongest = 40;
    return word.empty() ? "the end of the file" : "'" + std::string(word.substr(0, kLongest)) + "'";
}

} // namespace

VtkFile::VtkFile(const std::filesystem::path& file) : file_(file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be opened; check the path and its permissions");
    text_.assign(std::istreambuf_iterator<char>(stream), {});
    if (text_.starts_with(kByteOrderMark))
        at_ = kByteOrderMark.size();
    if (!in_lower_case(std::string_view(text_).substr(at_, 40)).starts_with("# vtk datafile"))
        refuse("not a legacy VTK file; its first line begins with '# vtk DataFile'");
    take_line();
    take_line(); // title
    const std::string coding = word();
    if (coding != "ascii" && coding != "binary")
        refuse(in_quotes(coding) + " where ASCII or BINARY should stand");
    is_binary_ = coding == "binary";
}

void VtkFile::refuse(const std::string& why) const
{
    const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
    throw InvalidInput(file_.string() + ":" +
                       (has_read_binary_ ? " byte " + std::to_string(at_) : std::to_string(line)) + ": " +
                       why);
}

std::string_view VtkFile::take_line()
{
    const size_t begin = at_;
    const size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
    const bool is_both = std::string_view(text_).substr(end).starts_with("\r\n");
    at_ = std::min(end + (is_both ? 2 : 1), text_.size());
    return std::string_view(text_).substr(begin, end - begin);
}

std::string_view VtkFile::take_word()
{
    constexpr const char* kBlank = " \t\r\n";
    at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
    const size_t begin = at_;
    at_ = std::min(text_.find_first_of(kBlank, begin), text_.size());
    return std::string_view(text_).substr(begin, at_ - begin);
}

std::string VtkFile::word() { return in_lower_case(take_word()); }

bool VtkFile::is_next(const std::string& keyword)
{
    const size_t before = at_;
    const bool is_same = word() == keyword;
    at_ = before;
    return is_same;
}

void VtkFile::expect(const std::string& keyword)
{
    if (const std::string_view found = take_word(); in_lower_case(found) != in_lower_case(keyword))
        refuse(in_quotes(found) + " where " + keyword + " should stand");
}

std::string VtkFile::dataset()
{
    expect("DATASET");
    return word();
}

std::string VtkFile::section()
{
    for (;;) {
        std::string name = word();
        if (name == "metadata")
            skip_metadata();
        else if (name == "field")
            skip_field();
        else
            return name;
    }
}

/// To the empty line that ends it.
void VtkFile::skip_metadata()
{
    take_line();
    while (!take_line().empty()) {
    }
}

void VtkFile::skip_field()
{
    take_word(); // its name
    for (std::int64_t arrays = count(); arrays > 0; --arrays) {
        if (is_next("metadata")) {
            take_word();
            skip_metadata();
        }
        take_word(); // the array's name
        const std::int64_t components = count(), tuples = count();
        const std::string type = word();
        if (components > 0 && tuples > std::int64_t(text_.size()) / components)
            refuse("a field announces more numbers than the file has bytes");
        if (type != "string" || is_binary_) {
            numbers(components * tuples, type);
            continue;
        }
        take_line();
        for (std::int64_t i = 0; i < components * tuples; ++i)
            take_line();
    }
}

std::int64_t VtkFile::count()
{
    const std::string_view found = take_word();
    const std::optional<std::int64_t> value = whole_number_in(found);
    if (!value || *value < 0 || *value > std::int64_t(text_.size()))
        refuse(in_quotes(found) + " where a count should stand, of at most the file's " +
               std::to_string(text_.size()) + " bytes");
    return *value;
}

std::vector<double> VtkFile::numbers(std::int64_t count, const std::string& type)
{
    return values<double>(count, type);
}

std::vector<std::int64_t> VtkFile::whole_numbers(std::int64_t count, const std::string& type)
{
    return values<std::int64_t>(count, type);
}

template <typename Number, typename Stored>
std::vector<Number> VtkFile::binary_values(std::int64_t count)
{
    take_line(); // the rest of the header's
    has_read_binary_ = true;
    const std::int64_t available = std::int64_t((text_.size() - at_) / sizeof(Stored));
    if (count > available)
        refuse(std::to_string(count) + " numbers are announced, the file ends after " +
               std::to_string(available));
    std::vector<Number> result;
    result.reserve(size_t(count));
    for (std::int64_t i = 0; i < count; ++i, at_ += sizeof(Stored)) {
        const Stored value = from_big_endian<Stored>(text_.data() + at_);
        if constexpr (std::is_floating_point_v<Stored>)
            if (!std::isfinite(value))
                refuse("number " + std::to_string(i + 1) + " of the " + std::to_string(count) +
                       " announced is not finite");
        result.push_back(Number(value));
    }
    return result;
}

template <typename Number>
std::vector<Number> VtkFile::values(std::int64_t count, const std::string& type)
{
    constexpr bool kIsWhole = std::is_integral_v<Number>;
    if (is_binary_) {
        if constexpr (!kIsWhole) {
            if (type == "float" || type == "vtktypefloat32")
                return binary_values<Number, float>(count);
            if (type == "double" || type == "vtktypefloat64")
                return binary_values<Number, double>(count);
        }
        if (type == "int" || type == "unsigned_int" || type == "vtkidtype" || type == "vtktypeint32")
            return binary_values<Number, std::int32_t>(count);
        if (type == "long" || type == "unsigned_long" || type == "vtktypeint64")
            return binary_values<Number, std::int64_t>(count);
        if (type == "char" || type == "unsigned_char")
            return binary_values<Number, std::int8_t>(count);
        if (type == "short" || type == "unsigned_short")
            return binary_values<Number, std::int16_t>(count);
        refuse(in_quotes(type) + " is a type that is not read; save the file in ASCII");
    }
    std::vector<Number> result;
    for (std::int64_t i = 0; i < count; ++i) {
        const std::string_view found = take_word();
        std::optional<Number> value;
        if constexpr (kIsWhole)
            value = whole_number_in(found);
        else
            value = number_in(found);
        if (!value)
            refuse(in_quotes(found) + (kIsWhole ? " is not a whole number" : " is not a finite number") +
                   "; it is number " + std::to_string(i + 1) + " of the " + std::to_string(count) +
                   " announced");
        result.push_back(*value);
    }
    return result;
}

} // namespace toile::volume
