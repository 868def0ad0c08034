#include "collision/contact/contact_cloth.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Geometry>

namespace toile::collision {

std::vector<int> rigid_bodies_of(const std::vector<ContactCloth>& cloths)
{
    std::vector<int> bodies;
    int count = 0;
    for (const ContactCloth& cloth : cloths)
        bodies.insert(bodies.end(), cloth.vertex_count, cloth.is_rigid ? count++ : -1);
    if (count == 0)
        bodies.clear();
    return bodies;
}

double largest_gap(const std::vector<ContactCloth>& cloths)
{
    double largest = 0.0;
    for (const ContactCloth& cloth : cloths)
        largest = std::max(largest, cloth.gap);
    return largest;
}

double room_of(const std::vector<ContactCloth>& cloths)
{
    double room = 0.0;
    for (const ContactCloth& cloth : cloths)
        if (!cloth.is_rigid)
            room = std::max(room, room_of(cloth.gap - 0.5 * cloth.thickness, cloth.thickness));
    return room;
}

std::vector<double> shortest_altitudes(View<const Triangle> triangles, View<const Vec3> x)
{
    std::vector<double> shortest(x.size(), std::numeric_limits<double>::max());
    for (const Triangle& corner : triangles) {
        const std::array<Vec3, 3> side{x[corner[1]] - x[corner[0]], x[corner[2]] - x[corner[1]],
                                       x[corner[0]] - x[corner[2]]};
        const double longest = std::max({side[0].norm(), side[1].norm(), side[2].norm()});
        const double altitude = side[0].cross(side[1]).norm() / longest;
        for (const int v : corner)
            shortest[v] = std::min(shortest[v], altitude);
    }
    return shortest;
}

ContactTables::ContactTables(const std::vector<ContactCloth>& cloths, int collider_count,
                             View<const Triangle> triangles, View<const Vec3> positions)
    : collider_friction(cloths.size() * collider_count, 0.0),
      cloth_friction(cloths.size() * cloths.size(), 0.0), rigid(rigid_bodies_of(cloths)),
      altitude(shortest_altitudes(triangles, positions))
{
    const bool is_even = std::all_of(cloths.begin(), cloths.end(),
                                     [](const auto& one) { return one.vertex_thickness.empty(); });
    for (size_t c = 0; c < cloths.size(); ++c) {
        const ContactCloth& cloth = cloths[c];
        for (int v = 0; !is_even && v < cloth.vertex_count; ++v)
            vertex_gap.push_back(cloth.gap_at(v));
        cloth_of.insert(cloth_of.end(), cloth.vertex_count, int(c));
        gap.push_back(cloth.gap);
        std::copy_n(cloth.collider_friction.begin(),
                    std::min<size_t>(cloth.collider_friction.size(), collider_count),
                    collider_friction.begin() + c * collider_count);
        std::copy_n(cloth.cloth_friction.begin(), std::min(cloth.cloth_friction.size(), cloths.size()),
                    cloth_friction.begin() + c * cloths.size());
    }
}

} // namespace toile::collision
