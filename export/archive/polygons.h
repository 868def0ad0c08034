#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace toile::exports {

/// Polygons of an archive's lists: corners of each, and the vertices of all corners, one polygon after the
/// other.
/// @param refuse  throws, told what is wrong: a vertex that does not exist, a polygon of too few or too many
///                corners, lists that do not fit, no polygon
std::vector<std::vector<int>> polygons_of(const std::vector<std::int32_t>& counts,
                                          const std::vector<std::int32_t>& indices, int vertex_count,
                                          const std::function<void(const std::string&)>& refuse);

} // namespace toile::exports
