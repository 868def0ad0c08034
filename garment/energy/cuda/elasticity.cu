#include "garment/energy/cuda/elasticity.h"

#include "core/compute/cuda/teams.cuh"
#include "garment/energy/gather_elastic.h"

namespace toile::garment {

namespace {

/// Threads per vertex, which has about six corners.
constexpr int kTeam = SlicedRows::kThreads;

} // namespace

DeviceElasticity::DeviceElasticity(const CudaSpace& space)
    : space_(space), triangles_(space, "membrane/triangles"), rest_inv_(space, "membrane/rest_inv"),
      area_(space, "membrane/area"), fabric_(space, "membrane/fabric"), weights_(space, "membrane/weights"),
      first_corner_(space, "membrane/first_corner"), corners_(space, "membrane/corners"),
      corner_gradient_(space, "membrane/corner_gradient"), bending_first_(space, "bending/first"),
      bending_entries_(space, "bending/entries")
{
}

void DeviceElasticity::add_membrane(const RestShape& rest, const MembraneWeights& weights, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.first_corner.size()));
    // Vertices before this cloth that belong to no cloth have no corners.
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

void DeviceElasticity::add_bending(const SparseMatrix& K, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.bending_first.size()));
    host_.bending_first.resize(first_vertex + 1, int(host_.bending_column.size()));
    for (int row = 0; row < K.outerSize(); ++row) {
        for (SparseMatrix::InnerIterator entry(K, row); entry; ++entry) {
            host_.bending_column.push_back(first_vertex + int(entry.col()));
            host_.bending_value.push_back(float(entry.value()));
        }
        host_.bending_first.push_back(int(host_.bending_column.size()));
    }
    const SlicedRows rows(host_.bending_first, host_.bending_column, host_.bending_value);
    bending_first_.upload(rows.first);
    bending_entries_.upload(rows.entries);
}

void DeviceElasticity::upload()
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

void DeviceElasticity::add_gradient(const DeviceEvaluation& at)
{
    TOILE_ASSERT(host_.bending_first.size() <= host_.first_corner.size());
    if (triangles_.size() == 0)
        return; // the prologue of the gather kernel relies on the previous launch
    parallel_for(space_, "membrane/project", triangles_.size(),
                 ProjectMembraneTriangle<CornerPair>{at.x, triangles_.view(), rest_inv_.view(), area_.view(),
                                                     fabric_.view(), weights_.view(), corner_gradient_.view(),
                                                     at.partials});
    parallel_for_teams<kTeam>(space_, "elasticity/gather", first_corner_.size() - 1,
                              GatherElastic{{first_corner_.view(), corners_.view(), corner_gradient_.view()},
                                            {bending_first_.view(), bending_entries_.view(), at.x},
                                            at.gradient,
                                            at.energy});
}

} // namespace toile::garment
