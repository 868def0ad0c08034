#pragma once

#include <nlohmann/json.hpp>

#include "scenes/format/describe.h"

namespace toile::scene_format {

using OrderedJson = nlohmann::ordered_json;

template <typename T>
OrderedJson object_schema(const T& defaults);

OrderedJson number_schema(const char* type, const Range& range);

/// Visitor that collects the schema of an object; defaults are the values of the visited object.
class SchemaWriter {
public:
    template <typename T>
    void field(const char* key, T& value, const char* help)
    {
        add(key, value_schema(value), help);
    }
    template <typename T>
    void field(const char* key, T& value, const Range& range, const char* help)
    {
        add(key, value_schema(value, range), with_unit(help, range));
    }
    template <typename T, typename... Rest>
    void required(const char* key, T& value, const Rest&... rest)
    {
        field(key, value, rest...);
        properties_[key].erase("default");
        required_.push_back(key);
    }
    void number_or_off(const char* key, std::optional<double>& value, const Range& range, const char* help)
    {
        OrderedJson schema = {{"anyOf", {number_schema("number", range), {{"const", "off"}}}}};
        schema["default"] = value ? OrderedJson(*value) : OrderedJson("off");
        add(key, schema, with_unit(help, range));
    }
    void number_or_quotient(const char* key, double& value, const Range& range, const char* help)
    {
        OrderedJson schema = {{"anyOf", {number_schema("number", range), {{"type", "string"}}}}};
        schema["default"] = value;
        add(key, schema, with_unit(help, range));
    }
    void names(const char* key, std::vector<std::string>&, const char* help)
    {
        const OrderedJson name = {{"type", "string"}};
        add(key, {{"anyOf", {name, {{"type", "array"}, {"items", name}}}}}, help);
    }
    template <typename T>
    void number_or_object(const char* key, std::optional<T>&, double T::*, const Range& range,
                          const char* help)
    {
        add(key, {{"anyOf", {number_schema("number", range), object_schema(T())}}}, with_unit(help, range));
    }
    void pair(const char* key, WarpWeft& value, const Range& range, const char* help)
    {
        SchemaWriter threads;
        threads.field("warp", value.warp, range, "Along the warp.");
        threads.field("weft", value.weft, range, "Along the weft.");
        add(key, threads.schema(), with_unit(help, range));
    }
    void version(const char* key, int number, const char* help)
    {
        add(key, {{"const", number}}, help);
        required_.push_back(key);
    }
    template <typename Variant, typename... T>
    void one_of(Variant&, const Alternative<T>&... alternatives)
    {
        (add_alternative(alternatives), ...);
    }

    OrderedJson schema() const;

private:
    template <typename T>
    void add_alternative(const Alternative<T>& alternative)
    {
        OrderedJson schema;
        if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<Vec3>>)
            schema = bare_schema<T>(alternative.range);
        else
            schema = bare_schema<T>();
        add(alternative.key, schema, alternative.help);
        one_of_.push_back({{"required", {alternative.key}}});
    }

    /// Schema of a value. Numbers, texts and words have `value` as their default; objects have the defaults
    /// of their members; lists, maps and files have none.
    /// @param range  of numbers; omitted for other types
    template <typename T, typename... R>
    static OrderedJson value_schema(const T& value, const R&... range)
    {
        if constexpr (std::is_same_v<T, bool>)
            return {{"type", "boolean"}, {"default", value}};
        else if constexpr (std::is_same_v<T, std::string>)
            return {{"type", "string"}, {"default", value}};
        else if constexpr (std::is_same_v<T, std::filesystem::path>)
            return {{"type", "string"}};
        else if constexpr (std::is_arithmetic_v<T>) {
            OrderedJson schema = number_schema(std::is_integral_v<T> ? "integer" : "number", range...);
            schema["default"] = value;
            return schema;
        } else if constexpr (std::is_enum_v<T>)
            return words_schema(value);
        else
            return compound_schema(value, range...);
    }

    template <typename E>
    static OrderedJson words_schema(const E& value)
    {
        OrderedJson schema;
        for (const auto& [word, meaning] : Words<E>::kAll) {
            schema["enum"].push_back(word);
            if (meaning == value)
                schema["default"] = word;
        }
        return schema;
    }

    template <int kSize>
    static OrderedJson compound_schema(const Eigen::Matrix<double, kSize, 1>& value, const Range& range)
    {
        return {{"type", "array"},
                {"items", number_schema("number", range)},
                {"minItems", kSize},
                {"maxItems", kSize},
                {"default", std::vector<double>(value.data(), value.data() + kSize)}};
    }

    /// Schema without default: an absent value has a meaning of its own.
    template <typename T, typename... R>
    static OrderedJson bare_schema(const R&... range)
    {
        OrderedJson schema = value_schema(T(T{}), range...);
        schema.erase("default");
        return schema;
    }

    template <typename T, typename... R>
    static OrderedJson compound_schema(const std::optional<T>&, const R&... range)
    {
        return bare_schema<T>(range...);
    }

    template <typename T, typename... R>
    static OrderedJson compound_schema(const std::vector<T>&, const R&... range)
    {
        return {{"type", "array"}, {"items", bare_schema<T>(range...)}};
    }

    template <typename T>
    static OrderedJson compound_schema(const std::map<std::string, T>&)
    {
        return {{"type", "object"}, {"additionalProperties", object_schema(T())}};
    }

    template <typename T>
    static OrderedJson compound_schema(const T& value)
    {
        return object_schema(value);
    }

    static std::string with_unit(const char* help, const Range& range)
    {
        return *range.unit == '\0' ? help : std::string(help) + " [" + range.unit + "]";
    }

    void add(const char* key, const OrderedJson& schema, const std::string& help);

    OrderedJson properties_ = OrderedJson::object();
    OrderedJson required_ = OrderedJson::array();
    OrderedJson one_of_ = OrderedJson::array();
};

template <typename T>
OrderedJson object_schema(const T& defaults)
{
    T object = defaults;
    SchemaWriter writer;
    describe(writer, object);
    return writer.schema();
}

/// JSON Schema (draft 2020-12) of the files that T describes, as text ending in a newline.
template <typename T>
std::string document_schema(const T& defaults, const char* title, const char* description)
{
    OrderedJson schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                          {"title", title},
                          {"description", description}};
    schema.update(object_schema(defaults));
    schema["properties"]["$schema"] = {{"description", "This schema, for editors."}, {"type", "string"}};
    return schema.dump(2) + "\n";
}

} // namespace toile::scene_format
