#include "garment/energy/stretch_tension.h"

#include <algorithm>

#include "core/backend/parallel.h"
#include "garment/energy/membrane_kernels.h"
#include "garment/energy/principal_stretch.h"
#include "garment/energy/stretch_curvature.h"

namespace toile {

namespace {

/// Share of the limit at which a triangle is watched during a step [-]. A triangle that passes the limit from
/// below this within one step is clamped, and watched in the next.
constexpr double kWatched = 0.7;

} // namespace

StretchTension::StretchTension(std::shared_ptr<const RestShape> rest, const Settings& settings)
    : rest_(std::move(rest)), settings_(settings), tension_(rest_->triangles.size(), Mat2::Zero()),
      near_(rest_->triangles.size())
{
    for (int t = 0; t < int(rest_->triangles.size()); ++t)
        is_sliver_.push_back(rest_->is_sliver(t));
}

void StretchTension::begin_step(View<const Vec3> x)
{
    const double watched = 1.0 + kWatched * settings_.limit;
    parallel_for(kCpu, "stretch_tension/watch", int(near_.size()), [&](int t) {
        near_[t] = !is_sliver_[t] &&
                   (!tension_[t].isZero(0.0) || largest_stretch(rest_->deformation_gradient(t, x)) > watched);
    });
    taut_.clear();
    for (int t = 0; t < int(near_.size()); ++t)
        if (near_[t])
            taut_.push_back({t, closest_isometry<double>(rest_->deformation_gradient(t, x)) * tension_[t]});
    stress_.resize(taut_.size());
}

/// G - P(G)
Mat32 StretchTension::excess(const Taut& taut, View<const Vec3> x) const
{
    const Mat32 G = rest_->deformation_gradient(taut.triangle, x) + taut.tension;
    const double allowed = 1.0 + settings_.limit;
    if (largest_stretch(G) <= allowed)
        return Mat32::Zero();
    const PrincipalStretch stretch = principal_stretch(G);
    const Vec2 share = (1.0 - allowed / stretch.sigma.array().max(allowed)).matrix();
    return G * stretch.V * share.asDiagonal() * stretch.V.transpose();
}

double StretchTension::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const int count = int(taut_.size());
    parallel_for(kCpu, "stretch_tension/excess", count, [&](int i) { stress_[i] = excess(taut_[i], x); });
    double energy = 0.0;
    for (int i = 0; i < count; ++i) {
        if (stress_[i].isZero(0.0))
            continue;
        const int t = taut_[i].triangle;
        const double weight = settings_.stiffness * rest_->areas[t];
        energy += 0.5 * weight * stress_[i].squaredNorm();
        const Mat32 pull = weight * stress_[i] * rest_->edges_inv[t].transpose();
        const Triangle& corner = rest_->triangles[t];
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

/// The excess is convex in x: exact and projected are the same.
void StretchTension::add_curvature(View<const Vec3> x, Definiteness, BlockWindow K)
{
    for (const Taut& taut : taut_) {
        const int t = taut.triangle;
        const Mat32 G = rest_->deformation_gradient(t, x) + taut.tension;
        if (largest_stretch(G) <= 1.0 + settings_.limit)
            continue;
        const StretchCurvature H = excess_curvature(G, 1.0 + settings_.limit);
        for (int row = 0; row < 3; ++row)
            add_corner_row(H, rest_->edges_inv[t], settings_.stiffness * rest_->areas[t], rest_->triangles[t],
                           row, K);
    }
}

void StretchTension::remember(View<const Vec3> x)
{
    for (const Taut& taut : taut_) {
        const Mat32 F = rest_->deformation_gradient(taut.triangle, x);
        Mat2 tension = closest_isometry<double>(F).transpose() * excess(taut, x);
        const double size = tension.norm();
        if (size > settings_.max_tension)
            tension *= settings_.max_tension / size;
        tension_[taut.triangle] = tension;
    }
}

} // namespace toile
