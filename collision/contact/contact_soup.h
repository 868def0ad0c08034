#pragma once

#include <vector>

#include "collision/body/body_surfaces.h"
#include "collision/contact/contact_cloth.h"

namespace toile::collision {

/// Cloths and bodies that are kept from crossing, as one list of triangles: first those of all cloths, then
/// those of bodies; vertices likewise.
struct ContactSoup {
    /// See make_cloth_contact.
    ContactSoup(View<const Triangle> cloth_triangles, View<const Vec3> cloth_positions,
                const std::vector<ContactCloth>& cloths, View<const double> cloth_altitude,
                BodySurfaces bodies, bool cloth_with_cloth);

    bool has_bodies() const { return !bodies.is_empty(); }
    int vertex_count() const { return int(positions.size()); }
    View<const Triangle> triangles_of_cloth() const
    {
        return View<const Triangle>(triangles).subview(0, int(triangles.size() - bodies.triangles().size()));
    }
    /// Those of cloth or of bodies among values of all vertices.
    template <typename T>
    View<T> of_cloth(View<T> all) const
    {
        return all.subview(0, first_body);
    }
    template <typename T>
    View<T> of_bodies(View<T> all) const
    {
        return all.subview(first_body, all.size() - first_body);
    }

    std::vector<ContactCloth> cloths;
    BodySurfaces bodies;
    int first_body; ///< first vertex of bodies, number of vertices of cloth
    std::vector<Triangle> triangles;
    std::vector<Vec3> positions;  ///< [vertices] of cloth at the start, of bodies at t1 [m]
    std::vector<double> altitude; ///< [vertices] see shortest_altitudes [m]; infinite for bodies
    std::vector<int> rigid;       ///< [vertices] see NearPairs
};

} // namespace toile::collision
