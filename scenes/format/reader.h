#pragma once

#include <concepts>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "scenes/format/document.h"
#include "scenes/format/keys.h"

namespace toile::scene_format {

// Readers of values. Each reads `json` at `key_path` into `value`, or throws InvalidInput with the allowed
// values. A null range allows every number.

void read_value(const Document& document, const Json& json, const std::string& key_path, bool& value);
void read_value(const Document& document, const Json& json, const std::string& key_path, std::string& value);
void read_value(const Document& document, const Json& json, const std::string& key_path,
                std::filesystem::path& value);
void read_value(const Document& document, const Json& json, const std::string& key_path, double& value,
                const Range& range);
void read_value(const Document& document, const Json& json, const std::string& key_path, int& value,
                const Range& range);
/// Reads `count` numbers.
void read_numbers(const Document& document, const Json& json, const std::string& key_path, double* values,
                  int count, const Range& range);
/// Reads a word and returns its index in `words`.
size_t read_word(const Document& document, const Json& json, const std::string& key_path,
                 const std::vector<std::string>& words);
/// @throws InvalidInput if `json` is not an object or has a key that is not in `keys`.
void require_object(const Document& document, const Json& json, const std::string& key_path,
                    const std::vector<std::string>& keys);
void require_array(const Document& document, const Json& json, const std::string& key_path);

/// Visitor that fills an object from JSON.
class Reader {
public:
    Reader(const Document& document, const Json& object, std::string key_path)
        : document_(document), object_(object), key_path_(std::move(key_path))
    {
    }

    template <typename T>
    void field(const char* key, T& value, const char*)
    {
        if (object_.contains(key))
            read(object_[key], below(key_path_, key), value);
    }

    template <typename T>
    void field(const char* key, T& value, const Range& range, const char*)
    {
        if (object_.contains(key))
            read(object_[key], below(key_path_, key), value, range);
    }

    template <typename T, typename... Rest>
    void required(const char* key, T& value, const Rest&... rest)
    {
        require_key(key);
        field(key, value, rest...);
    }

    void number_or_off(const char* key, std::optional<double>& value, const Range& range, const char*);
    void number_or_quotient(const char* key, double& value, const Range& range, const char*);
    void names(const char* key, std::vector<std::string>& value, const char*);
    template <typename T>
    void number_or_object(const char* key, std::optional<T>& value, double T::*number, const Range& range,
                          const char*)
    {
        if (!object_.contains(key))
            return;
        const Json& json = object_[key];
        if (json.is_object())
            read(json, below(key_path_, key), value.emplace());
        else if (json.is_number())
            read(json, below(key_path_, key), value.emplace().*number, range);
        else
            document_.refuse(below(key_path_, key), as_written(json) +
                                                        " is neither a number nor an object; give a number " +
                                                        to_sentence(range));
    }
    void pair(const char* key, WarpWeft& value, const Range& range, const char*);
    void version(const char* key, int expected, const char*);

    template <typename Variant, typename... A>
    void one_of(Variant& variant, const A&... alternatives)
    {
        require_one({alternatives.key...});
        (choose(variant, alternatives), ...);
    }

private:
    void require_key(const char* key) const;
    /// Requires exactly one of `keys`.
    void require_one(const std::vector<std::string>& keys) const;

    template <typename Variant, typename T>
    void choose(Variant& variant, const Alternative<T>& alternative)
    {
        if (!object_.contains(alternative.key))
            return;
        const Json& json = object_[alternative.key];
        const std::string key_path = below(key_path_, alternative.key);
        T& value = variant.template emplace<T>();
        if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<Vec3>>)
            read(json, key_path, value, alternative.range);
        else
            read(json, key_path, value);
    }

    // Scalars and text: read_value() above.
    template <typename T, typename... R>
    requires requires(const Document& d, const Json& j, T& v, const R&... r)
    {
        read_value(d, j, std::string(), v, r...);
    }
    void read(const Json& json, const std::string& key_path, T& value, const R&... range)
    {
        read_value(document_, json, key_path, value, range...);
    }

    template <int kSize>
    void read(const Json& json, const std::string& key_path, Eigen::Matrix<double, kSize, 1>& value,
              const Range& range)
    {
        read_numbers(document_, json, key_path, value.data(), kSize, range);
    }

    template <typename E>
    requires std::is_enum_v<E>
    void read(const Json& json, const std::string& key_path, E& value)
    {
        std::vector<std::string> words;
        words.reserve(std::size(Words<E>::kAll));
        for (const auto& entry : Words<E>::kAll)
            words.emplace_back(entry.first);
        value = Words<E>::kAll[read_word(document_, json, key_path, words)].second;
    }

    template <typename T, typename... R>
    void read(const Json& json, const std::string& key_path, std::optional<T>& value, const R&... range)
    {
        read(json, key_path, value.emplace(), range...);
    }

    template <typename T, typename... R>
    void read(const Json& json, const std::string& key_path, std::vector<T>& values, const R&... range)
    {
        require_array(document_, json, key_path);
        values.resize(json.size());
        for (size_t i = 0; i < values.size(); ++i)
            read(json[i], below(key_path, i), values[i], range...);
    }

    template <typename T>
    void read(const Json& json, const std::string& key_path, std::map<std::string, T>& values)
    {
        if (!json.is_object())
            document_.refuse(key_path, as_written(json) + " is not an object; write {\"name\": {...}}");
        for (const auto& [name, member] : json.items())
            read(member, below(key_path, name), values[name]);
    }

    // Described structs.
    template <typename T>
    requires requires(KeyCollector& v, T& object) { describe(v, object); }
    void read(const Json& json, const std::string& key_path, T& value)
    {
        require_object(document_, json, key_path, keys_of<T>());
        Reader reader(document_, json, key_path);
        describe(reader, value);
    }

    const Document& document_;
    const Json& object_;
    std::string key_path_;
};

/// The object that a whole document describes. Its key $schema, by which editors complete and check, is
/// ignored.
/// @param json  Document::parse()
template <typename T>
T read_described(const Document& document, Json json)
{
    if (json.is_object())
        json.erase("$schema");
    T object;
    require_object(document, json, "", keys_of<T>());
    Reader reader(document, json, "");
    describe(reader, object);
    return object;
}

} // namespace toile::scene_format
