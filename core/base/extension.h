#pragma once

#include <filesystem>
#include <string>

namespace toile {

/// Extension of the file in lower case, with its dot: ".obj" for body.OBJ.
std::string lower_case_extension(const std::filesystem::path& file);

} // namespace toile
