#include "garment/energy/strain_limit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/backend/error.h"
#include "core/backend/parallel.h"
#include "garment/energy/principal_stretch.h"

namespace toile {

namespace {

/// Mass of a fixed vertex relative to the heaviest free one while a triangle is fitted [-].
constexpr double kFixedMassRatio = 1e6;

/// Sweeps that clear contacts too. Beyond them the limit goes before contact: cloth caught between colliders,
/// where the two contradict each other, would never come to an end.
constexpr int kSweepsWithContact = 30;

/// Triangles that share a vertex with a given one, counted per vertex.
constexpr size_t kNeighbourhood = 18;

/// Masses of a triangle's corners up to a common factor.
Vec3 relative_masses(const Triangle& corner, View<const double> inverse_masses)
{
    Vec3 masses;
    double heaviest = 0.0;
    for (int k = 0; k < 3; ++k) {
        masses[k] = inverse_masses[corner[k]] > 0.0 ? 1.0 / inverse_masses[corner[k]] : 0.0;
        heaviest = std::max(heaviest, masses[k]);
    }
    for (double& mass : masses)
        if (mass == 0.0)
            mass = kFixedMassRatio * heaviest;
    return masses;
}

} // namespace

StrainLimit::StrainLimit(std::shared_ptr<const RestShape> rest, const Settings& settings,
                         const std::string& source)
    : rest_(std::move(rest)), settings_(settings), violates_(rest_->triangles.size())
{
    if (!(settings.limit > 0.0) || !std::isfinite(settings.limit))
        throw InvalidInput(source + ": strain limit " + std::to_string(settings.limit) + " must be positive");
    for (int t = 0; t < int(rest_->triangles.size()); ++t) {
        is_sliver_.push_back(rest_->is_sliver(t));
        has_slivers_ = has_slivers_ || is_sliver_.back();
    }
}

double StrainLimit::max_strain(View<const Vec3> x) const
{
    double largest = 0.0;
    for (int t = 0; t < int(is_sliver_.size()); ++t)
        largest = std::max(largest, largest_stretch(rest_->deformation_gradient(t, x)));
    return largest - 1.0;
}

bool StrainLimit::violates(int t, View<const Vec3> x) const
{
    return !is_sliver_[t] &&
           largest_stretch(rest_->deformation_gradient(t, x)) > 1.0 + settings_.limit + settings_.tolerance;
}

void StrainLimit::look_at_everything(View<const Vec3> x)
{
    parallel_for(kCpu, "strain_limit/find", int(is_sliver_.size()),
                 [&](int t) { violates_[t] = violates(t, x); });
    violating_.clear();
    for (int t = 0; t < int(violates_.size()); ++t)
        if (violates_[t])
            violating_.push_back(t);
}

/// Looks again at the triangles that share a vertex with one that a sweep has just moved.
void StrainLimit::look_around_violating(View<const Vec3> x)
{
    const Incidence& corners = rest_->topology.corners_of_vertex;
    std::vector<int> found;
    for (const int moved : violating_)
        for (const int v : rest_->triangles[moved])
            for (const int corner : corners.of(v)) {
                const int t = corner / 3;
                if (violates(t, x))
                    found.push_back(t);
            }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    violating_.swap(found);
}

void StrainLimit::observe(View<const Vec3> x)
{
    if (tension_)
        tension_->remember(x);
}

void StrainLimit::project(View<Vec3> x, View<const double> inverse_masses,
                          const std::function<bool()>& clear_contacts)
{
    look_at_everything(x);
    if (violating_.empty())
        return;
    before_.assign(x.begin(), x.end());
    for (int sweep = 0; sweep < settings_.max_sweeps && !violating_.empty(); ++sweep) {
        const StageScope stage("garment/strain_limit");

        // Alternate the direction so that corrections travel both ways through the mesh.
        if (sweep % 2 == 1)
            std::reverse(violating_.begin(), violating_.end());
        for (const int t : violating_)
            clamp_triangle(t, x, inverse_masses);
        const bool cleared = clear_contacts && sweep < kSweepsWithContact && clear_contacts();
        if (cleared || kNeighbourhood * violating_.size() > violates_.size())
            look_at_everything(x);
        else
            look_around_violating(x);
    }

    // Millimetres that clear a wide triangle or a contact are many times the height of a sliver beside it.
    // Sweeps that end worse than they began would turn that into velocity; the membrane does better alone.
    if ((!violating_.empty() || has_slivers_) && max_strain(x) > max_strain(before_))
        std::copy(before_.begin(), before_.end(), x.begin());
}

void StrainLimit::clamp_triangle(int t, View<Vec3> x, View<const double> inverse_masses) const
{
    const Triangle& corner = rest_->triangles[t];
    const Mat32 F = rest_->deformation_gradient(t, x);
    const PrincipalStretch stretch = principal_stretch(F);
    const double allowed = 1.0 + settings_.limit;
    if (stretch.sigma[0] <= allowed)
        return;

    // Clamped edges: F V diag(min(sigma, allowed) / sigma) V^T times the rest edges.
    const Vec2 scale(allowed / stretch.sigma[0], std::min(1.0, allowed / std::max(stretch.sigma[1], 1e-300)));
    const Mat32 edges = F * stretch.V * scale.asDiagonal() * stretch.V.transpose() * rest_->edges[t];

    // Keep the centre of mass; fixed corners are heavy while fitting and do not move at all.
    const Vec3 masses = relative_masses(corner, inverse_masses);
    const Vec3 center =
        (masses[0] * x[corner[0]] + masses[1] * x[corner[1]] + masses[2] * x[corner[2]]) / masses.sum();
    const Vec3 first = center - (masses[1] * edges.col(0) + masses[2] * edges.col(1)) / masses.sum();
    const std::array<Vec3, 3> moved{first, first + edges.col(0), first + edges.col(1)};
    for (int k = 0; k < 3; ++k)
        if (inverse_masses[corner[k]] > 0.0)
            x[corner[k]] = moved[k];
}

} // namespace toile
