#include "garment/energy/cuda/elasticity.h"

#include "core/compute/cuda/teams.cuh"
#include "garment/energy/cuda/membrane_sides_kernels.h"
#include "garment/energy/gather_elastic.h"

namespace toile::garment {

namespace {

/// Threads per vertex, which has about six corners.
constexpr int kTeam = SlicedRows::kThreads;

} // namespace

DeviceElasticity::DeviceElasticity(const CudaSpace& space)
    : space_(space), triangles_(space, "membrane/triangles"), rest_inv_(space, "membrane/rest_inv"),
      area_(space, "membrane/area"), fabric_(space, "membrane/fabric"), weights_(space, "membrane/weights"),
      viscous_fabric_(space, "membrane/viscous_fabric"), viscous_weights_(space, "membrane/viscous_weights"),
      start_(space, "membrane/start"), side_blocks_(space, "membrane"),
      first_corner_(space, "membrane/first_corner"), corners_(space, "membrane/corners"),
      corner_gradient_(space, "membrane/corner_gradient"), bending_first_(space, "bending/first"),
      bending_entries_(space, "bending/entries")
{
}

void DeviceElasticity::add_membrane(const RestShape& rest, const MembraneWeights& weights,
                                    const ViscousWeights& viscosity, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.first_corner.size()));
    // Vertices before this cloth that belong to no cloth have no corners.
    host_.first_corner.resize(first_vertex + 1, int(host_.corners.size()));
    const int first_triangle = int(host_.triangles.size());
    const int viscous_fabric = viscosity.are_zero() ? 0 : int(host_.viscosity.size());
    if (viscous_fabric > 0)
        host_.viscosity.push_back(viscosity);
    for (size_t t = 0; t < rest.triangles.size(); ++t) {
        host_.triangles.push_back(rest.triangles[t] + Triangle::Constant(first_vertex));
        host_.rest_inv.push_back(rest.edges_inv[t]);
        host_.area.push_back(rest.areas[t]);
        host_.fabric.push_back(int(host_.weights.size()));
        host_.viscous_fabric.push_back(rest.is_sliver(int(t)) ? 0 : viscous_fabric);
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
    if (!is_viscous())
        return;
    viscous_fabric_.upload(host_.viscous_fabric);
    viscous_weights_.resize(int(host_.viscosity.size()));
    viscous_weights_.fill_zero();
    start_.resize(triangles_.size());
    start_.fill_zero();
}

ViscousTriangles DeviceElasticity::viscosity() const
{
    return {viscous_fabric_.view(), viscous_weights_.view(), start_.view()};
}

void DeviceElasticity::begin_step(View<const Vec3> x, double dt)
{
    if (!is_viscous())
        return;
    std::vector<ViscousWeights> of_step;
    for (const ViscousWeights& of_second : host_.viscosity)
        of_step.push_back(of_second.over(dt));
    viscous_weights_.upload(of_step);
    parallel_for(space_, "membrane/strain", triangles_.size(),
                 StrainOfTriangle{x, triangles_.view(), rest_inv_.view(), start_.view()});
}

void DeviceElasticity::add_gradient(const DeviceEvaluation& at)
{
    TOILE_ASSERT(host_.bending_first.size() <= host_.first_corner.size());
    if (triangles_.size() == 0)
        return; // the prologue of the gather kernel relies on the previous launch
    if (is_viscous())
        project(at, viscosity());
    else
        project(at, NoViscosity{});
    parallel_for_teams<kTeam>(space_, "elasticity/gather", first_corner_.size() - 1,
                              GatherElastic{{first_corner_.view(), corners_.view(), corner_gradient_.view()},
                                            {bending_first_.view(), bending_entries_.view(), at.x},
                                            at.gradient,
                                            at.energy});
}

template <typename Viscosity>
void DeviceElasticity::project(const DeviceEvaluation& at, const Viscosity& viscosity)
{
    parallel_for(space_, "membrane/project", triangles_.size(),
                 ProjectMembraneTriangle<CornerPair, Viscosity>{
                     at.x, triangles_.view(), rest_inv_.view(), area_.view(), fabric_.view(), weights_.view(),
                     corner_gradient_.view(), at.partials, viscosity});
}

void DeviceElasticity::find_entries(const HessianPattern& pattern)
{
    side_blocks_.find_entries(sides_of(host_.triangles), 3, pattern);
}

void DeviceElasticity::add_curvature(const DeviceCurvature& at)
{
    if (is_viscous())
        curve(at.x, viscosity());
    else
        curve(at.x, NoViscosity{});
    side_blocks_.add_to(at.blocks, "membrane/gather_curvature", {});
}

template <typename Viscosity>
void DeviceElasticity::curve(View<const Vec3> x, const Viscosity& viscosity)
{
    parallel_for(space_, "membrane/curvature", triangles_.size(),
                 CurveMembraneTriangle<Viscosity>{x, triangles_.view(), rest_inv_.view(), area_.view(),
                                                  fabric_.view(), weights_.view(), viscosity,
                                                  side_blocks_.of_elements()});
}

} // namespace toile::garment
