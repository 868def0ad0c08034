#include "collision/untangle/untangle_cloth.h"

#include <algorithm>
#include <limits>

#include "collision/crossings/find_crossings.h"
#include "collision/untangle/contour_minimization.h"
#include "collision/untangle/ironing.h"

namespace toile {

namespace {

/// Steps of contour minimisation that may go by without progress before a patch is ironed, and how far
/// patches may grow, a ring each time.
constexpr int kPatience = 20;
constexpr int kMaxRings = 6;

/// Displacement per step over the mean edge length [-]: further, and cloth jumps over its neighbours.
constexpr double kStep = 0.1;

constexpr int kSweepsPerStep = 2;
constexpr int kIronSweeps = 8;

/// Guarded relaxations at most, and the change of the largest strain that ends them [-].
constexpr int kMaxRelaxations = 200;
constexpr double kStrainChange = 1e-4;

/// Times that moves are taken back around crossings before all of a relaxation is.
constexpr int kMaxTakeBacks = 12;

/// Takes the corners of crossing triangles back to `before`. False when nothing crossed.
bool take_back(const JoinedCloths& cloths, const std::vector<Vec3>& before, View<Vec3> x)
{
    const std::vector<Crossing> crossings = find_crossings(cloths.triangles, x);
    for (const Crossing& crossing : crossings)
        for (const int triangle : {crossing.a, crossing.b})
            for (const int v : cloths.triangles[triangle])
                x[v] = before[v];
    return !crossings.empty();
}

void iron_patch(const JoinedCloths& cloths, const std::vector<Piercing>& piercings, int rings,
                ShapeKeeper& keeper, View<Vec3> x)
{
    const std::vector<char> patch = patch_around(cloths, piercings, rings);
    iron(cloths, patch, kIronSweeps, x);
    keeper.unfold(patch);
}

} // namespace

bool untangle(const JoinedCloths& cloths, const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x)
{
    size_t fewest = std::numeric_limits<size_t>::max();
    int rings = 0, stalled = 0;
    while (rings <= kMaxRings) {
        const std::vector<Piercing> piercings = find_piercings(cloths, x);
        if (piercings.empty())
            return true;
        stalled = piercings.size() < fewest ? 0 : stalled + 1;
        fewest = std::min(fewest, piercings.size());
        if (stalled == kPatience) {
            iron_patch(cloths, piercings, ++rings, keeper, x);
            stalled = 0;
            fewest = std::numeric_limits<size_t>::max();
            continue;
        }
        shorten_contours(cloths, piercings, kStep * cloths.mean_length, x);
        keeper.relax(x, kSweepsPerStep);
        clearing.push(x);
    }
    return false;
}

void relax_untangled(const JoinedCloths& cloths, const BodyClearing& clearing, const ShapeKeeper& keeper,
                     View<Vec3> x)
{
    double strain = edge_strain(cloths, x).max;
    for (int round = 0; round < kMaxRelaxations; ++round) {
        const std::vector<Vec3> before(x.begin(), x.end());
        keeper.relax(x, 1);
        clearing.push(x);
        int times = 0;
        while (times < kMaxTakeBacks && take_back(cloths, before, x))
            ++times;
        if (times == kMaxTakeBacks) {
            std::copy(before.begin(), before.end(), x.begin());
            return;
        }
        const double now = edge_strain(cloths, x).max;
        if (strain - now < kStrainChange && round > 10)
            return;
        strain = now;
    }
}

} // namespace toile
