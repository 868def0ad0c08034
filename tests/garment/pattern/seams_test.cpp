#include <gtest/gtest.h>

#include "garment/pattern/seam_measure.h"
#include "garment/pattern/seam_side.h"
#include "garment/pattern/sewn_sides.h"
#include "tests/garment/pattern/panels.h"

namespace toile::test {

using namespace garment;

namespace {

/// Front and back of a tube, 0.4 m wide, 0.2 m before and behind the axis. Seen from outside, both loops run
/// counter-clockwise.
Pattern tube()
{
    Pattern pattern;
    pattern.panels = {rectangle("front", 0.4, 0.6), rectangle("back", 0.4, 0.6)};
    pattern.panels[0].placement.translation() = Vec3(-0.2, 0.0, 0.2);
    pattern.panels[1].placement.linear() = Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitY()).toRotationMatrix();
    pattern.panels[1].placement.translation() = Vec3(0.2, 0.0, -0.2);
    pattern.seams = {seam(forward(0, 1), backward(1, 3)), seam(forward(0, 3), backward(1, 1))};
    return pattern;
}

TEST(SeamSide, WalksAChainByArcLength)
{
    Pattern pattern = tube();
    const SeamSide side(pattern, {forward(0, 0), {0, 1, 0.0, 0.5}});
    EXPECT_NEAR(side.length(), 0.7, 1e-12);
    EXPECT_LT((side.at(0.0) - Vec3(-0.2, 0.0, 0.2)).norm(), 1e-12);
    EXPECT_LT((side.at(4.0 / 7.0) - Vec3(0.2, 0.0, 0.2)).norm(), 1e-12);
    EXPECT_LT((side.at(1.0) - Vec3(0.2, 0.3, 0.2)).norm(), 1e-12);
    const SeamSide back(pattern, {{0, 1, 0.5, 0.0}});
    EXPECT_LT((back.at(0.0) - Vec3(0.2, 0.3, 0.2)).norm(), 1e-12);
    EXPECT_LT((back.at(1.0) - Vec3(0.2, 0.0, 0.2)).norm(), 1e-12);
}

TEST(SeamMeasure, TellsLengthsAndGaps)
{
    Pattern pattern = tube();
    pattern.panels[1] = rectangle("back", 0.4, 0.9);
    pattern.panels[1].placement.linear() = Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitY()).toRotationMatrix();
    pattern.panels[1].placement.translation() = Vec3(0.2, 0.0, -0.2);
    const SeamMeasure measure = measure_seam(pattern, pattern.seams[0]);
    EXPECT_NEAR(measure.length_a, 0.6, 1e-12);
    EXPECT_NEAR(measure.length_b, 0.9, 1e-12);
    EXPECT_NEAR(measure.ratio(), 1.5, 1e-12);
    EXPECT_GT(measure.gap, 0.4);
    EXPECT_GT(measure.other_gap, measure.gap);
    EXPECT_FALSE(measure.crossed);
    EXPECT_NEAR(measure_seam(tube(), tube().seams[1]).gap, 0.4, 1e-12);
}

TEST(SeamMeasure, TellsSwappedEnds)
{
    Pattern pattern = tube();
    pattern.seams[0] = seam(forward(0, 1), forward(1, 3));
    EXPECT_TRUE(measure_seam(pattern, pattern.seams[0]).crossed);
    // Sides at right angles tell nothing: front bottom to back side.
    pattern.seams[0] = seam(forward(0, 0), forward(1, 3));
    EXPECT_FALSE(measure_seam(pattern, pattern.seams[0]).crossed);
}

/// Before it is folded, a pleat's sides run away from each other.
TEST(SeamMeasure, CallsNoPleatCrossed)
{
    Pattern pattern;
    pattern.panels = {rectangle("front", 0.4, 0.6)};
    pattern.seams = {seam({0, 2, 0.5, 0.3}, {0, 2, 0.5, 0.7})};
    EXPECT_FALSE(measure_seam(pattern, pattern.seams[0]).crossed);
    pattern.seams = {seam({0, 2, 0.3, 0.5}, {0, 2, 0.7, 0.5})};
    EXPECT_FALSE(measure_seam(pattern, pattern.seams[0]).crossed);
    // Without a common point it is as it was.
    pattern.seams = {seam({0, 2, 0.45, 0.3}, {0, 2, 0.5, 0.7})};
    EXPECT_TRUE(measure_seam(pattern, pattern.seams[0]).crossed);
}

TEST(SewnSides, AreTwoForATubeAndOneForAMoebiusStrip)
{
    Pattern pattern = tube();
    EXPECT_TRUE(sewn_sides(pattern).one_sided.empty());
    pattern.seams[1] = seam(forward(0, 3), forward(1, 1));
    EXPECT_EQ(sewn_sides(pattern).one_sided, std::vector<int>{1});

    Pattern strip;
    strip.panels = {rectangle("strip", 0.6, 0.1)};
    strip.seams = {seam(forward(0, 1), backward(0, 3))};
    EXPECT_TRUE(sewn_sides(strip).one_sided.empty());
    strip.seams = {seam(forward(0, 1), forward(0, 3))};
    EXPECT_EQ(sewn_sides(strip).one_sided, std::vector<int>{0});
}

/// A lapel is sewn with its inner side out along all its edges, which leaves the garment two-sided.
TEST(SewnSides, TurnAPanelThatIsSewnTheSameWayAllAround)
{
    Pattern pattern = tube();
    pattern.panels.push_back(rectangle("lapel", 0.4, 0.6));
    pattern.seams.push_back(seam(forward(0, 0), forward(2, 0)));
    pattern.seams.push_back(seam(forward(1, 0), forward(2, 2)));
    const SewnSides sides = sewn_sides(pattern);
    EXPECT_TRUE(sides.one_sided.empty());
    EXPECT_EQ(sides.turned, (std::vector<bool>{false, false, true}));
    // With one of them swapped, the surface is one-sided.
    pattern.seams[3] = seam(forward(1, 0), backward(2, 2));
    EXPECT_EQ(sewn_sides(pattern).one_sided.size(), 1u);
}

} // namespace
} // namespace toile::test
