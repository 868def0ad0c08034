#include "export/archive/polygons.h"

#include <algorithm>

#include "core/mesh/obj.h"

namespace toile::exports {

std::vector<std::vector<int>> polygons_of(const std::vector<std::int32_t>& counts,
                                          const std::vector<std::int32_t>& indices, int vertex_count,
                                          const std::function<void(const std::string&)>& refuse)
{
    for (const std::int32_t v : indices)
        if (v < 0 || v >= vertex_count)
            refuse("has a face of point " + std::to_string(v) + "; its points are 0 to " +
                   std::to_string(vertex_count - 1));
    std::vector<std::vector<int>> polygons;
    size_t first = 0;
    for (const std::int32_t count : counts) {
        const size_t left = indices.size() - first;
        if (count < 3 || size_t(count) > std::min(left, kMaxPolygonCorners))
            refuse("has a face of " + std::to_string(count) + " corners; they have 3 to " +
                   std::to_string(kMaxPolygonCorners) + ", and " + std::to_string(left) + " are left");
        polygons.emplace_back(indices.begin() + long(first), indices.begin() + long(first) + count);
        first += size_t(count);
    }
    if (polygons.empty() || first != indices.size())
        refuse("has faces of " + std::to_string(first) + " corners together and " +
               std::to_string(indices.size()) + " corners");
    return polygons;
}

} // namespace toile::exports
