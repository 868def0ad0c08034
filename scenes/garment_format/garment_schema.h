#pragma once

#include <string>

namespace toile::garment_format {

/// The JSON Schema (draft 2020-12) of garment files, as text ending in a newline:
/// docs/reference/toile_garment.schema.json.
std::string garment_schema();

/// The schema as Markdown tables: docs/reference/garment_keys.md.
std::string garment_key_tables();

} // namespace toile::garment_format
