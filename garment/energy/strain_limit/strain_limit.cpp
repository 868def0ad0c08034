#include "garment/energy/strain_limit/strain_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/colouring.h"
#include "garment/energy/strain_limit/joint_strain_limit.h"

namespace toile::garment {

namespace {

/// Maximum stretch as a reduction: += takes the maximum.
struct LargestStretch {
    double value = 0.0;
    LargestStretch& operator+=(const LargestStretch& other)
    {
        value = std::max(value, other.value);
        return *this;
    }
};

/// Estimated triangles that share a vertex with a given one, counted per vertex.
constexpr size_t kNeighbourhood = 18;

} // namespace

StrainLimit::StrainLimit(std::shared_ptr<const RestShape> rest, const ByFabric<Settings>& settings,
                         const std::string& source)
    : rest_(std::move(rest)), least_limit_(std::numeric_limits<double>::infinity()),
      rank_(rest_->triangles.size()), violates_(rest_->triangles.size())
{
    for (const Settings& fabric : settings.settings) {
        if (!(fabric.limit > 0.0) || !std::isfinite(fabric.limit))
            throw InvalidInput(source + ": strain limit " + std::to_string(fabric.limit) +
                               " must be positive");
        least_limit_ = std::min(least_limit_, fabric.limit);
        max_sweeps_ = std::max(max_sweeps_, fabric.max_sweeps);
        limits_.push_back({1.0 + fabric.limit, 1.0 + fabric.limit + fabric.tolerance});
        limits_.push_back({1.0 + fabric.limit, std::numeric_limits<double>::infinity()});
    }
    for (int t = 0; t < int(rest_->triangles.size()); ++t) {
        kind_.push_back(2 * settings.fabric_of(t) + (rest_->is_sliver(t) ? 1 : 0));
        has_slivers_ = has_slivers_ || rest_->is_sliver(t);
    }
    for (const auto& colour : colour_triangles(rest_->triangles, rest_->vertex_count())) {
        order_.insert(order_.end(), colour.begin(), colour.end());
        first_of_colour_.push_back(int(order_.size()));
    }
    for (int k = 0; k < int(order_.size()); ++k)
        rank_[order_[k]] = k;
}

View<const int> StrainLimit::triangles_of(int colour) const
{
    const int first = first_of_colour_[colour];
    return View<const int>(order_).subview(first, first_of_colour_[colour + 1] - first);
}

LimitedTriangles StrainLimit::triangles() const
{
    return {rest_->triangles, rest_->edges, rest_->edges_inv, kind_, limits_};
}

double StrainLimit::max_strain(View<const Vec3> x) const
{
    const LargestStretch largest =
        parallel_sum(kCpu, int(kind_.size()), LargestStretch{},
                     [&, triangles = triangles()](int t) { return LargestStretch{triangles.stretch(t, x)}; });
    return largest.value - 1.0;
}

StrainLimit::Excess StrainLimit::excess(View<const Vec3> x, double margin,
                                        View<const unsigned char> held) const
{
    Excess excess;
    for (int t = 0; t < int(kind_.size()); ++t) {
        if (kind_[t] % 2 != 0)
            continue;
        const double stretch = triangles().stretch(t, x);
        if (!(stretch > limits_[kind_[t]].allowed + margin))
            continue;
        const Triangle& corner = rest_->triangles[t];
        if (!held.empty() && held[corner[0]] != 0 && held[corner[1]] != 0 && held[corner[2]] != 0) {
            excess.first_held = excess.held++ == 0 ? t : excess.first_held;
            continue;
        }
        ++excess.count;
        if (stretch - 1.0 > excess.strain) {
            excess.triangle = t;
            excess.strain = stretch - 1.0;
        }
    }
    return excess;
}

void StrainLimit::check_all(View<const Vec3> x)
{
    parallel_for(kCpu, "strain_limit/find", int(kind_.size()),
                 [&, triangles = triangles()](int t) { violates_[t] = triangles.violates(t, x); });
    violating_.clear();
    for (const int t : order_)
        if (violates_[t])
            violating_.push_back(t);
}

/// Updates the violations among triangles that share a vertex with one moved by the last sweep.
void StrainLimit::check_near_violating(View<const Vec3> x)
{
    const LimitedTriangles triangles = this->triangles();
    const Incidence& corners = rest_->topology.corners_of_vertex;
    std::vector<int> ranks;
    for (const int moved : violating_)
        for (const int v : rest_->triangles[moved])
            for (const int corner : corners.of(v)) {
                const int t = corner / 3;
                if (triangles.violates(t, x))
                    ranks.push_back(rank_[t]);
            }
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    violating_.clear();
    for (const int rank : ranks)
        violating_.push_back(order_[rank]);
}

void StrainLimit::observe(View<const Vec3> x)
{
    if (tension_)
        tension_->remember(x);
}

void StrainLimit::project(View<Vec3> x, View<const double> inverse_masses,
                          const std::function<bool()>& clear_contacts)
{
    JointStrainLimit({{this, 0, x.size()}}).project(x, inverse_masses, clear_contacts);
}

bool StrainLimit::find_violations(View<const Vec3> x)
{
    check_all(x);
    return violates();
}

void StrainLimit::keep(View<const Vec3> x) { before_.assign(x.begin(), x.end()); }

void StrainLimit::sweep(int number, View<Vec3> x, View<const double> inverse_masses)
{
    // Alternate the direction so that corrections propagate in both directions through the mesh.
    if (number % 2 == 1)
        std::reverse(violating_.begin(), violating_.end());
    const ClampTriangle clamp{triangles(), inverse_masses, x};
    for (const int t : violating_)
        clamp(t);
}

void StrainLimit::update_violations(View<const Vec3> x, bool has_moved_elsewhere)
{
    if (has_moved_elsewhere || kNeighbourhood * violating_.size() > violates_.size())
        check_all(x);
    else
        check_near_violating(x);
}

void StrainLimit::end(View<Vec3> x) const
{
    // Undo sweeps that end worse than they began, since they would become velocity. Millimetres that correct
    // a wide triangle or a contact are many times the height of a sliver beside it. The membrane alone does
    // better.
    if ((violates() || has_slivers_) && max_strain(x) > max_strain(before_))
        std::copy(before_.begin(), before_.end(), x.begin());
}

} // namespace toile::garment
