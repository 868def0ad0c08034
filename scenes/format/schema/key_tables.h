#pragma once

#include <string>

namespace toile::scene_format {

/// A schema as Markdown tables, one per kind of object.
/// @param schema   JSON Schema made by document_schema()
/// @param command  that prints the tables
std::string key_tables(const std::string& schema, const std::string& heading, const std::string& command);

} // namespace toile::scene_format
