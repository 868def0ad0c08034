#pragma once

#include <string>

namespace toile::scenes {

/// The JSON Schema (draft 2020-12) of scene files, as JSON text ending in a newline: every key with its
/// sentence, default and range. docs/reference/toile.schema.json is this text.
std::string scene_schema();

/// The schema as Markdown tables, one per kind of object: docs/reference/keys.md.
std::string scene_key_tables();

} // namespace toile::scenes
