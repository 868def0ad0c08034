#include "garment/energy/strain_limit/cuda/stretch_tension.h"

#include "core/compute/cuda/teams.cuh"
#include "garment/energy/strain_limit/cuda/tension_sides_kernels.h"

namespace toile::garment {

namespace {

/// Threads per vertex, which has about six corners.
constexpr int kTeam = 8;

/// Teams that process the list of vertices: as many as a large GPU holds at once.
constexpr int kTeamCount = 16384;

} // namespace

DeviceStretchTension::DeviceStretchTension(const CudaSpace& space)
    : space_(space), triangles_(space, "stretch_tension/triangles"),
      rest_inv_(space, "stretch_tension/rest_inv"), area_(space, "stretch_tension/area"),
      kind_(space, "stretch_tension/kind"), limits_(space, "stretch_tension/limits"),
      first_corner_(space, "stretch_tension/first_corner"), corners_(space, "stretch_tension/corners"),
      tension_(space, "stretch_tension/tension"), rotated_tension_(space, "stretch_tension/rotated_tension"),
      near_(space, "stretch_tension/near"), has_near_(space, "stretch_tension/has_near"),
      watched_(space, "stretch_tension/watched"), watched_count_(space, "stretch_tension/watched_count", 1),
      scratch_(space, "stretch_tension/scratch"), exceeds_(space, "stretch_tension/exceeds"),
      side_blocks_(space, "stretch_tension")
{
}

void DeviceStretchTension::add(const StretchTension& tension, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.first_corner.size()));
    parts_.push_back(
        {&tension, int(host_.triangles.size()), tension.triangles().tri.size(), tension.forgotten()});
    append(tension, first_vertex);
    upload();
}

void DeviceStretchTension::append(const StretchTension& tension, int first_vertex)
{
    // Vertices before this cloth that belong to no cloth have no corners.
    host_.first_corner.resize(first_vertex + 1, int(host_.corners.size()));
    const int first_triangle = int(host_.triangles.size()), first_kind = int(host_.limits.size());
    const TensionTriangles triangles = tension.triangles();
    for (int t = 0; t < triangles.tri.size(); ++t) {
        host_.triangles.push_back(triangles.tri[t] + Triangle::Constant(first_vertex));
        host_.rest_inv.push_back(triangles.rest_inv[t]);
        host_.area.push_back(triangles.area[t]);
        host_.kind.push_back(first_kind + triangles.kind[t]);
    }
    host_.limits.insert(host_.limits.end(), triangles.limits.begin(), triangles.limits.end());
    for (int v = 0; v < tension.rest().vertex_count(); ++v) {
        for (const int corner : tension.rest().topology.corners_of_vertex.of(v))
            host_.corners.push_back(3 * first_triangle + corner);
        host_.first_corner.push_back(int(host_.corners.size()));
    }
}

void DeviceStretchTension::upload()
{
    triangles_.upload(host_.triangles);
    rest_inv_.upload(host_.rest_inv);
    area_.upload(host_.area);
    kind_.upload(host_.kind);
    limits_.upload(host_.limits);
    first_corner_.upload(host_.first_corner);
    corners_.upload(host_.corners);
    tension_.resize(triangles_.size());
    tension_.fill_zero();
    rotated_tension_.resize(triangles_.size());
    near_.resize(triangles_.size());
    near_.fill_zero();
    exceeds_.resize(triangles_.size());
    has_near_.resize(first_corner_.size() - 1);
    watched_.resize(first_corner_.size() - 1);
    watched_count_.fill_zero();
}

TensionPull DeviceStretchTension::pull(View<const Vec3> x) const
{
    return {{triangles_.view(), rest_inv_.view(), area_.view(), kind_.view(), limits_.view()},
            x,
            rotated_tension_.view()};
}

void DeviceStretchTension::begin_step(View<const Vec3> x, double)
{
    for (Part& part : parts_)
        if (part.forgotten != part.tension->forgotten()) {
            parallel_for(space_, "stretch_tension/forget", part.count,
                         ForgetTension{tension_.view().subview(part.first, part.count)});
            part.forgotten = part.tension->forgotten();
        }
    parallel_for(space_, "stretch_tension/watch", triangles_.size(),
                 WatchTriangle{pull(x).triangles, x, tension_.view(), near_.view(), rotated_tension_.view()});
    parallel_for(space_, "stretch_tension/watch_vertices", has_near_.size(),
                 WatchVertex{near_.view(), first_corner_.view(), corners_.view(), has_near_.view()});
    list_flagged(space_, "stretch_tension/list", has_near_.view(), watched_.view(), watched_count_.view(),
                 scratch_);
}

void DeviceStretchTension::add_gradient(const DeviceEvaluation& at)
{
    parallel_for_teams<kTeam>(space_, "stretch_tension/pull", kTeamCount,
                              PullWatchedVertices{pull(at.x), near_.view(), watched_.view(),
                                                  watched_count_.view(), first_corner_.view(),
                                                  corners_.view(), at.gradient, at.energy, kTeamCount});
}

void DeviceStretchTension::find_entries(const HessianPattern& pattern)
{
    side_blocks_.find_entries(sides_of(host_.triangles), 3, pattern);
}

void DeviceStretchTension::add_curvature(const DeviceCurvature& at)
{
    parallel_for(space_, "stretch_tension/curvature", triangles_.size(),
                 CurveTensionTriangle{pull(at.x), near_.view(), exceeds_.view(), side_blocks_.of_elements()});
    side_blocks_.add_to(at.blocks, "stretch_tension/gather_curvature", exceeds_.view());
}

void DeviceStretchTension::end_minimisation(View<const Vec3> x)
{
    parallel_for(space_, "stretch_tension/remember", triangles_.size(),
                 RememberTension{pull(x), near_.view(), tension_.view()});
}

} // namespace toile::garment
