#include "collision/contact/contact_soup.h"

#include <limits>

#include "collision/self/near_pairs.h"

namespace toile::collision {

ContactSoup::ContactSoup(View<const Triangle> cloth_triangles, View<const Vec3> cloth_positions,
                         const std::vector<ContactCloth>& all_cloths, View<const double> cloth_altitude,
                         BodySurfaces all_bodies, bool cloth_with_cloth)
    : cloths(all_cloths), bodies(std::move(all_bodies)), first_body(cloth_positions.size()),
      triangles(cloth_triangles.begin(), cloth_triangles.end()),
      positions(cloth_positions.begin(), cloth_positions.end()),
      altitude(cloth_altitude.begin(), cloth_altitude.end()), rigid(rigid_bodies_of(cloths))
{
    for (const Triangle& t : bodies.triangles())
        triangles.push_back(t + Triangle::Constant(first_body));
    positions.resize(first_body + bodies.vertex_count());
    bodies.pose_t1(of_bodies(View<Vec3>(positions)));
    altitude.resize(positions.size(), std::numeric_limits<double>::max());
    if (!cloth_with_cloth)
        rigid.assign(first_body, kTogether);
    else if (rigid.empty() && has_bodies())
        rigid.assign(first_body, -1);
    if (!rigid.empty())
        rigid.resize(positions.size(), kPrescribed);
}

} // namespace toile::collision
