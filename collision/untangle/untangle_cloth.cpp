#include "collision/untangle/untangle_cloth.h"

#include <algorithm>
#include <limits>

#include "collision/crossings/find_crossings.h"
#include "collision/untangle/contour_minimization.h"
#include "collision/untangle/ironing.h"

namespace toile {

namespace {

/// Steps of contour minimisation that may go by without progress before patches are ironed, and how often
/// they are.
constexpr int kPatience = 30;
constexpr int kMaxIronings = 6;

/// Displacement per step over the mean edge length [-]: further, and cloth jumps over its neighbours.
constexpr double kStep = 0.1;

constexpr int kSweepsPerStep = 2;
constexpr int kIronSweeps = 8;

/// Guarded relaxations: at most; with the largest edge strain [-] that is good enough; and those that may go
/// by without bettering it by kStrainChange [-].
constexpr int kMaxRelaxations = 100;
constexpr double kGoodStrain = 0.01;
constexpr int kRelaxPatience = 10;
constexpr double kStrainChange = 1e-3;

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

/// Irons around piercings, the further the more often it was in vain.
class Ironing {
public:
    explicit Ironing(const JoinedCloths& cloths) : cloths_(cloths), times_(cloths.vertex_count(), 0) {}

    void apply(const std::vector<Piercing>& piercings, ShapeKeeper& keeper, View<Vec3> x)
    {
        std::vector<char> all(times_.size(), 0);
        for (const Piercing& piercing : piercings) {
            std::vector<char> patch(times_.size(), 0);
            int times = 0;
            const auto add = [&](int v) {
                patch[v] = 1;
                times = std::max(times, times_[v]);
            };
            for (const int v : cloths_.edges.vertex[piercing.edge])
                add(v);
            for (const int v : cloths_.triangles[piercing.triangle])
                add(v);
            grow_patch(cloths_, times + 1, patch);
            for (size_t v = 0; v < patch.size(); ++v)
                all[v] = char(all[v] | patch[v]);
        }
        for (size_t v = 0; v < all.size(); ++v)
            times_[v] += all[v];
        iron(cloths_, all, kIronSweeps, x);
        keeper.unfold(all);
    }

private:
    const JoinedCloths& cloths_;
    std::vector<int> times_; ///< [vertices] that they were ironed
};

} // namespace

bool untangle(const JoinedCloths& cloths, const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x)
{
    Ironing ironing(cloths);
    size_t fewest = std::numeric_limits<size_t>::max();
    int ironed = 0, stalled = 0;
    while (true) {
        const std::vector<Piercing> piercings = find_piercings(cloths, x);
        if (piercings.empty())
            return true;
        stalled = piercings.size() < fewest ? 0 : stalled + 1;
        fewest = std::min(fewest, piercings.size());
        if (stalled == kPatience) {
            if (ironed == kMaxIronings)
                return false;
            ++ironed;
            ironing.apply(piercings, keeper, x);
            stalled = 0;
            fewest = std::numeric_limits<size_t>::max();
            continue;
        }
        shorten_contours(cloths, piercings, kStep * cloths.mean_length, x);
        keeper.relax(x, kSweepsPerStep);
        clearing.push(x);
    }
}

void relax_untangled(const JoinedCloths& cloths, const BodyClearing& clearing, const ShapeKeeper& keeper,
                     View<Vec3> x)
{
    double least = edge_strain(cloths, x).max;
    int stalled = 0;
    for (int round = 0; round < kMaxRelaxations && stalled < kRelaxPatience && least > kGoodStrain; ++round) {
        const std::vector<Vec3> before(x.begin(), x.end());
        keeper.relax(x, kSweepsPerStep);
        clearing.push(x);
        clearing.push_off_tips(x);
        int times = 0;
        while (times < kMaxTakeBacks && take_back(cloths, before, x))
            ++times;
        if (times == kMaxTakeBacks) {
            std::copy(before.begin(), before.end(), x.begin());
            return;
        }
        const double strain = edge_strain(cloths, x).max;
        stalled = strain < least - kStrainChange ? 0 : stalled + 1;
        least = std::min(least, strain);
    }
}

} // namespace toile
