#include "avatars/import/gltf_json.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

/// The value in a few words.
std::string as_written(const GltfValue::Json& json)
{
    constexpr size_t kLongest = 60;
    if (json.is_structured())
        return json.is_array() ? "[...]" : "{...}";
    const std::string text = json.dump(-1, ' ', false, GltfValue::Json::error_handler_t::replace);
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

} // namespace

std::string GltfValue::place_and_value() const { return place() + " = " + as_written(*json_); }

void GltfValue::refuse(const std::string& why) const { throw InvalidInput(place_and_value() + ": " + why); }

GltfValue GltfValue::at(const std::string& key) const
{
    if (const std::optional<GltfValue> value = find(key))
        return *value;
    throw InvalidInput(*source_ + ": " + place_below(key) + " is missing");
}

std::optional<GltfValue> GltfValue::find(const std::string& key) const
{
    if (!json_->is_object())
        refuse("must be an object");
    const auto value = json_->find(key);
    if (value == json_->end())
        return std::nullopt;
    return GltfValue(*source_, *value, place_below(key));
}

GltfValue GltfValue::list(const std::string& key) const
{
    static const Json kEmpty = Json::array();
    const std::optional<GltfValue> value = find(key);
    if (!value)
        return {*source_, kEmpty, place_below(key)};
    value->array();
    return *value;
}

std::vector<std::string> GltfValue::keys() const
{
    if (!json_->is_object())
        refuse("must be an object");
    std::vector<std::string> keys;
    for (const auto& [key, value] : json_->items())
        keys.push_back(key);
    return keys;
}

const GltfValue::Json& GltfValue::array() const
{
    if (!json_->is_array())
        refuse("must be an array");
    return *json_;
}

int GltfValue::size() const { return int(array().size()); }

GltfValue GltfValue::operator[](int i) const
{
    return {*source_, array()[size_t(i)], place_ + "[" + std::to_string(i) + "]"};
}

std::uint64_t GltfValue::whole(std::uint64_t lower, std::uint64_t upper) const
{
    // JSON does not tell 3 from 3.0. Doubles hold whole numbers up to 2^53, more than any file has bytes.
    const double value = json_->is_number() ? json_->get<double>() : -1.0;
    if (!(value >= double(lower) && value <= double(upper)) || value != std::floor(value))
        refuse("must be a whole number from " + std::to_string(lower) + " to " + std::to_string(upper));
    return std::uint64_t(value);
}

int GltfValue::index(int count, const std::string& of_what) const
{
    if (!json_->is_number() || json_->get<double>() != std::floor(json_->get<double>()))
        refuse("must be the index of one of " + std::to_string(count) + " " + of_what);
    const double value = json_->get<double>();
    if (!(value >= 0.0 && value < count))
        refuse("index " + as_written(*json_) + " is out of bounds of " + std::to_string(count) + " " +
               of_what);
    return int(value);
}

bool GltfValue::flag() const
{
    if (!json_->is_boolean())
        refuse("must be true or false");
    return json_->get<bool>();
}

double GltfValue::number() const
{
    if (!json_->is_number())
        refuse("must be a number");
    return json_->get<double>();
}

const std::string& GltfValue::text() const
{
    if (!json_->is_string())
        refuse("must be a text");
    return json_->get_ref<const std::string&>();
}

std::string GltfValue::name_or(const std::string& otherwise) const
{
    const std::optional<GltfValue> name = find("name");
    if (!name || name->text().empty())
        return otherwise;
    std::string line = name->text();
    std::replace_if(
        line.begin(), line.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    return line;
}

std::vector<double> GltfValue::numbers() const
{
    std::vector<double> numbers;
    for (const Json& number : array()) {
        if (!number.is_number())
            refuse("must be an array of numbers; it has " + as_written(number));
        numbers.push_back(number.get<double>());
    }
    return numbers;
}

std::vector<double> GltfValue::numbers(int count) const
{
    if (size() != count)
        refuse("must have " + std::to_string(count) + " numbers, not " + std::to_string(size()));
    return numbers();
}

} // namespace toile::avatars
