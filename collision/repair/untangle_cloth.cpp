#include "collision/repair/untangle_cloth.h"

#include <algorithm>
#include <limits>

#include "collision/check/find_crossings.h"
#include "collision/repair/contour_minimization.h"
#include "collision/repair/smoothing.h"

namespace toile::collision {

namespace {

/// Maximum steps of contour minimisation without progress before patches are smoothed, and maximum number of
/// smoothings.
constexpr int kPatience = 30;
constexpr int kMaxSmoothings = 6;

/// Displacement per step over the mean edge length [-]; with larger ones cloth jumps over its neighbours.
constexpr double kStep = 0.1;

constexpr int kSweepsPerStep = 2;
constexpr int kSmoothingSweeps = 8;

/// Limits of the guarded relaxations: their maximum number, the maximum edge strain [-] that suffices, and
/// the number without an improvement by kStrainChange [-].
constexpr int kMaxRelaxations = 100;
constexpr double kGoodStrain = 0.01;
constexpr int kRelaxPatience = 10;
constexpr double kStrainChange = 1e-3;

/// Maximum number of times that moves are reverted around crossings before the whole relaxation is.
constexpr int kMaxTakeBacks = 12;

/// Passes of small pushes off bodies.
constexpr int kClearPasses = 20;

/// Reverts the corners of crossing triangles to where they were in a pose without crossings. False if that
/// does not end: then all vertices are.
bool take_back(const JoinedCloths& cloths, const std::vector<Vec3>& before, View<Vec3> x)
{
    for (int times = 0; times < kMaxTakeBacks; ++times) {
        const std::vector<Crossing> crossings = find_crossings(cloths.triangles, x);
        if (crossings.empty())
            return true;
        for (const Crossing& crossing : crossings)
            for (const int triangle : {crossing.a, crossing.b})
                for (const int v : cloths.triangles[triangle])
                    x[v] = before[v];
    }
    std::copy(before.begin(), before.end(), x.begin());
    return false;
}

/// Smoothing of patches around intersections; a patch grows with every smoothing of its vertices.
class Smoothing {
public:
    explicit Smoothing(const JoinedCloths& cloths) : cloths_(cloths), times_(cloths.vertex_count(), 0) {}

    void apply(const std::vector<EdgeTriangleIntersection>& intersections, ShapeKeeper& keeper, View<Vec3> x)
    {
        std::vector<char> all(times_.size(), 0);
        for (const EdgeTriangleIntersection& intersection : intersections) {
            std::vector<char> patch(times_.size(), 0);
            int times = 0;
            const auto add = [&](int v) {
                patch[v] = 1;
                times = std::max(times, times_[v]);
            };
            for (const int v : cloths_.edges.vertex[intersection.edge])
                add(v);
            for (const int v : cloths_.triangles[intersection.triangle])
                add(v);
            grow_patch(cloths_, times + 1, patch);
            for (size_t v = 0; v < patch.size(); ++v)
                all[v] = char(all[v] | patch[v]);
        }
        for (size_t v = 0; v < all.size(); ++v)
            times_[v] += all[v];
        smooth(cloths_, all, kSmoothingSweeps, x);
        keeper.unfold(all);
    }

private:
    const JoinedCloths& cloths_;
    std::vector<int> times_; ///< [vertices] number of smoothings
};

} // namespace

bool untangle(const JoinedCloths& cloths, const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x)
{
    Smoothing smoothing(cloths);
    size_t min_count = std::numeric_limits<size_t>::max();
    int smoothed = 0, stalled = 0;
    while (true) {
        const std::vector<EdgeTriangleIntersection> intersections =
            find_edge_triangle_intersections(cloths, x);
        if (intersections.empty())
            return true;
        stalled = intersections.size() < min_count ? 0 : stalled + 1;
        min_count = std::min(min_count, intersections.size());
        if (stalled == kPatience) {
            if (smoothed == kMaxSmoothings)
                return false;
            ++smoothed;
            smoothing.apply(intersections, keeper, x);
            stalled = 0;
            min_count = std::numeric_limits<size_t>::max();
            continue;
        }
        shorten_contours(cloths, intersections, kStep * cloths.mean_length, x);
        keeper.relax(x, kSweepsPerStep);
        clearing.project(x);
    }
}

void relax_untangled(const JoinedCloths& cloths, const BodyClearing& clearing, const ShapeKeeper& keeper,
                     View<Vec3> x, const RepairProgress& progress)
{
    double min_strain = edge_strain(cloths, x).max;
    int stalled = 0;
    for (int pass = 0; pass < kMaxRelaxations && stalled < kRelaxPatience && min_strain > kGoodStrain;
         ++pass) {
        progress.update(double(pass) / kMaxRelaxations);
        const std::vector<Vec3> before(x.begin(), x.end());
        keeper.relax(x, kSweepsPerStep);
        clearing.project(x);
        clearing.project_off_tips(x);
        if (!take_back(cloths, before, x))
            return;
        const double strain = edge_strain(cloths, x).max;
        stalled = strain < min_strain - kStrainChange ? 0 : stalled + 1;
        min_strain = std::min(min_strain, strain);
    }
}

void clear_crossings(const JoinedCloths& cloths, const BodyClearing& clearing, View<Vec3> x)
{
    if (clearing.crossings(x).empty())
        return;
    const bool is_tangled = !find_crossings(cloths.triangles, x).empty();
    std::vector<Vec3> before(x.begin(), x.end());
    const auto may_go_on = [&] { return is_tangled || take_back(cloths, before, x); };
    clearing.project(x);
    std::vector<double> pushed(x.size(), 0.0);
    for (int pass = 0; may_go_on() && pass < kClearPasses; ++pass) {
        before.assign(x.begin(), x.end());
        if (!clearing.push_off_crossings(x, pushed))
            return;
    }
}

} // namespace toile::collision
