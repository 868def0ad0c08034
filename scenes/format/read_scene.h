#pragma once

#include <filesystem>
#include <string>

#include "scenes/format/scene.h"

namespace toile {

/// Reads and checks a scene file. Files that it names are found but not opened.
/// @throws InvalidInput, one line "file: key path: what; remedy": JSON syntax (with line and column),
/// unknown,
///         repeated, missing or contradictory keys, wrong types, numbers out of range, names of cloths,
///         avatars and fabrics that do not exist (naming the nearest), files that do not exist.
Scene read_scene(const std::filesystem::path& file);

/// The same for text in memory.
/// @param source  stands for the file in messages and gives the folder that paths are relative to
Scene parse_scene(const std::string& text, const std::filesystem::path& source);

} // namespace toile
