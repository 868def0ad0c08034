#include "scenes/world/fabric_parts.h"

#include <utility>

namespace toile::scenes {

namespace {

/// @param values  empty: so is the result
std::vector<double> values_at(const std::vector<double>& values, const std::vector<int>& indices)
{
    std::vector<double> at;
    for (size_t k = 0; !values.empty() && k < indices.size(); ++k)
        at.push_back(values[size_t(indices[k])]);
    return at;
}

} // namespace

std::vector<FabricPart> fabric_parts(const ClothState& cloth,
                                     const std::shared_ptr<const garment::RestShape>& rest)
{
    if (cloth.fabric_of_triangle.empty())
        return {{cloth.fabric, rest, cloth.stiffness, {}}};
    std::vector<FabricPart> parts;
    const std::vector<std::vector<int>> triangles = cloth.triangles_by_fabric();
    for (size_t f = 0; f < triangles.size(); ++f)
        if (!triangles[f].empty())
            parts.push_back(
                {cloth.fabrics()[f],
                 std::make_shared<const garment::RestShape>(garment::part_of(*rest, triangles[f])),
                 values_at(cloth.stiffness, triangles[f]),
                 {}});
    return parts;
}

std::vector<double> masses_of(const std::vector<FabricPart>& parts)
{
    std::vector<double> masses;
    for (const FabricPart& part : parts) {
        const std::vector<double> areas = part.rest->vertex_areas();
        masses.resize(areas.size(), 0.0);
        for (size_t v = 0; v < areas.size(); ++v)
            masses[v] += areas[v] * part.fabric.areal_density;
    }
    return masses;
}

} // namespace toile::scenes
