#include "garment/energy/device_membrane.h"

#include "core/backend/cuda/teams.cuh"
#include "garment/energy/gather_corners.h"

namespace toile {

namespace {

/// Threads of a vertex, which has some six corners.
constexpr int kTeam = 4;

} // namespace

DeviceMembrane::DeviceMembrane(const CudaSpace& space)
    : space_(space), triangles_(space, "membrane/triangles"), rest_inv_(space, "membrane/rest_inv"),
      area_(space, "membrane/area"), fabric_(space, "membrane/fabric"), weights_(space, "membrane/weights"),
      first_corner_(space, "membrane/first_corner"), corners_(space, "membrane/corners"),
      corner_gradient_(space, "membrane/corner_gradient")
{
}

void DeviceMembrane::add(const RestShape& rest, const MembraneWeights& weights, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.first_corner.size()));
    // Vertices before this cloth that are no cloth's have no corners.
    host_.first_corner.resize(first_vertex + 1, int(host_.corners.size()));
    const int first_triangle = int(host_.triangles.size());
    for (size_t t = 0; t < rest.triangles.size(); ++t) {
        host_.triangles.push_back(rest.triangles[t] + Triangle::Constant(first_vertex));
        host_.rest_inv.push_back(rest.edges_inv[t]);
        host_.area.push_back(rest.areas[t]);
        host_.fabric.push_back(int(host_.weights.size()));
    }
    host_.weights.push_back(weights);
    for (int v = 0; v < rest.vertex_count(); ++v) {
        for (const int corner : rest.topology.corners_of_vertex.of(v))
            host_.corners.push_back(3 * first_triangle + corner);
        host_.first_corner.push_back(int(host_.corners.size()));
    }
    upload();
}

void DeviceMembrane::upload()
{
    triangles_.upload(host_.triangles);
    rest_inv_.upload(host_.rest_inv);
    area_.upload(host_.area);
    fabric_.upload(host_.fabric);
    weights_.upload(host_.weights);
    first_corner_.upload(host_.first_corner);
    corners_.upload(host_.corners);
    corner_gradient_.resize(triangles_.size());
}

void DeviceMembrane::add_gradient(const DeviceEvaluation& at)
{
    if (triangles_.size() == 0)
        return; // corners' early part counts on the launch before
    parallel_for(space_, "membrane/project", triangles_.size(),
                 ProjectMembraneTriangle<CornerPair>{at.x, triangles_.view(), rest_inv_.view(), area_.view(),
                                                     fabric_.view(), weights_.view(), corner_gradient_.view(),
                                                     at.own});
    parallel_for_teams<kTeam>(
        space_, "membrane/gather", first_corner_.size() - 1,
        GatherCornersByTeam{first_corner_.view(), corners_.view(), corner_gradient_.view(), at.gradient});
}

} // namespace toile
