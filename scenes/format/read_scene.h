#pragma once

#include <filesystem>
#include <string>

#include "scenes/format/scene.h"

namespace toile::scenes {

/// Reads and checks a scene file. Files that it names must exist but are not opened.
/// @throws InvalidInput, one line "file: key path: what; remedy": JSON syntax (with line and column),
///         unknown, repeated, missing or contradictory keys, wrong types, numbers out of range, names of
///         cloths, avatars and fabrics that do not exist (suggesting the nearest), missing files.
Scene read_scene(const std::filesystem::path& file);

/// Parses and checks a scene given as text.
/// @param source  stands for the file in messages; relative paths refer to its folder
Scene parse_scene(const std::string& text, const std::filesystem::path& source);

} // namespace toile::scenes
