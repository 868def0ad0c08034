#pragma once

#include <filesystem>
#include <string>

#include "export/cache_layout.h"

namespace toile::exports {

/// Name of an object as programs accept it: letters, digits and underscores, none of the digits first.
std::string clean_name(const std::string& name);

/// Layout whose meshes all have names: one without is called as the file.
/// @throws InvalidInput if two meshes below one parent, or a mesh and a parent, would have one clean_name()
CacheLayout with_names(const std::filesystem::path& file, CacheLayout layout);

} // namespace toile::exports
