#include "garment/energy/strain_limit/stretch_tension.h"

#include <algorithm>
#include <limits>

#include "core/compute/parallel.h"
#include "garment/energy/strain_limit/cuda/stretch_tension.h"

namespace toile::garment {

StretchTension::StretchTension(std::shared_ptr<const RestShape> rest, const ByFabric<Settings>& settings)
    : rest_(std::move(rest)), tension_(rest_->triangles.size(), Mat2::Zero()), near_(rest_->triangles.size()),
      rotated_tension_(rest_->triangles.size(), Mat32::Zero())
{
    for (const Settings& fabric : settings.settings) {
        limits_.push_back(
            {1.0 + fabric.limit, 1.0 + fabric.watched * fabric.limit, fabric.stiffness, fabric.max_tension});
        limits_.push_back(limits_.back());
        limits_.back().watched = std::numeric_limits<double>::infinity();
    }
    for (int t = 0; t < int(rest_->triangles.size()); ++t)
        kind_.push_back(2 * settings.fabric_of(t) + (rest_->is_sliver(t) ? 1 : 0));
}

TensionTriangles StretchTension::triangles() const
{
    return {rest_->triangles, rest_->edges_inv, rest_->areas, kind_, limits_};
}

void StretchTension::begin_step(View<const Vec3> x)
{
    if (is_on_device_)
        return;
    parallel_for(kCpu, "stretch_tension/watch", int(near_.size()),
                 WatchTriangle{triangles(), x, tension_, near_, rotated_tension_});
    taut_.clear();
    for (int t = 0; t < int(near_.size()); ++t)
        if (near_[t])
            taut_.push_back(t);
    response_.resize(taut_.size());
}

void StretchTension::forget()
{
    std::fill(tension_.begin(), tension_.end(), Mat2::Zero());
    ++forgotten_;
}

double StretchTension::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const int count = int(taut_.size());
    parallel_for(kCpu, "stretch_tension/excess", count,
                 PullTautTriangle{{triangles(), x, rotated_tension_}, taut_, response_});
    double energy = 0.0;
    for (int i = 0; i < count; ++i) {
        if (response_[i].energy == 0.0)
            continue;
        energy += response_[i].energy;
        const Mat32& pull = response_[i].corner_gradient;
        const Triangle& corner = rest_->triangles[taut_[i]];
        gradient[corner[0]] -= pull.col(0) + pull.col(1);
        gradient[corner[1]] += pull.col(0);
        gradient[corner[2]] += pull.col(1);
    }
    return energy;
}

void StretchTension::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    add_triangle_couplings(rest_->triangles, couplings);
}

bool StretchTension::find_entries(SparseWindow, BlockWindow K)
{
    position_ = corner_positions(rest_->triangles, K);
    return false;
}

void StretchTension::add_curvature(View<const Vec3> x, Definiteness, BlockWindow K)
{
    const TensionPull pull{triangles(), x, rotated_tension_};
    exceeds_.resize(taut_.size());
    parallel_for(kCpu, "stretch_tension/find", int(taut_.size()),
                 [&](int i) { exceeds_[i] = pull.exceeds(taut_[i]); });
    for (int i = 0; i < int(taut_.size()); ++i) {
        if (!exceeds_[i])
            continue;
        const int t = taut_[i];
        const StretchCurvature H = pull.curvature(t);
        for (int row = 0; row < 3; ++row)
            add_corner_row(H, rest_->edges_inv[t], pull.weight(t), row, position_[3 * t + row],
                           K.values(rest_->triangles[t][row]));
    }
}

bool StretchTension::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceStretchTension>().add(*this, first_vertex);
    is_on_device_ = true;
    return true;
}

void StretchTension::remember(View<const Vec3> x)
{
    const RememberTension remember{{triangles(), x, rotated_tension_}, near_, tension_};
    for (const int t : taut_)
        remember(t);
}

} // namespace toile::garment
