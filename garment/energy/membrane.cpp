#include "garment/energy/membrane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/compute/parallel_lanes.h"
#include "garment/energy/cuda/elasticity.h"

namespace toile::garment {

namespace {

void require_valid(const Membrane::Settings& s, const std::string& source)
{
    const auto refuse = [&](const char* name, double value, const std::string& range) {
        throw InvalidInput(source + ": stretch stiffness " + name + " = " + std::to_string(value) +
                           " N/m; it must be " + range);
    };
    if (!(s.warp > 0.0))
        refuse("warp", s.warp, "positive");
    if (!(s.weft > 0.0))
        refuse("weft", s.weft, "positive");
    if (!(s.shear > 0.0) || s.shear > 0.5 * std::min(s.warp, s.weft) * (1.0 + 1e-9))
        refuse("shear", s.shear, "positive and at most half of the smaller of warp and weft");
    for (const double time : {s.stretch_damping, s.shear_damping})
        if (!(time >= 0.0) || !std::isfinite(time))
            throw InvalidInput(source + ": damping of stretch or shear = " + std::to_string(time) +
                               " s; it must be 0 or more");
}

} // namespace

Membrane::Membrane(std::shared_ptr<const RestShape> rest, const Settings& settings, const std::string& source,
                   std::vector<double> stiffness)
    : rest_(std::move(rest)), settings_(settings), stiffness_(std::move(stiffness))
{
    TOILE_ASSERT(stiffness_.empty() || stiffness_.size() == rest_->triangles.size());
    require_valid(settings, source);
    weights_.shear = 2.0 * settings.shear;
    weights_.warp = std::max(settings.warp - weights_.shear, 0.0);
    weights_.weft = std::max(settings.weft - weights_.shear, 0.0);
    const int triangles = int(rest_->triangles.size());
    for (int first = 0; first < triangles; first += kLanes) {
        Mat2Of<Lanes> inverse;
        for (int k = 0; k < 4; ++k)
            inverse(k) = gather(first, triangles, [&](int t) { return rest_->edges_inv[t](k); });
        rest_inv_.push_back(inverse);
        viscous_share_.push_back(
            gather(first, triangles, [&](int t) { return rest_->is_sliver(t) ? 0.0 : 1.0; }));
        area_.push_back(gather(first, triangles, [&](int t) { return weighted_area(size_t(t)); }));
    }
    corner_gradient_.resize(triangles);
    triangle_energy_.resize(triangles);
}

void Membrane::add_hessian(Triplets& H) const
{
    const Eigen::DiagonalMatrix<double, 2> weight(weights_.warp + weights_.shear,
                                                  weights_.weft + weights_.shear);
    for (size_t t = 0; t < rest_->triangles.size(); ++t) {
        // Rows of G: gradients of the hat functions of corners 0, 1, 2 in material axes.
        Mat32 G;
        G.bottomRows<2>() = rest_->edges_inv[t];
        G.row(0) = -G.row(1) - G.row(2);
        const Mat3 block = weighted_area(t) * G * weight * G.transpose();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                H.emplace_back(rest_->triangles[t][i], rest_->triangles[t][j], block(i, j));
    }
}

double Membrane::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const int triangles = int(rest_->triangles.size());
    parallel_for_lanes(kCpu, "membrane/project", triangles,
                       ProjectMembrane{x, rest_->triangles, rest_inv_, area_, weights_, viscosity(),
                                       corner_gradient_, triangle_energy_});
    const Incidence& corners = rest_->topology.corners_of_vertex;
    parallel_for(kCpu, "membrane/gather", gradient.size(),
                 GatherCorners{corners.first, corners.items, corner_gradient_, gradient});
    return parallel_sum(kCpu, triangles, 0.0, [&](int t) { return triangle_energy_[t]; });
}

ViscousWeights Membrane::viscous_weights(double dt) const
{
    const double stretch = settings_.stretch_damping, shear = settings_.shear_damping;
    return ViscousWeights{stretch * settings_.warp, stretch * settings_.weft, shear * settings_.shear}.over(
        dt);
}

void Membrane::begin_step(View<const Vec3> x, double dt)
{
    viscous_ = viscous_weights(dt);
    if (viscous_.are_zero())
        return;
    start_.resize(rest_inv_.size());
    parallel_for_lanes(kCpu, "membrane/strain", int(rest_->triangles.size()), [&](int block) {
        start_[block] =
            green_strain<Lanes>(deformation_gradients(x, rest_->triangles, rest_inv_[block], block));
    });
}

void Membrane::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    add_triangle_couplings(rest_->triangles, couplings);
}

bool Membrane::find_entries(SparseWindow, BlockWindow K)
{
    position_ = corner_positions(rest_->triangles, K);
    return false;
}

void Membrane::add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K)
{
    const int triangles = int(rest_->triangles.size());
    curvature_.resize(triangles);
    parallel_for_lanes(
        kCpu, "membrane/curvature", triangles,
        CurveMembrane{x, rest_->triangles, rest_inv_, weights_, viscosity(), definiteness, curvature_});
    const Incidence& corners = rest_->topology.corners_of_vertex;
    parallel_for(kCpu, "membrane/gather_curvature", x.size(), [&](int v) {
        for (int k = corners.first[v]; k < corners.first[v + 1]; ++k) {
            const int corner = corners.items[k], t = corner / 3;
            add_corner_row(curvature_[t], rest_->edges_inv[t], weighted_area(size_t(t)), corner % 3,
                           position_[corner], K.values(v));
        }
    });
}

bool Membrane::add_to(DeviceEnergies& energies, int first_vertex)
{
    TOILE_ASSERT(stiffness_.empty());
    energies.of_kind<DeviceElasticity>().add_membrane(*rest_, weights_, viscous_weights(1.0), first_vertex);
    return true;
}

} // namespace toile::garment
