#include "collision/skin/skin_separation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "collision/check/find_crossings.h"
#include "core/base/stages.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kRadius = 0.06;     ///< [m] of a limb
constexpr double kClearance = 0.008; ///< [m]

/// Two upright limbs, ellipsoids of 48 cm, with `gap` [m] between them along x.
TriangleMesh limbs(double gap)
{
    TriangleMesh body;
    for (const double side : {-1.0, 1.0}) {
        TriangleMesh limb = testing::sphere_mesh(Vec3::Zero(), kRadius, 4);
        const int first = body.vertex_count();
        for (Vec3 x : limb.positions) {
            x.y() *= 4.0;
            x.x() += side * (kRadius + 0.5 * gap);
            body.positions.push_back(x);
        }
        for (const Triangle& t : limb.triangles)
            body.triangles.push_back(t.array() + first);
    }
    return body;
}

/// Insets of the limbs at `gap`, when they are 20 cm apart at rest.
struct Separated {
    TriangleMesh body;
    std::vector<double> insets;
    std::vector<Vec3> moved;

    explicit Separated(double gap, double rest_gap = 0.2) : body(limbs(gap))
    {
        SkinSeparation separation(body.triangles, limbs(rest_gap).positions, kClearance);
        insets = separation.insets(body.positions, separation.inward());
        for (size_t v = 0; v < insets.size(); ++v)
            moved.push_back(body.positions[v] + insets[v] * separation.inward()[v]);
    }

    double max_inset() const { return *std::max_element(insets.begin(), insets.end()); }
    size_t crossings() const { return find_crossings(body.triangles, moved).size(); }

    /// Room left between the limbs along x [m].
    double gap() const
    {
        double left = -1.0, right = 1.0;
        for (size_t v = 0; v < moved.size(); ++v)
            if (v < moved.size() / 2)
                left = std::max(left, moved[v].x());
            else
                right = std::min(right, moved[v].x());
        return right - left;
    }
};

TEST(SkinSeparation, MakesRoomBetweenLimbsThatOverlap)
{
    const Separated separated(-0.01);
    EXPECT_GT(find_crossings(separated.body.triangles, separated.body.positions).size(), 100u);
    EXPECT_EQ(separated.crossings(), 0u);
    EXPECT_GT(separated.gap(), 0.85 * kClearance);
    EXPECT_LT(separated.gap(), 2.0 * kClearance);
    // Each limb gives half.
    EXPECT_NEAR(separated.max_inset(), 0.5 * (0.01 + kClearance), 0.002);
}

TEST(SkinSeparation, MakesRoomBetweenLimbsThatAreNear)
{
    const Separated separated(0.003);
    EXPECT_GT(separated.gap(), 0.9 * kClearance);
    EXPECT_LT(separated.max_inset(), 0.5 * (kClearance - 0.003) + 0.001);
}

TEST(SkinSeparation, LeavesSkinAloneThatIsApart)
{
    EXPECT_EQ(Separated(0.02).max_inset(), 0.0);
    // Near at rest as well: an eyelid, or toes.
    EXPECT_EQ(Separated(0.003, 0.003).max_inset(), 0.0);
}

TEST(SkinSeparation, NeverMovesSkinFurtherThanItMay)
{
    const Separated separated(-0.07);
    EXPECT_LE(separated.max_inset(), SkinSeparation::kMaxInset);
    EXPECT_GT(separated.max_inset(), 0.99 * SkinSeparation::kMaxInset);
    EXPECT_GT(separated.crossings(), 0u); // 7 cm are too much
}

TEST(SkinSeparation, IsGradualOverTheSurface)
{
    const Separated separated(-0.01);
    for (const Triangle& t : separated.body.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            const double edge = (separated.body.positions[a] - separated.body.positions[b]).norm();
            EXPECT_LE(separated.insets[a] - separated.insets[b],
                      SkinSeparation::kSlope * edge + 2e-4); // insets of .1 mm are not followed
        }
}

TEST(SkinSeparation, GrowsGraduallyAsLimbsClose)
{
    double before = 0.0;
    for (double gap = 0.01; gap > -0.012; gap -= 0.001) {
        const double inset = Separated(gap).max_inset();
        EXPECT_GE(inset, before - 2e-4) << gap;
        EXPECT_LE(inset, before + 0.0016) << gap;
        before = inset;
    }
    EXPECT_GT(before, 0.009);
}

TEST(SkinSeparation, IsOneStage)
{
    Stages stages;
    const Stages::Activate recording(stages);
    Separated{0.02};
    EXPECT_EQ(stages.calls("collision/skin_separation"), 1);
}

} // namespace

} // namespace toile::test
