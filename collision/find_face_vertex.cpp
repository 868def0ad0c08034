#include <tuple>

#include "collision/find_pairs.h"

namespace toile {

namespace {

/// How deep a collider vertex may have pierced the cloth, in radii [-].
constexpr double kPiercedRadii = 1.0;

/// Least |cos| between the vertex normal and the direction to the cloth [-]: 45 degrees. Cloth that passes
/// sideways is the business of its own vertices and edges.
constexpr double kAheadCosine = 0.7071;

void find_sheets(const PairSearch& search, const SurfaceProximity& cloth, int v,
                 std::vector<ContactPair>& out)
{
    const SurfaceProximity& surface = search.mesh.surface();
    const Vec3& x = surface.positions()[v];
    thread_local std::vector<SurfacePoint> sheets;
    cloth.local_closest(x, kPiercedRadii * search.settings.radius, sheets);
    if (sheets.empty())
        return;
    const Vec3 n = surface.vertex_normal(v);
    for (const SurfacePoint& sheet : sheets) {
        // Above a cloth vertex the vertex itself makes the pair.
        if (vertex_of(sheet.feature) >= 0)
            continue;
        const Triangle& corner = cloth.triangles()[sheet.triangle];
        const double radius = search.radius_of(corner[0], corner[1], corner[2]);
        if (sheet.distance() > kPiercedRadii * radius)
            continue;
        const double gap = n.dot(sheet.point - x);
        const bool is_ahead = sheet.distance() < kTouching || std::abs(gap) > kAheadCosine * sheet.distance();
        if (n.isZero(0.0) || !is_ahead || gap >= radius)
            continue;
        if (gap < -kTouching && !is_inside_below(search.mesh, sheet.point, sheet.distance(), n))
            continue;
        out.push_back({.vertex = contact_vertices(corner[0], corner[1], corner[2]),
                       .weight = {sheet.barycentric[0], sheet.barycentric[1], sheet.barycentric[2]},
                       .normal = n,
                       .point = x,
                       .motion = search.mesh.motion(v),
                       .collider = search.collider,
                       .kind = ContactKind::kFaceVertex,
                       .feature = v});
    }
}

/// Cells [m] in which cloth may be near the mesh: smaller ones cull more, larger ones are faster to fill.
constexpr double kCell = 0.03;

/// Where a vertex of the mesh may be near cloth that is wanted.
class NearCells {
public:
    NearCells(const PairSearch& search, const SurfaceProximity& cloth)
    {
        std::vector<Bounds> boxes;
        for (const Triangle& corner : cloth.triangles())
            if (const std::optional<Bounds> box = box_of(search, corner)) {
                boxes.push_back(*box);
                all_.extend(box->lower);
                all_.extend(box->upper);
            }
        if (boxes.empty())
            return;
        grid_ = CellGrid(all_, kCell);
        is_near_.assign(grid_.cell_count(), 0);
        for (const Bounds& box : boxes)
            grid_.for_cells(grid_.cell_of(box.lower), grid_.cell_of(box.upper),
                            [&](int cell) { is_near_[cell] = 1; });
    }

    bool empty() const { return is_near_.empty(); }
    bool hold(const Vec3& x) const
    {
        const int cell = grid_.nearest_to(x, 0);
        return cell >= 0 && is_near_[cell];
    }

private:
    /// Around a triangle, as far as pairs are wanted; nothing where all of it is clear of the mesh.
    static std::optional<Bounds> box_of(const PairSearch& search, const Triangle& corner)
    {
        const double radius = search.radius_of(corner[0], corner[1], corner[2]);
        Bounds box;
        for (const int v : corner)
            box.extend(search.x[v]);
        if (radius < 0.0 || search.clearance.of(corner[0]) > radius + box.diagonal())
            return std::nullopt;
        box.lower.array() -= kPiercedRadii * radius;
        box.upper.array() += kPiercedRadii * radius;
        return box;
    }

    Bounds all_;
    CellGrid grid_;
    std::vector<unsigned char> is_near_; ///< [cells]
};

} // namespace

bool is_inside_below(const MeshCollider& mesh, const Vec3& c, double reach, const Vec3& n)
{
    constexpr double kReachSlack = 1.0 + 1e-6; // the feature itself must be found
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(c, reach * kReachSlack);
    return nearest && nearest->signed_distance < 0.0 && nearest->normal.dot(n) > 0.0;
}

void find_face_vertex(const PairSearch& search, const SurfaceProximity& cloth, std::vector<ContactPair>& out)
{
    const NearCells cells(search, cloth);
    if (cells.empty())
        return;
    const size_t first = out.size();
    parallel_append(
        kCpu, "collision/face_vertex", search.mesh.surface().positions().size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int v = begin; v < end; ++v)
                if (cells.hold(search.mesh.surface().positions()[v]))
                    find_sheets(search, cloth, v, pairs);
        },
        out);
    std::sort(out.begin() + long(first), out.end(), [](const ContactPair& a, const ContactPair& b) {
        return std::tie(a.vertex, a.feature) < std::tie(b.vertex, b.feature);
    });
}

} // namespace toile
