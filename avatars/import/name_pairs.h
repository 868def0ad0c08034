#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace toile::avatars {

/// Reads a JSON object whose values are text, as pairs of key and value.
/// @throws InvalidInput in one line for a file that can't be read, is no such object or has no pair
std::vector<std::pair<std::string, std::string>> read_name_pairs(const std::filesystem::path& file);

} // namespace toile::avatars
