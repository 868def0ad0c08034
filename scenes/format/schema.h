#pragma once

#include <string>

namespace toile {

/// The JSON Schema (draft 2020-12) of scene files, as JSON text ending in a newline: every key with its
/// sentence, default and range. docs/scenes/toile.schema.json is this text.
std::string scene_schema();

/// The same as Markdown tables, one per kind of object: docs/scenes/keys.md.
std::string scene_key_tables();

} // namespace toile
