#include <tuple>

#include "collision/body/find_pairs.h"

namespace toile::collision {

namespace {

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
    const MeshPose mesh = search.mesh.pose();
    for (const SurfacePoint& sheet : sheets) {
        const Triangle& corner = cloth.triangles()[sheet.triangle];
        const double radius = search.radius_of(corner[0], corner[1], corner[2]);
        if (meets_sheet(x, n, sheet, radius, InsideBelow{search.mesh}))
            out.push_back(face_vertex_pair(mesh, search.collider, v, n, corner, sheet));
    }
}

/// Size of the cells that mark where cloth may be near the mesh [m]. Smaller cells cull more; larger ones are
/// faster to fill.
constexpr double kCell = 0.03;

/// Grid of the regions in which mesh vertices may be near cloth, with the maximum search radius in each cell.
class NearCells {
public:
    NearCells(const PairSearch& search, View<const Triangle> cloth)
    {
        struct Target {
            Bounds box;
            double reach;
        };
        std::vector<Target> targets;
        for (const Triangle& corner : cloth) {
            const double reach = kMaxPenetrationRadii * search.radius_of(corner[0], corner[1], corner[2]);
            if (const std::optional<Bounds> box = box_of(search, corner, reach)) {
                targets.push_back({*box, reach});
                all_.extend(box->lower);
                all_.extend(box->upper);
            }
        }
        if (targets.empty())
            return;
        grid_ = CellGrid(all_, kCell);
        reach_.assign(grid_.cell_count(), kNowhere);
        for (const Target& target : targets)
            grid_.for_cells(grid_.cell_of(target.box.lower), grid_.cell_of(target.box.upper),
                            [&](int cell) { reach_[cell] = std::max(reach_[cell], target.reach); });
    }

    bool empty() const { return reach_.empty(); }

    /// Search radius [m] of a mesh vertex at x; negative if no cloth is near.
    double reach_from(const Vec3& x) const
    {
        const int cell = is_near(all_, x, 0.0) ? grid_.nearest_to(x, 0) : -1;
        return cell < 0 ? kNowhere : reach_[cell];
    }

private:
    static constexpr double kNowhere = -1.0;

    /// Box around a triangle, grown by its reach; nothing if the whole triangle is clear of the mesh.
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

bool InsideBelow::operator()(const Vec3& c, double reach, const Vec3& n) const
{
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(c, reach * kReachSlack);
    return nearest && is_below(*nearest, n);
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

} // namespace toile::collision
