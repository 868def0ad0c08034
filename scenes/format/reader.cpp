#include "scenes/format/reader.h"

#include <cmath>
#include <cstdio>

#include "core/base/number.h"

namespace toile::scene_format {

namespace {

/// Shortest text that gives the number in messages: 0.01, 1000, 1e+08.
std::string short_number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

void require_in_range(const Document& document, const Json& json, const std::string& key_path,
                      const Range& range)
{
    if (!range.contains(json.get<double>()))
        document.refuse(key_path, as_written(json) + " is out of range; give a number " + to_sentence(range));
}

} // namespace

std::string to_sentence(const Range& range)
{
    const std::string unit = *range.unit == '\0' ? "" : std::string(" ") + range.unit;
    if (range.above_lower)
        return "above " + short_number(range.lower) + " and at most " + short_number(range.upper) + unit;
    return "from " + short_number(range.lower) + " to " + short_number(range.upper) + unit;
}

void read_value(const Document& document, const Json& json, const std::string& key_path, bool& value)
{
    if (!json.is_boolean())
        document.refuse(key_path, as_written(json) + " is neither true nor false; write one of the two");
    value = json.get<bool>();
}

void read_value(const Document& document, const Json& json, const std::string& key_path, std::string& value)
{
    if (!json.is_string())
        document.refuse(key_path, as_written(json) + " is not text; write it in double quotes");
    value = json.get<std::string>();
}

void read_value(const Document& document, const Json& json, const std::string& key_path,
                std::filesystem::path& value)
{
    std::string text;
    read_value(document, json, key_path, text);
    if (text.empty())
        document.refuse(key_path, "the path is empty; name a file");
    value = text;
}

void read_value(const Document& document, const Json& json, const std::string& key_path, double& value,
                const Range& range)
{
    if (!json.is_number())
        document.refuse(key_path, as_written(json) + " is not a number; give a number " + to_sentence(range));
    require_in_range(document, json, key_path, range);
    value = json.get<double>();
}

void read_value(const Document& document, const Json& json, const std::string& key_path, int& value,
                const Range& range)
{
    if (!json.is_number() || std::trunc(json.get<double>()) != json.get<double>())
        document.refuse(key_path,
                        as_written(json) + " is not a whole number; give one " + to_sentence(range));
    require_in_range(document, json, key_path, range);
    value = int(json.get<double>());
}

void read_numbers(const Document& document, const Json& json, const std::string& key_path, double* values,
                  int count, const Range& range)
{
    if (!json.is_array() || int(json.size()) != count)
        document.refuse(key_path, as_written(json) + " is not a list of " + std::to_string(count) +
                                      " numbers; write " + (count == 2 ? "[x, y]" : "[x, y, z]"));
    for (int i = 0; i < count; ++i)
        read_value(document, json[size_t(i)], below(key_path, size_t(i)), values[i], range);
}

size_t read_word(const Document& document, const Json& json, const std::string& key_path,
                 const std::vector<std::string>& words)
{
    for (size_t i = 0; i < words.size(); ++i)
        if (json.is_string() && json.get<std::string>() == words[i])
            return i;
    std::vector<std::string> choices;
    for (const std::string& word : words)
        choices.push_back(as_written(word));
    document.refuse(key_path, as_written(json) + " is unknown; write " + enumerate(choices, "or"));
}

void require_object(const Document& document, const Json& json, const std::string& key_path,
                    const std::vector<std::string>& keys)
{
    if (!json.is_object())
        document.refuse(key_path, as_written(json) + " is not an object; write {...} with keys among " +
                                      enumerate(keys, "and"));
    for (const auto& [key, member] : json.items()) {
        if (std::find(keys.begin(), keys.end(), key) != keys.end())
            continue;
        const std::string near = did_you_mean(key, keys);
        document.refuse(below(key_path, key.empty() ? "\"\"" : key),
                        "unknown key" + (near.empty() ? "; known are " + enumerate(keys, "and") : near));
    }
}

void require_array(const Document& document, const Json& json, const std::string& key_path)
{
    if (!json.is_array())
        document.refuse(key_path, as_written(json) + " is not a list; write [...]");
}

void Reader::number_or_off(const char* key, std::optional<double>& value, const Range& range, const char*)
{
    if (!object_.contains(key))
        return;
    const Json& json = object_[key];
    if (json == "off") {
        value.reset();
        return;
    }
    if (!json.is_number())
        document_.refuse(below(key_path_, key), as_written(json) +
                                                    " is neither a number nor \"off\"; give a number " +
                                                    to_sentence(range));
    read_value(document_, json, below(key_path_, key), value.emplace(), range);
}

void Reader::number_or_quotient(const char* key, double& value, const Range& range, const char*)
{
    if (!object_.contains(key))
        return;
    const Json& json = object_[key];
    const std::string key_path = below(key_path_, key);
    if (!json.is_string())
        return read_value(document_, json, key_path, value, range);
    const std::optional<double> quotient = quotient_in(json.get<std::string>());
    if (!quotient || !range.contains(*quotient))
        document_.refuse(key_path, as_written(json) + " is no such number; give one " + to_sentence(range) +
                                       ", or two as \"24000/1001\"");
    value = *quotient;
}

void Reader::names(const char* key, std::vector<std::string>& value, const char*)
{
    if (!object_.contains(key))
        return;
    const Json& json = object_[key];
    const std::string key_path = below(key_path_, key);
    if (json.is_array())
        read(json, key_path, value);
    else
        read_value(document_, json, key_path, value.emplace_back());
}

void Reader::pair(const char* key, WarpWeft& value, const Range& range, const char*)
{
    if (!object_.contains(key))
        return;
    const std::string key_path = below(key_path_, key);
    require_object(document_, object_[key], key_path, {"warp", "weft"});
    Reader reader(document_, object_[key], key_path);
    reader.field("warp", value.warp, range, "");
    reader.field("weft", value.weft, range, "");
}

void Reader::version(const char* key, int expected, const char*)
{
    require_key(key);
    if (object_[key] != expected)
        document_.refuse(below(key_path_, key), as_written(object_[key]) +
                                                    " is a version of the format that this program " +
                                                    "does not know; write " + std::to_string(expected));
}

void Reader::require_key(const char* key) const
{
    if (!object_.contains(key))
        document_.refuse(key_path_, std::string("the key ") + as_written(key) + " is missing; add it");
}

void Reader::require_one(const std::vector<std::string>& keys) const
{
    std::vector<std::string> given;
    for (const std::string& key : keys)
        if (object_.contains(key))
            given.push_back(key);
    if (given.size() == 1)
        return;
    document_.refuse(key_path_, (given.empty() ? "none of " + enumerate(keys, "and") + " is given"
                                               : enumerate(given, "and") + " exclude each other") +
                                    "; give exactly one of " + enumerate(keys, "or"));
}

} // namespace toile::scene_format
