#include <tuple>

#include "collision/find_pairs.h"

namespace toile {

namespace {

/// How deep a collider vertex may have pierced the cloth, in radii [-].
constexpr double kPiercedRadii = 1.0;

/// Least |cos| between the vertex normal and the direction to the cloth [-]: 45 degrees. Cloth that passes
/// sideways is the business of its own vertices and edges.
constexpr double kAheadCosine = 0.7071;

void find_sheets(const PairSearch& search, const SurfaceProximity& cloth, const ReachingVertex& reaching,
                 std::vector<ContactPair>& out)
{
    const int v = reaching.vertex;
    const SurfaceProximity& surface = search.mesh.surface();
    const Vec3& x = surface.positions()[v];
    thread_local std::vector<SurfacePoint> sheets;
    cloth.local_closest(x, reaching.reach, sheets);
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

/// Where a vertex of the mesh may be near cloth that is wanted, and how far that is at most.
class NearCells {
public:
    NearCells(const PairSearch& search, View<const Triangle> cloth)
    {
        struct Place {
            Bounds box;
            double reach;
        };
        std::vector<Place> places;
        for (const Triangle& corner : cloth) {
            const double reach = kPiercedRadii * search.radius_of(corner[0], corner[1], corner[2]);
            if (const std::optional<Bounds> box = box_of(search, corner, reach)) {
                places.push_back({*box, reach});
                all_.extend(box->lower);
                all_.extend(box->upper);
            }
        }
        if (places.empty())
            return;
        grid_ = CellGrid(all_, kCell);
        reach_.assign(grid_.cell_count(), kNowhere);
        for (const Place& place : places)
            grid_.for_cells(grid_.cell_of(place.box.lower), grid_.cell_of(place.box.upper),
                            [&](int cell) { reach_[cell] = std::max(reach_[cell], place.reach); });
    }

    bool empty() const { return reach_.empty(); }

    /// [m] Cloth farther from x is not wanted; negative where none is near.
    double reach_from(const Vec3& x) const
    {
        const int cell = is_near(all_, x, 0.0) ? grid_.nearest_to(x, 0) : -1;
        return cell < 0 ? kNowhere : reach_[cell];
    }

private:
    static constexpr double kNowhere = -1.0;

    /// Around a triangle, as far as pairs are wanted; nothing where all of it is clear of the mesh.
    static std::optional<Bounds> box_of(const PairSearch& search, const Triangle& corner, double reach)
    {
        Bounds box;
        for (const int v : corner)
            box.extend(search.x[v]);
        if (reach < 0.0 || search.clearance.of(corner[0]) > reach + box.diagonal())
            return std::nullopt;
        box.lower.array() -= reach;
        box.upper.array() += reach;
        return box;
    }

    Bounds all_;
    CellGrid grid_;
    std::vector<double> reach_; ///< [cells] [m]
};

} // namespace

bool is_inside_below(const MeshCollider& mesh, const Vec3& c, double reach, const Vec3& n)
{
    constexpr double kReachSlack = 1.0 + 1e-6; // the feature itself must be found
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(c, reach * kReachSlack);
    return nearest && nearest->signed_distance < 0.0 && nearest->normal.dot(n) > 0.0;
}

std::vector<ReachingVertex> find_reaching_vertices(const PairSearch& search, View<const Triangle> triangles)
{
    std::vector<ReachingVertex> near;
    const NearCells cells(search, triangles);
    if (cells.empty())
        return near;
    const View<const Vec3> body = search.mesh.surface().positions();
    parallel_append(
        kCpu, "collision/near_vertices", body.size(),
        [&](int begin, int end, std::vector<ReachingVertex>& found) {
            for (int v = begin; v < end; ++v)
                if (const double reach = cells.reach_from(body[v]); reach >= 0.0)
                    found.push_back({v, reach});
        },
        near);
    return near;
}

void find_face_vertex(const PairSearch& search, View<const ReachingVertex> vertices,
                      const SurfaceProximity& cloth, std::vector<ContactPair>& out)
{
    const size_t first = out.size();
    parallel_append(
        kCpu, "collision/face_vertex", vertices.size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (const ReachingVertex& v : vertices.subview(begin, end - begin))
                find_sheets(search, cloth, v, pairs);
        },
        out);
    std::sort(out.begin() + long(first), out.end(), [](const ContactPair& a, const ContactPair& b) {
        return std::tie(a.vertex, a.feature) < std::tie(b.vertex, b.feature);
    });
}

} // namespace toile
