#include "collision/body/find_pairs.h"
#include "collision/body/shape_search.h"

namespace toile::collision {

void find_vertex_shape(View<const Vec3> x, const ShapeCollider& shape, int collider, double radius,
                       std::vector<ContactPair>& out)
{
    with_solid(shape, [&](const auto& solid) {
        const ShapeRules<std::decay_t<decltype(solid.solid)>> rules{{}, {}, x,        solid,
                                                                    {}, {}, collider, radius};
        parallel_append(
            kCpu, "collision/shape", x.size(),
            [&](int begin, int end, std::vector<ContactPair>& pairs) {
                for (int v = begin; v < end; ++v)
                    rules.visit_vertex(v, [&](const ContactPair& pair) { pairs.push_back(pair); });
            },
            out);
    });
}

} // namespace toile::collision
