#pragma once

#include <concepts>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "scenes/format/document.h"
#include "scenes/format/keys.h"

namespace toile::scene_format {

// Values. Each reads `json`, found at `place`, into `value`, or refuses it with the allowed values.
// A range of null allows every number.

void read_value(const Document& document, const Json& json, const std::string& place, bool& value);
void read_value(const Document& document, const Json& json, const std::string& place, std::string& value);
void read_value(const Document& document, const Json& json, const std::string& place,
                std::filesystem::path& value);
void read_value(const Document& document, const Json& json, const std::string& place, double& value,
                const Range& range);
void read_value(const Document& document, const Json& json, const std::string& place, int& value,
                const Range& range);
/// `count` numbers.
void read_numbers(const Document& document, const Json& json, const std::string& place, double* values,
                  int count, const Range& range);
/// The index of the word in `words`.
size_t read_word(const Document& document, const Json& json, const std::string& place,
                 const std::vector<std::string>& words);
/// @throws InvalidInput when `json` is not an object or has a key that is not in `keys`.
void require_object(const Document& document, const Json& json, const std::string& place,
                    const std::vector<std::string>& keys);
void require_array(const Document& document, const Json& json, const std::string& place);

/// Visitor that fills an object from JSON.
class Reader {
public:
    Reader(const Document& document, const Json& object, std::string place)
        : document_(document), object_(object), place_(std::move(place))
    {
    }

    template <typename T>
    void field(const char* key, T& value, const char*)
    {
        if (object_.contains(key))
            read(object_[key], below(place_, key), value);
    }

    template <typename T>
    void field(const char* key, T& value, const Range& range, const char*)
    {
        if (object_.contains(key))
            read(object_[key], below(place_, key), value, range);
    }

    template <typename T, typename... Rest>
    void required(const char* key, T& value, const Rest&... rest)
    {
        require_key(key);
        field(key, value, rest...);
    }

    void number_or_off(const char* key, std::optional<double>& value, const Range& range, const char*);
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
    /// Refuses none and more than one of `keys`.
    void require_one(const std::vector<std::string>& keys) const;

    template <typename Variant, typename T>
    void choose(Variant& variant, const Alternative<T>& alternative)
    {
        if (!object_.contains(alternative.key))
            return;
        const Json& json = object_[alternative.key];
        const std::string place = below(place_, alternative.key);
        T& value = variant.template emplace<T>();
        if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<Vec3>>)
            read(json, place, value, alternative.range);
        else
            read(json, place, value);
    }

    // Scalars and text end in read_value().
    template <typename T, typename... R>
    requires requires(const Document& d, const Json& j, T& v, const R&... r)
    {
        read_value(d, j, std::string(), v, r...);
    }
    void read(const Json& json, const std::string& place, T& value, const R&... range)
    {
        read_value(document_, json, place, value, range...);
    }

    template <int kSize>
    void read(const Json& json, const std::string& place, Eigen::Matrix<double, kSize, 1>& value,
              const Range& range)
    {
        read_numbers(document_, json, place, value.data(), kSize, range);
    }

    template <typename E>
    requires std::is_enum_v<E>
    void read(const Json& json, const std::string& place, E& value)
    {
        std::vector<std::string> words;
        words.reserve(std::size(Words<E>::kAll));
        for (const auto& entry : Words<E>::kAll)
            words.emplace_back(entry.first);
        value = Words<E>::kAll[read_word(document_, json, place, words)].second;
    }

    template <typename T, typename... R>
    void read(const Json& json, const std::string& place, std::optional<T>& value, const R&... range)
    {
        read(json, place, value.emplace(), range...);
    }

    template <typename T, typename... R>
    void read(const Json& json, const std::string& place, std::vector<T>& values, const R&... range)
    {
        require_array(document_, json, place);
        values.resize(json.size());
        for (size_t i = 0; i < values.size(); ++i)
            read(json[i], below(place, i), values[i], range...);
    }

    template <typename T>
    void read(const Json& json, const std::string& place, std::map<std::string, T>& values)
    {
        if (!json.is_object())
            document_.refuse(place, as_written(json) + " is not an object; write {\"name\": {...}}");
        for (const auto& [name, member] : json.items())
            read(member, below(place, name), values[name]);
    }

    // Described structs.
    template <typename T>
    requires requires(KeyCollector& v, T& object) { describe(v, object); }
    void read(const Json& json, const std::string& place, T& value)
    {
        require_object(document_, json, place, keys_of<T>());
        Reader reader(document_, json, place);
        describe(reader, value);
    }

    const Document& document_;
    const Json& object_;
    std::string place_;
};

} // namespace toile::scene_format
