#include "export/ply/ply_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/error.h"
#include "core/base/number.h"
#include "export/byte_order.h"

namespace toile::exports {

void PlyValues::refuse(const std::string& why) const
{
    throw InvalidInput(file_.string() + ": " + why + " (byte " + std::to_string(at_) + ")");
}

/// [bytes] A number in text has a digit, and a space behind it.
std::size_t PlyValues::smallest_size(PlyType type) const
{
    return encoding_ == PlyHeader::Encoding::Ascii ? 2 : std::size_t(size_of(type));
}

void PlyValues::require_room(const PlyElement& element) const
{
    std::size_t size = 0; // smallest of an element
    for (const PlyProperty& property : element.properties)
        size += smallest_size(property.count_type.value_or(property.type));
    if (size > 0 && std::size_t(element.count) > (room() + 1) / size)
        refuse("the header promises " + std::to_string(element.count) + " elements \"" + element.name +
               "\", for which the file is too short; export it again");
}

double PlyValues::scalar(PlyType type)
{
    if (encoding_ == PlyHeader::Encoding::Ascii) {
        const std::string_view text = word();
        const std::optional<double> number = number_in(text);
        if (!number)
            refuse("what is there is no finite number; export it again");
        at_ += text.size();
        return *number;
    }
    switch (type) {
    case PlyType::Int8:
        return binary<std::int8_t>();
    case PlyType::Uint8:
        return binary<std::uint8_t>();
    case PlyType::Int16:
        return binary<std::int16_t>();
    case PlyType::Uint16:
        return binary<std::uint16_t>();
    case PlyType::Int32:
        return binary<std::int32_t>();
    case PlyType::Uint32:
        return binary<std::uint32_t>();
    case PlyType::Float32:
        return binary<float>();
    case PlyType::Float64:
        return binary<double>();
    }
    return 0.0;
}

template <typename T>
double PlyValues::binary()
{
    if (room() < sizeof(T))
        refuse("ends within its values; export it again");
    char word[sizeof(T)];
    std::copy_n(bytes_.data() + at_, sizeof(T), word);
    if (encoding_ == PlyHeader::Encoding::BigEndian)
        std::reverse(word, word + sizeof(T));
    at_ += sizeof(T);
    return double(take<T>(word));
}

/// The next one of a text.
std::string_view PlyValues::word()
{
    constexpr std::string_view kSpace = " \t\r\n";
    at_ = std::min(bytes_.find_first_not_of(kSpace, at_), bytes_.size());
    if (room() == 0)
        refuse("ends within its values; export it again");
    const std::size_t end = std::min(bytes_.find_first_of(kSpace, at_), bytes_.size());
    return bytes_.substr(at_, end - at_);
}

std::size_t PlyValues::count_of(const PlyProperty& property)
{
    const double count = scalar(*property.count_type);
    if (!(count >= 0.0) || count != std::floor(count) ||
        count > double((room() + 1) / smallest_size(property.type)))
        refuse("a list \"" + property.name + "\" can't have " + std::to_string(count) +
               " values; export it again");
    return std::size_t(count);
}

void PlyValues::list(const PlyProperty& property, std::vector<double>& values)
{
    values.resize(count_of(property));
    for (double& value : values)
        value = scalar(property.type);
}

void PlyValues::skip(const PlyProperty& property)
{
    std::size_t count = property.count_type ? count_of(property) : 1;
    for (; count > 0; --count)
        if (encoding_ == PlyHeader::Encoding::Ascii)
            at_ += word().size();
        else
            scalar(property.type);
}

} // namespace toile::exports
