#include "collision/find_pairs.h"

namespace toile {

void find_vertex_shape(View<const Vec3> x, const ShapeCollider& shape, int collider, double radius,
                       std::vector<ContactPair>& out)
{
    parallel_append(
        kCpu, "collision/shape", x.size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int v = begin; v < end; ++v) {
                const ShapePoint at = shape.closest(x[v]);
                if (at.signed_distance < radius)
                    pairs.push_back({.vertex = contact_vertices(v),
                                     .weight = {1.0},
                                     .normal = at.normal,
                                     .point = at.point,
                                     .motion = shape.motion(at.point),
                                     .collider = collider,
                                     .kind = ContactKind::kVertexShape,
                                     .feature = 0});
            }
        },
        out);
}

} // namespace toile
