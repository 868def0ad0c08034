#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "collision/contact/cloth_contact_kernels.h"
#include "collision/contact/memory.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kKeep = 5e-4, kMinGap = 1e-4; // [m]

/// A point above a surface, pressed down by a spring of its own towards a place below it.
struct Pressed {
    double stiffness; ///< [N/m]
    double below;     ///< [m]
    ContactTerm term;

    Pressed(double pressing, double towards) : stiffness(pressing), below(towards)
    {
        term.spring = {800.0, 0.6 * kKeep, 0.7 * kKeep};
    }

    /// Gap in equilibrium [m], by bisection.
    double gap() const
    {
        double low = -below, high = kKeep + term.spring.shift;
        for (int k = 0; k < 100; ++k) {
            const double middle = 0.5 * (low + high);
            const double force = term.spring.force(kKeep - middle) - stiffness * (middle + below);
            (force > 0.0 ? low : high) = middle;
        }
        return low;
    }

    /// Number of updates until the gap is at least half of the smallest.
    int updates(bool is_near = true)
    {
        int count = 0;
        while (gap() < 0.5 * kMinGap && count < 1000) {
            term.multiplier.shortfall = kMinGap - gap();
            term.update_multiplier(is_near);
            ++count;
        }
        return count;
    }
};

TEST(ContactMultiplier, IsNotNeededByWhatTheSpringHolds) { EXPECT_EQ(Pressed(100.0, 1e-3).updates(), 0); }

TEST(ContactMultiplier, HoldsWhatPressesHarder)
{
    EXPECT_LE(Pressed(800.0, 0.01).updates(), 10);
    EXPECT_LE(Pressed(8e4, 0.001).updates(), 25) << "much stiffer, as cloth at its strain limit is";
}

TEST(ContactMultiplier, GrowsSlowlyFarFromTheMinimum)
{
    EXPECT_GT(Pressed(8e4, 0.001).updates(false), 3 * Pressed(8e4, 0.001).updates(true));
}

TEST(ContactMultiplier, VanishesWhenNothingPresses)
{
    Pressed pressed(800.0, 0.01);
    pressed.updates();
    EXPECT_GT(pressed.term.spring.shift, 0.0);
    pressed.term.multiplier.shortfall = -0.01;
    pressed.term.update_multiplier(true);
    EXPECT_EQ(pressed.term.spring.shift, 0.0);
}

/// Vertex 7 pressed by a face of cloth from above, with a multiplier.
ContactTerm pressed_by(const std::array<int, 3>& face, double shift)
{
    ContactTerm term;
    term.pair.kind = ContactKind::kClothVertexFace;
    term.pair.vertex = {7, face[0], face[1], face[2]};
    term.pair.normal = Vec3::UnitY();
    term.min_gap = 2e-4;
    term.normal_force = 1.0;
    term.multiplier.shift = shift;
    return term;
}

TEST(ContactMultiplier, BelongsToItsPair)
{
    ContactMemory memory;
    memory.keep(pressed_by({1, 2, 3}, 2e-4), Vec3::Zero());
    memory.keep(pressed_by({4, 5, 6}, 5e-4), Vec3::Zero());
    const auto shift_of = [&](const std::array<int, 3>& face) {
        ContactTerm term = pressed_by(face, 0.0);
        memory.warm_start(term);
        return term.spring.shift;
    };
    EXPECT_EQ(shift_of({1, 2, 3}), 2e-4);
    EXPECT_EQ(shift_of({4, 5, 6}), 5e-4);
    EXPECT_EQ(shift_of({2, 3, 8}), 5e-4) << "a neighbour gets the larger one: cloth slides on";
}

/// Two edges that cross in projection 0.3 mm apart. Both belong to flat cloth, in which they face each other
/// nowhere near their closest points.
TEST(FindPressing, TakesPairsThatHaveStoppedCloth)
{
    const std::vector<Triangle> triangles{{0, 1, 4}, {2, 3, 5}};
    const std::vector<Vec3> base{{0.0, 0.0, 0.0},  {1.0, 0.0, 0.0},  {0.99, 3e-4, 0.0},
                                 {1.9, 3e-4, 0.5}, {0.5, 0.0, -1.0}, {1.5, 1.0, 1.0}};
    const std::vector<Vec3> still(base.size(), Vec3::Zero());
    const std::vector<double> slack(base.size(), 0.0), half(base.size(), 2.5e-4);
    NearPairs near(triangles, base);
    std::vector<NearPair> pairs;
    near.find(base, {still, slack}, 5e-4, pairs);
    const auto count = [&](View<const unsigned char> stopped) {
        const FindPressing find{near.soup(), base, still, base, slack, {half}, stopped};
        ContactPair out;
        return std::count_if(pairs.begin(), pairs.end(),
                             [&](const NearPair& pair) { return find(pair, out); });
    };
    const std::vector<unsigned char> all(base.size(), 1), none(base.size(), 0);
    ASSERT_FALSE(pairs.empty());
    EXPECT_LT(count({}), int(pairs.size()));
    EXPECT_EQ(count(none), count({}));
    EXPECT_EQ(count(all), int(pairs.size()));
}

} // namespace
} // namespace toile::test
