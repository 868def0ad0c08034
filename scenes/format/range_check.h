#pragma once

#include "scenes/format/document.h"
#include "scenes/format/keys.h"

namespace toile::scene_format {

/// Visitor that compares the numbers and enumerators of an object with what a file may contain.
class RangeCheck {
public:
    RangeCheck(const Document& document, std::string key_path)
        : document_(document), key_path_(std::move(key_path))
    {
    }

    template <typename T>
    void field(const char* key, T& value, const char*)
    {
        check(value, below(key_path_, key));
    }
    template <typename T>
    void field(const char* key, T& value, const Range& range, const char*)
    {
        check(value, below(key_path_, key), range);
    }
    template <typename T, typename... Rest>
    void required(const char* key, T& value, const Rest&... rest)
    {
        field(key, value, rest...);
    }
    void number_or_off(const char* key, std::optional<double>& value, const Range& range, const char*)
    {
        check(value, below(key_path_, key), range);
    }
    template <typename T>
    void number_or_object(const char* key, std::optional<T>& value, double T::*, const Range&, const char*)
    {
        check(value, below(key_path_, key));
    }
    void number_or_quotient(const char* key, double& value, const Range& range, const char*)
    {
        check(value, below(key_path_, key), range);
    }
    void names(const char*, std::vector<std::string>&, const char*) {}
    void pair(const char* key, WarpWeft& value, const Range& range, const char*)
    {
        check(value.warp, below(below(key_path_, key), "warp"), range);
        check(value.weft, below(below(key_path_, key), "weft"), range);
    }
    void version(const char*, int, const char*) {}

    template <typename Variant, typename... A>
    void one_of(Variant& variant, const A&... alternatives)
    {
        (check_alternative(variant, alternatives), ...);
    }

private:
    template <typename Variant, typename T>
    void check_alternative(Variant& variant, const Alternative<T>& alternative)
    {
        T* value = std::get_if<T>(&variant);
        if (value == nullptr)
            return;
        const std::string key_path = below(key_path_, alternative.key);
        if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<Vec3>>)
            check(*value, key_path, alternative.range);
        else
            check(*value, key_path);
    }

    void check(bool, const std::string&) {}
    void check(const std::string&, const std::string&) {}
    void check(const std::filesystem::path& file, const std::string& key_path)
    {
        if (file.empty())
            document_.refuse(key_path, "the path is empty; name a file");
    }

    template <typename Number>
    requires std::is_same_v<Number, int> || std::is_same_v<Number, double>
    void check(Number value, const std::string& key_path, const Range& range)
    {
        if (!range.contains(value))
            document_.refuse(key_path,
                             as_written(value) + " is out of range; give a number " + to_sentence(range));
    }

    template <int kSize>
    void check(const Eigen::Matrix<double, kSize, 1>& value, const std::string& key_path, const Range& range)
    {
        for (int i = 0; i < kSize; ++i)
            check(value[i], below(key_path, size_t(i)), range);
    }

    template <typename E>
    requires std::is_enum_v<E>
    void check(E value, const std::string& key_path)
    {
        for (const auto& entry : Words<E>::kAll)
            if (entry.second == value)
                return;
        document_.refuse(key_path, "enumerator " + std::to_string(int(value)) + " does not exist");
    }

    template <typename T, typename... R>
    void check(std::optional<T>& value, const std::string& key_path, const R&... range)
    {
        if (value)
            check(*value, key_path, range...);
    }

    template <typename T, typename... R>
    void check(std::vector<T>& values, const std::string& key_path, const R&... range)
    {
        for (size_t i = 0; i < values.size(); ++i)
            check(values[i], below(key_path, i), range...);
    }

    template <typename T>
    void check(std::map<std::string, T>& values, const std::string& key_path)
    {
        for (auto& [name, value] : values)
            check(value, below(key_path, name));
    }

    // Described structs.
    template <typename T>
    requires requires(KeyCollector& v, T& object) { describe(v, object); }
    void check(T& value, const std::string& key_path)
    {
        RangeCheck nested(document_, key_path);
        describe(nested, value);
    }

    const Document& document_;
    std::string key_path_;
};

} // namespace toile::scene_format
