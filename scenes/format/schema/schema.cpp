#include "scenes/format/schema/schema.h"

#include "scenes/format/schema/key_tables.h"
#include "scenes/format/schema/schema_writer.h"

namespace toile::scene_format {

OrderedJson number_schema(const char* type, const Range& range)
{
    const bool whole = std::string_view(type) == "integer";
    const auto bound = [&](double value) { return whole ? OrderedJson(long(value)) : OrderedJson(value); };
    return {{"type", type},
            {range.above_lower ? "exclusiveMinimum" : "minimum", bound(range.lower)},
            {"maximum", bound(range.upper)}};
}

OrderedJson SchemaWriter::schema() const
{
    OrderedJson schema = {{"type", "object"}, {"properties", properties_}};
    if (!required_.empty())
        schema["required"] = required_;
    if (!one_of_.empty())
        schema["oneOf"] = one_of_;
    schema["additionalProperties"] = false;
    return schema;
}

void SchemaWriter::add(const char* key, const OrderedJson& schema, const std::string& help)
{
    // The description comes first, for human readers.
    OrderedJson described = {{"description", help}};
    described.update(schema);
    properties_[key] = described;
}

} // namespace toile::scene_format

namespace toile::scenes {

std::string scene_schema()
{
    return scene_format::document_schema(Scene(), "Toile scene",
                                         "A scene to simulate. SI units, Y up, paths relative to the file.");
}

std::string scene_key_tables()
{
    return scene_format::key_tables(scene_schema(), "Keys of a scene file", "toile schema --tables");
}

} // namespace toile::scenes
