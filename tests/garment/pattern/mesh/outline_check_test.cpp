#include "garment/pattern/mesh/outline_check.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

std::string error_of(const Panel& panel)
{
    try {
        outline_curves(pattern_of(panel));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

TEST(OutlineCurves, AcceptsSimpleOutlines)
{
    EXPECT_EQ(error_of(rectangle("front", 0.3, 0.2)), "");
    EXPECT_EQ(error_of(disc("patch", 0.1)), "");
    EXPECT_EQ(error_of(half_ring("skirt", 0.1, 0.6)), "");
    EXPECT_EQ(error_of(mirrored(half_ring("skirt", 0.1, 0.6), "back")), "");
}

TEST(OutlineCurves, RefusesAPatternWithoutPanels)
{
    Pattern pattern;
    pattern.source = "empty.json";
    EXPECT_THROW(outline_curves(pattern), InvalidInput);
}

TEST(OutlineCurves, NamesAnOpenLoop)
{
    Panel panel = rectangle("front", 0.3, 0.2);
    panel.edges.pop_back();
    EXPECT_THAT(error_of(panel),
                AllOf(HasSubstr("test.json: panel \"front\" is open"), HasSubstr("edge 2 ends in corner 3"),
                      HasSubstr("edge 0 starts in corner 0")));
    panel.edges.clear();
    EXPECT_THAT(error_of(panel), HasSubstr("\"front\" has no edges"));
}

TEST(OutlineCurves, NamesACornerThatDoesNotExist)
{
    Panel panel = rectangle("front", 0.3, 0.2);
    panel.edges[1].end = 7;
    EXPECT_THAT(error_of(panel),
                HasSubstr("panel \"front\", edge 1: corner 7 does not exist; the panel has 4"));
    panel.edges[1].end = -1;
    EXPECT_THAT(error_of(panel), HasSubstr("corner -1 does not exist"));
}

TEST(OutlineCurves, NamesACornerOutOfRange)
{
    Panel panel = rectangle("front", 0.3, 0.2);
    panel.corners[2].x() = std::nan("");
    EXPECT_THAT(error_of(panel), HasSubstr("panel \"front\", corner 2: (nan"));
}

TEST(OutlineCurves, NamesBothEdgesThatCross)
{
    const Panel bow_tie = polygon("front", {{0.0, 0.0}, {0.2, 0.2}, {0.2, 0.0}, {0.0, 0.2}});
    EXPECT_THAT(error_of(bow_tie), HasSubstr("panel \"front\": edges 0 and 2 cross or touch each other"));

    // The left end of a square bulges through its right side.
    Panel bulge = rectangle("side", 0.1, 0.4);
    bulge.edges[3].curve = Bezier{{Vec2(0.4, 0.2)}};
    EXPECT_THAT(error_of(bulge), HasSubstr("edges 1 and 3 cross"));
}

TEST(OutlineCurves, NamesACornerThatTouchesAnotherEdge)
{
    const Panel panel = polygon("front", {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.2}, {0.2, 0.0}, {0.0, 0.2}});
    EXPECT_THAT(error_of(panel),
                AnyOf(HasSubstr("edges 0 and 2 cross or touch"), HasSubstr("edges 0 and 3 cross or touch")));
}

TEST(OutlineCurves, NamesAnEdgeThatCrossesItself)
{
    Panel panel = rectangle("front", 0.1, 0.4);
    panel.edges[0].curve = Bezier{{Vec2(0.5, -0.6), Vec2(-0.4, -0.6)}};
    EXPECT_THAT(error_of(panel), HasSubstr("edge 0 crosses or touches itself"));
}

TEST(OutlineCurves, NamesAnEdgeThatFoldsBack)
{
    const Panel spike = polygon("front", {{0.0, 0.0}, {0.4, 0.0}, {0.2, 0.0}, {0.2, 0.3}});
    EXPECT_THAT(error_of(spike),
                AnyOf(HasSubstr("edges 0 and 1 cross or touch"), HasSubstr("edges 0 and 2 cross or touch")));
    EXPECT_TRUE(find_crossing({{0.0, 0.0}, {0.4, 0.0}, {0.2, 0.0}}));
}

TEST(OutlineCurves, RefusesPanelsWithoutArea)
{
    EXPECT_THAT(error_of(polygon("strap", {{0.0, 0.0}, {0.2, 0.1}, {0.4, 0.2}})),
                HasSubstr("panel \"strap\" has no area"));
    EXPECT_THAT(error_of(polygon("strap", {{0.0, 0.0}, {0.2, 0.0}})), HasSubstr("\"strap\" has no area"));
}

TEST(OutlineCurves, NamesAnEdgeWithoutLength)
{
    const Panel panel = polygon("front", {{0.0, 0.0}, {0.2, 0.0}, {0.2, 0.0}, {0.0, 0.3}});
    EXPECT_THAT(error_of(panel), HasSubstr("panel \"front\", edge 1 has length 0.000000 m"));
}

TEST(OutlineCurves, NamesTheFileOfAnArcThatIsTooSmall)
{
    Panel panel = disc("patch", 0.1);
    panel.edges[1].curve = CircularArc{0.05, false, true};
    EXPECT_THAT(error_of(panel),
                AllOf(HasSubstr("test.json: panel \"patch\", edge 1"), HasSubstr("radius 0.05")));
}

TEST(FindCrossing, NamesTheSides)
{
    EXPECT_EQ(find_crossing({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}), std::nullopt);
    const auto crossing = find_crossing({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}});
    ASSERT_TRUE(crossing);
    EXPECT_EQ(*crossing, (std::array{0, 2}));
}

} // namespace

} // namespace toile::garment::test
