#include "garment/pattern/mesh/outline_points.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleEq;
using testing::DoubleNear;
using testing::HasSubstr;

OutlinePoints divide(const Pattern& pattern, const std::vector<double>& edges)
{
    OutlineTargets targets{edges, {}, {}};
    for (const Panel& panel : pattern.panels) {
        targets.free_intervals.emplace_back(panel.edges.size(), 1);
        targets.marks.emplace_back(panel.edges.size());
    }
    return divide_outlines(pattern, outline_curves(pattern), targets);
}

OutlinePoints divide(const Pattern& pattern, double edge)
{
    return divide(pattern, std::vector<double>(pattern.panels.size(), edge));
}

std::string error_of(const Pattern& pattern)
{
    try {
        divide(pattern, 0.01);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

Pattern two_rectangles(double width_a, double width_b)
{
    Pattern pattern = pattern_of(rectangle("front", width_a, 0.3));
    pattern.panels.push_back(rectangle("back", width_b, 0.2));
    return pattern;
}

double fraction(const OutlinePoints& points, const OutlinePoint& at)
{
    return points.fractions[at.panel][at.edge][at.point];
}

TEST(DivideOutlines, PutsAsManyIntervalsOnAnEdgeAsTheTargetNeeds)
{
    const OutlinePoints points = divide(pattern_of(rectangle("front", 0.3, 0.201)), 0.01);
    EXPECT_EQ(points.fractions[0][0].size(), 31u) << "a multiple of the target is not divided once more";
    ASSERT_EQ(points.fractions[0][1].size(), 22u);
    EXPECT_EQ(points.fractions[0][1].front(), 0.0);
    EXPECT_EQ(points.fractions[0][1].back(), 1.0);
    EXPECT_DOUBLE_EQ(points.fractions[0][1][7], 7.0 / 21.0);
    EXPECT_EQ(divide(pattern_of(rectangle("front", 0.3, 0.2)), 5.0).fractions[0][0].size(), 2u);
}

TEST(DivideOutlines, TakesTheCountOfASeamFromTheLongerSide)
{
    Pattern pattern = two_rectangles(0.5, 0.318);
    pattern.seams = {seam("waist", 0, 0, 1, 2)};
    const OutlinePoints points = divide(pattern, 0.01);
    ASSERT_EQ(points.fractions[0][0].size(), 51u);
    ASSERT_EQ(points.fractions[1][2].size(), 51u);
    ASSERT_EQ(points.seams[0].size(), 51u);
    for (int i = 0; i <= 50; ++i) {
        const auto& [a, b] = points.seams[0][i];
        EXPECT_EQ(a, (OutlinePoint{0, 0, i}));
        EXPECT_EQ(b, (OutlinePoint{1, 2, 50 - i})) << "the edges run against each other";
    }
}

TEST(DivideOutlines, TakesTheCountOfASeamFromTheFinerPanel)
{
    Pattern pattern = two_rectangles(0.5, 0.5);
    pattern.seams = {seam("waist", 0, 0, 1, 2)};
    const OutlinePoints points = divide(pattern, std::vector{0.02, 0.005});
    EXPECT_EQ(points.fractions[0][0].size(), 101u);
    EXPECT_EQ(points.fractions[1][2].size(), 101u);
    EXPECT_EQ(points.fractions[0][1].size(), 16u) << "the other edges keep their panel's target";
}

TEST(DivideOutlines, MakesCornersOfOneSidePointsOfTheOther)
{
    // A T-seam: one edge of 0.8 m against two of 0.3 m and 0.5 m of different panels.
    Pattern pattern = two_rectangles(0.3, 0.5);
    pattern.panels.push_back(rectangle("yoke", 0.8, 0.1));
    pattern.seams = {{{{2, 0, 0.0, 1.0}}, {{0, 2, 1.0, 0.0}, {1, 2, 1.0, 0.0}}, "yoke seam", {}}};
    const OutlinePoints points = divide(pattern, 0.019);
    EXPECT_THAT(points.fractions[2][0], Contains(DoubleNear(0.375, 1e-12)));
    EXPECT_EQ(points.fractions[0][2].size() - 1, 16u);
    EXPECT_EQ(points.fractions[1][2].size() - 1, 27u);
    EXPECT_EQ(points.fractions[2][0].size() - 1, 16u + 27u);
    // Where the chain changes panels, one point of the yoke meets two.
    ASSERT_EQ(points.seams[0].size(), 16u + 27u + 2u);
    EXPECT_EQ(points.seams[0][16][0], points.seams[0][17][0]);
    EXPECT_EQ(points.seams[0][16][1].panel, 0);
    EXPECT_EQ(points.seams[0][17][1].panel, 1);
}

TEST(DivideOutlines, PairsPointsByArcLengthThroughChainsAndFractions)
{
    Pattern pattern = two_rectangles(0.6, 0.5);
    // a: part of the bottom, then the right side; b: left side, downwards, then part of the bottom.
    pattern.seams = {
        {{{0, 0, 0.25, 1.0}, {0, 1, 0.0, 1.0}}, {{1, 3, 0.0, 1.0}, {1, 0, 0.0, 0.7}}, "spiral", {}}};
    const OutlinePoints points = divide(pattern, 0.013);
    const auto along = [&](const OutlinePoint& at, bool is_a) {
        const double f = fraction(points, at);
        if (is_a)
            return (at.edge == 0 ? (f - 0.25) * 0.6 : 0.45 + f * 0.3) / 0.75;
        return (at.edge == 3 ? f * 0.2 : 0.2 + f * 0.5) / 0.55;
    };
    double previous = -1.0;
    for (const auto& [a, b] : points.seams[0]) {
        EXPECT_NEAR(along(a, true), along(b, false), 1e-12);
        EXPECT_GE(along(a, true), previous);
        previous = along(a, true);
    }
    EXPECT_NEAR(previous, 1.0, 1e-12);
    EXPECT_THAT(points.fractions[0][0], Contains(DoubleEq(0.25)));
    EXPECT_THAT(points.fractions[1][0], Contains(DoubleEq(0.7)));
}

TEST(DivideOutlines, LetsCornersMeetThatAreNearEachOther)
{
    // Junctions at 0.400 and 0.402 of the seam: they meet, no sliver of 2 mm is left.
    Pattern pattern = two_rectangles(0.40, 0.402);
    pattern.panels.push_back(rectangle("c", 0.60, 0.1));
    pattern.panels.push_back(rectangle("d", 0.598, 0.1));
    pattern.seams = {
        {{{0, 0, 0.0, 1.0}, {2, 0, 0.0, 1.0}}, {{1, 2, 1.0, 0.0}, {3, 2, 1.0, 0.0}}, "side", {}}};
    const OutlinePoints points = divide(pattern, 0.02);
    EXPECT_EQ(points.fractions[0][0].size(), 22u);
    EXPECT_EQ(points.fractions[1][2].size(), 22u);
    EXPECT_EQ(points.fractions[2][0].size(), points.fractions[3][2].size());

    // At 0.40 and 0.42 they do not.
    pattern.panels[1] = rectangle("back", 0.42, 0.2);
    pattern.panels[3] = rectangle("d", 0.58, 0.1);
    const OutlinePoints apart = divide(pattern, 0.02);
    EXPECT_THAT(apart.fractions[1][2], Contains(DoubleNear(1.0 - 0.40 / 0.42, 1e-12)));
    EXPECT_THAT(apart.fractions[2][0], Contains(DoubleNear(0.02 / 0.60, 1e-12)));
}

TEST(DivideOutlines, DoesNotLetThePairingDependOnTheTarget)
{
    Pattern pattern = two_rectangles(0.40, 0.402);
    pattern.panels.push_back(rectangle("c", 0.60, 0.1));
    pattern.panels.push_back(rectangle("d", 0.598, 0.1));
    pattern.seams = {
        {{{0, 0, 0.0, 1.0}, {2, 0, 0.0, 1.0}}, {{1, 2, 1.0, 0.0}, {3, 2, 1.0, 0.0}}, "side", {}}};
    for (const double target : {0.03, 0.01, 0.001}) {
        const OutlinePoints points = divide(pattern, target);
        for (const auto& [a, b] : points.seams[0])
            EXPECT_NEAR(fraction(points, a), 1.0 - fraction(points, b), 1e-12);
    }
}

TEST(DivideOutlines, SewsAnEdgeToItself)
{
    Pattern pattern = pattern_of(rectangle("pouch", 0.4, 0.2));
    pattern.seams = {{{{0, 0, 0.0, 0.5}}, {{0, 0, 1.0, 0.5}}, "fold", {}}};
    const OutlinePoints points = divide(pattern, 0.05);
    ASSERT_EQ(points.seams[0].size(), 5u);
    EXPECT_EQ(points.seams[0].back()[0], points.seams[0].back()[1]) << "the middle meets itself";
}

TEST(DivideOutlines, RefusesPartsThatOverlap)
{
    Pattern pattern = two_rectangles(0.5, 0.5);
    pattern.seams = {{{{0, 0, 0.0, 0.6}}, {{1, 0, 0.0, 1.0}}, "left", {}},
                     {{{0, 0, 0.5, 1.0}}, {{1, 2, 0.0, 1.0}}, "right", {}}};
    EXPECT_THAT(error_of(pattern), AllOf(HasSubstr("test.json: panel \"front\", edge 0 is sewn twice"),
                                         HasSubstr("\"left\""), HasSubstr("\"right\""), HasSubstr("0.5")));
    pattern.seams[1].a[0].from = 0.6;
    EXPECT_EQ(error_of(pattern), "");
}

TEST(DivideOutlines, TakesFractionsOfThreeDigitsAsOnePoint)
{
    Pattern pattern = two_rectangles(0.5, 0.5);
    for (const double end : {0.3333, 0.333, 0.334}) {
        pattern.seams = {{{{0, 0, 0.0, end}}, {{1, 0, 0.0, 1.0}}, "left", {}},
                         {{{0, 0, 1.0 / 3.0, 1.0}}, {{1, 2, 0.0, 1.0}}, "right", {}}};
        const OutlinePoints points = divide(pattern, 0.01);
        EXPECT_EQ(points.seams[0].back()[0], points.seams[1].front()[0]) << end;
    }
}

TEST(DivideOutlines, RefusesPartsThatDoNotExist)
{
    Pattern pattern = two_rectangles(0.5, 0.5);
    pattern.seams = {{{{0, 9, 0.0, 1.0}}, {{1, 0, 0.0, 1.0}}, "left", {}}};
    EXPECT_THAT(error_of(pattern), HasSubstr("seam \"left\": panel \"front\" has no edge 9; it has 4"));
    pattern.seams[0].a[0] = {5, 0, 0.0, 1.0};
    EXPECT_THAT(error_of(pattern), HasSubstr("panel 5 does not exist; the pattern has 2"));
    pattern.seams[0].a[0] = {0, 0, 0.2, 1.2};
    EXPECT_THAT(error_of(pattern), HasSubstr("edge 0 from 0.200000 to 1.200000"));
    pattern.seams[0].a[0] = {0, 0, 0.2, 0.2};
    EXPECT_THAT(error_of(pattern), HasSubstr("edge 0 from 0.200000 to 0.200000"));
    pattern.seams[0].a[0] = {0, 0, std::nan(""), 0.2};
    EXPECT_THAT(error_of(pattern), HasSubstr("from nan"));
    pattern.seams[0].a.clear();
    EXPECT_THAT(error_of(pattern), HasSubstr("seam \"left\" has no edge on one side"));
}

} // namespace

} // namespace toile::garment::test
