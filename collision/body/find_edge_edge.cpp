#include "collision/body/find_pairs.h"
#include "core/compute/lanes.h"

namespace toile::collision {

namespace {

/// Eight edges of the mesh side by side.
struct EdgeBlock {
    static constexpr int kCount = kLanes;
    std::array<const MeshCollider::OwnedEdge*, kCount> edge;
    int count = 0;

    /// Lanes whose closest points with the segment may lie inside both: a superset of those accepted by
    /// crossing().
    Lanes::mask_type may_cross(const Vec3& a0, const Vec3& a1, View<const Vec3> x) const;
};

/// Applies the tests of crossing() to the parameters, with slack because rounding differs.
Lanes::mask_type EdgeBlock::may_cross(const Vec3& a0, const Vec3& a1, View<const Vec3> x) const
{
    constexpr double kSlack = 1e-9; // [-]
    Vec3Of<Lanes> b0, b1;
    for (int k = 0; k < 3; ++k) {
        b0[k] = gather(0, count, [&](int i) { return x[edge[i]->vertex[0]][k]; });
        b1[k] = gather(0, count, [&](int i) { return x[edge[i]->vertex[1]][k]; });
    }
    Lanes aa = 0.0, bb = 0.0, ab = 0.0, ga = 0.0, gb = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double da = a1[k] - a0[k];
        const Lanes db = b1[k] - b0[k], gap = a0[k] - b0[k];
        aa += da * da;
        bb += db * db;
        ab += da * db;
        ga += da * gap;
        gb += db * gap;
    }
    const Lanes determinant = aa * bb - ab * ab;
    const Lanes s = ab * gb - bb * ga;
    const Lanes t = aa * gb - ab * ga;
    const Lanes slack = kSlack * (aa * bb + bb * abs(ga) + aa * abs(gb));
    return s > -slack && s < determinant + slack && t > -slack && t < determinant + slack;
}

void find_ridges(const PairSearch& search, const std::array<int, 2>& cloth_edge,
                 std::vector<ContactPair>& out)
{
    const Vec3 &a = search.x[cloth_edge[0]], &b = search.x[cloth_edge[1]];
    const Vec3 middle = 0.5 * (a + b);
    const double radius = search.radius_of(cloth_edge[0], cloth_edge[1]);
    if (radius < 0.0 || search.clearance.is_edge_clear(cloth_edge[0], cloth_edge[1], radius))
        return;
    const double reach = 0.5 * (b - a).norm() + radius;
    const double radius2 = radius * radius;
    if (!is_near(search.mesh.bounds(), middle, reach))
        return;

    // If a ridge is within the radius, so is the triangle that owns it. The candidates' order does not
    // matter: every pair is tested independently and the pairs are sorted.
    const View<const Vec3> body = search.mesh.surface().positions();
    thread_local std::vector<int> triangles;
    search.mesh.surface().triangles_maybe_near(a, b, radius, triangles);
    const size_t first = out.size();
    const MeshPose mesh = search.mesh.pose();
    const InsideBelow is_inside_below{search.mesh};
    ContactPair pair;
    EdgeBlock block;
    const auto test_block = [&] {
        const Lanes::mask_type may_cross = block.may_cross(a, b, body);
        for (int i = 0; i < block.count; ++i) {
            if (!may_cross[i])
                continue;
            const MeshCollider::OwnedEdge& ridge = *block.edge[i];
            const ClosestOnSegments closest = crossing(a, b, body[ridge.vertex[0]], body[ridge.vertex[1]]);
            if (closest.s >= 0.0 && closest.distance2 < radius2 && mesh.surface.is_ridge(ridge.edge) &&
                meets_ridge(mesh, search.collider, cloth_edge, a, b, ridge.edge, closest, is_inside_below,
                            pair))
                out.push_back(pair);
        }
        block.count = 0;
    };
    for (const int t : triangles)
        for (const MeshCollider::OwnedEdge& ridge : search.mesh.owned_edges(t)) {
            block.edge[block.count++] = &ridge;
            if (block.count == EdgeBlock::kCount)
                test_block();
        }
    if (block.count > 0)
        test_block();
    std::sort(out.begin() + long(first), out.end(),
              [](const ContactPair& p, const ContactPair& q) { return p.feature < q.feature; });
}

} // namespace

void find_edge_edge(const PairSearch& search, const SurfaceEdges& cloth, std::vector<ContactPair>& out)
{
    parallel_append(
        kCpu, "collision/edge_edge", cloth.edge_count(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int e = begin; e < end; ++e)
                find_ridges(search, cloth.vertex[e], pairs);
        },
        out);
}

} // namespace toile::collision
