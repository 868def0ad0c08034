#include "scenes/format/schema/key_tables.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace toile::scene_format {

namespace {

using OrderedJson = nlohmann::ordered_json;

std::string path_below(const std::string& key_path, const std::string& key)
{
    return key_path.empty() ? key : key_path + "." + key;
}

std::string type_text(const OrderedJson& schema)
{
    if (schema.contains("const"))
        return "`" + schema.at("const").dump() + "`";
    if (schema.contains("enum")) {
        std::string words;
        for (const OrderedJson& word : schema.at("enum"))
            words += (words.empty() ? "" : " or ") + ("`" + word.dump() + "`");
        return words;
    }
    if (schema.contains("anyOf"))
        return type_text(schema.at("anyOf").at(0)) + " or " + type_text(schema.at("anyOf").at(1));
    const std::string type = schema.at("type");
    if (type == "array" && schema.contains("minItems"))
        return schema.at("minItems").dump() + " numbers";
    if (type == "array")
        return "list of " +
               (schema.at("items").value("type", "") == "object" ? "objects" : type_text(schema.at("items")));
    return type == "integer" ? "whole number" : type == "string" ? "text" : type;
}

std::string range_text(const OrderedJson& schema)
{
    const OrderedJson& number = schema.contains("anyOf")   ? schema.at("anyOf").at(0)
                                : schema.contains("items") ? schema.at("items")
                                                           : schema;
    if (!number.contains("maximum"))
        return "";
    const bool above = number.contains("exclusiveMinimum");
    return (above ? "> " + number.at("exclusiveMinimum").dump() + ", ≤ "
                  : number.at("minimum").dump() + " … ") +
           number.at("maximum").dump();
}

void append_table(const OrderedJson& schema, const std::string& key_path, std::string& text);

/// Appends tables of the objects nested in the value of a key.
void append_children(const OrderedJson& schema, const std::string& key_path, std::string& text)
{
    if (schema.contains("properties"))
        append_table(schema, key_path, text);
    else if (schema.contains("anyOf"))
        append_children(schema.at("anyOf").at(1), key_path, text);
    else if (schema.contains("items") && schema.at("items").contains("properties"))
        append_table(schema.at("items"), key_path + "[]", text);
    else if (schema.contains("additionalProperties") && schema.at("additionalProperties").is_object())
        append_table(schema.at("additionalProperties"), key_path + ".*", text);
}

void append_table(const OrderedJson& schema, const std::string& key_path, std::string& text)
{
    text += "\n## " + (key_path.empty() ? "The file" : "`" + key_path + "`") + "\n\n";
    if (schema.contains("oneOf")) {
        text += "Exactly one of";
        for (const OrderedJson& choice : schema.at("oneOf"))
            text += " `" + choice.at("required").at(0).get<std::string>() + "`";
        text += " is given.\n\n";
    }
    text += "| key | value | range | default | meaning |\n|---|---|---|---|---|\n";
    const OrderedJson required = schema.value("required", OrderedJson::array());
    for (const auto& [key, member] : schema.at("properties").items()) {
        const bool must = std::find(required.begin(), required.end(), key) != required.end();
        const std::string value = must                         ? "required"
                                  : member.contains("default") ? "`" + member.at("default").dump() + "`"
                                                               : "";
        for (const std::string& cell : {"`" + key + "`", type_text(member), range_text(member), value,
                                        member.at("description").get<std::string>()})
            text.append("| ").append(cell).append(" ");
        text += "|\n";
    }
    for (const auto& [key, member] : schema.at("properties").items())
        append_children(member, path_below(key_path, key), text);
}

} // namespace

std::string key_tables(const std::string& schema, const std::string& heading, const std::string& command)
{
    std::string text = "# " + heading + "\n\nMade by `" + command +
                       "` from the description that the "
                       "reader uses. Lengths are in metres, times in seconds\nunless a range says otherwise; "
                       "`[]` stands for the entries of a list, `*` for a name.\n";
    append_table(OrderedJson::parse(schema), "", text);
    return text;
}

} // namespace toile::scene_format
