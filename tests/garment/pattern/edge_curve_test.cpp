#include "garment/pattern/edge_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/garment/pattern/panels.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kPi = std::numbers::pi;

/// Panel with one edge, from p to q.
Panel with_edge(const Vec2& p, const Vec2& q, std::variant<Bezier, CircularArc> curve)
{
    Panel panel;
    panel.name = "one";
    panel.corners = {p, q};
    panel.edges = {{0, 1, std::move(curve), {}}};
    return panel;
}

EdgeCurve curve_of(const Vec2& p, const Vec2& q, std::variant<Bezier, CircularArc> curve)
{
    return {with_edge(p, q, std::move(curve)), 0};
}

TEST(EdgeCurve, OfAStraightEdgeIsExact)
{
    const EdgeCurve curve = curve_of({1.0, 2.0}, {4.0, 6.0}, Bezier{});
    EXPECT_DOUBLE_EQ(curve.length(), 5.0);
    EXPECT_LT((curve.at(0.5) - Vec2(2.5, 4.0)).norm(), 1e-15);
    EXPECT_EQ(curve.at(0.0), Vec2(1.0, 2.0));
    EXPECT_EQ(curve.at(1.0), Vec2(4.0, 6.0));
}

/// y = x (1 - x) from 0 to 1 is the quadratic with control point (1/2, 1/2).
TEST(EdgeCurve, HasTheLengthOfAParabola)
{
    const EdgeCurve curve = curve_of({0.0, 0.0}, {1.0, 0.0}, Bezier{{{0.5, 0.5}}});
    const double length = std::sqrt(2.0) / 2.0 + std::asinh(1.0) / 2.0;
    EXPECT_NEAR(curve.length(), length, 2e-6 * length);
    EXPECT_LT((curve.at(0.5) - Vec2(0.5, 0.25)).norm(), 1e-6);
}

/// A cubic whose control points lie on its chord at thirds is the chord, walked evenly.
TEST(EdgeCurve, TakesCubics)
{
    const EdgeCurve straight = curve_of({0.0, 0.0}, {3.0, 0.0}, Bezier{{{1.0, 0.0}, {2.0, 0.0}}});
    EXPECT_NEAR(straight.length(), 3.0, 1e-12);
    const EdgeCurve bent = curve_of({0.0, 0.0}, {1.0, 0.0}, Bezier{{{0.0, 1.0}, {1.0, 1.0}}});
    EXPECT_LT((bent.at(0.5) - Vec2(0.5, 0.75)).norm(), 1e-6);
}

TEST(EdgeCurve, RunsByArcLengthNotByParameter)
{
    // Control point near the start: the parameter lingers there.
    const EdgeCurve curve = curve_of({0.0, 0.0}, {1.0, 0.0}, Bezier{{{0.05, 0.3}}});
    double walked = 0.0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
        const double step = (curve.at((i + 1.0) / kSteps) - curve.at(double(i) / kSteps)).norm();
        EXPECT_NEAR(step, curve.length() / kSteps, 0.02 * curve.length() / kSteps);
        walked += step;
    }
    EXPECT_NEAR(walked, curve.length(), 1e-4 * curve.length());
}

/// The four arcs of radius 1 through (0, 0) and (1, 1): quarters and three quarters about (0, 1) and (1, 0).
TEST(EdgeCurve, ChoosesOneOfFourArcs)
{
    struct Arc {
        bool large;
        bool counter_clockwise;
        double angle;
        Vec2 middle;
    };
    const double r = std::sqrt(0.5);
    const Arc arcs[] = {{false, true, kPi / 2.0, Vec2(0.0, 1.0) + Vec2(r, -r)},
                        {false, false, kPi / 2.0, Vec2(1.0, 0.0) + Vec2(-r, r)},
                        {true, true, 3.0 * kPi / 2.0, Vec2(1.0, 0.0) + Vec2(r, -r)},
                        {true, false, 3.0 * kPi / 2.0, Vec2(0.0, 1.0) + Vec2(-r, r)}};
    for (const Arc& arc : arcs) {
        const EdgeCurve curve =
            curve_of({0.0, 0.0}, {1.0, 1.0}, CircularArc{1.0, arc.large, arc.counter_clockwise});
        EXPECT_NEAR(curve.length(), arc.angle, 1e-5 * arc.angle);
        EXPECT_LT((curve.at(0.5) - arc.middle).norm(), 1e-5) << arc.large << arc.counter_clockwise;
        EXPECT_EQ(curve.at(1.0), Vec2(1.0, 1.0));
    }
}

TEST(EdgeCurve, RefusesAnArcThatDoesNotReachItsEnds)
{
    const std::string said = refusal([] { curve_of({0.0, 0.0}, {1.0, 0.0}, CircularArc{0.4, false, true}); });
    EXPECT_NE(said.find("panel \"one\", edge 0: an arc of radius 0.4"), std::string::npos) << said;
    // Half the distance itself, rounded in the file, is a half circle.
    EXPECT_NEAR(curve_of({0.0, 0.0}, {1.0, 0.0}, CircularArc{0.49999999, false, true}).length(), kPi / 2.0,
                1e-4);
}

TEST(SignedArea, IsThatOfADisc)
{
    Panel disc = with_edge({-0.5, 0.0}, {0.5, 0.0}, CircularArc{0.5, false, true});
    disc.edges.push_back({1, 0, CircularArc{0.5, false, true}, {}});
    EXPECT_NEAR(signed_area(disc), kPi / 4.0, 1e-5);
    for (PanelEdge& edge : disc.edges) {
        std::swap(edge.start, edge.end);
        std::get<CircularArc>(edge.curve).counter_clockwise = false;
    }
    EXPECT_NEAR(signed_area(disc), -kPi / 4.0, 1e-5);
}

TEST(SignedArea, OfPolygonsIsExact)
{
    EXPECT_DOUBLE_EQ(signed_area(rectangle("r", 0.3, 0.5)), 0.15);
    EXPECT_DOUBLE_EQ(signed_area(polygon("t", {{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}})), -0.5);
}

} // namespace
} // namespace toile::test
