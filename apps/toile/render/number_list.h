#pragma once

#include <optional>
#include <string>
#include <vector>

namespace toile::app {

/// Finite numbers separated by commas; nothing if there are others than `count`, or something else.
std::optional<std::vector<double>> numbers_of(const std::string& text, size_t count);

} // namespace toile::app
