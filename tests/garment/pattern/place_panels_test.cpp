#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/place/girth_curve.h"
#include "garment/pattern/place/place_panels.h"
#include "garment/pattern/place/placement_shift.h"
#include "tests/garment/pattern/panels.h"

namespace toile::test {

using namespace garment;

namespace {

/// Elliptic cylinder of skin: half width `side` to the left, half depth `front` [m].
AxisSegment elliptic_limb(const Vec3& start, const Vec3& end, const Vec3& front, double half_depth,
                          double half_width)
{
    AxisSegment limb{start, end, front.normalized(), {}};
    for (int i = 0; i <= 60; ++i)
        for (int k = 0; k < 72; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / 72;
            limb.skin.push_back(start + i / 60.0 * (end - start) + half_depth * std::cos(angle) * limb.front +
                                half_width * std::sin(angle) * limb.left());
        }
    return limb;
}

/// A body that faces +Z: an upright trunk of 0.3 x 0.2 m, and arms of 8 cm in T-pose.
ArrangementSegments body()
{
    ArrangementSegments segments;
    segments[size_t(BodySegment::Torso)] = elliptic_limb({0, 0.8, 0}, {0, 1.4, 0}, Vec3::UnitZ(), 0.1, 0.15);
    segments[size_t(BodySegment::Neck)] = elliptic_limb({0, 1.4, 0}, {0, 1.5, 0}, Vec3::UnitZ(), 0.06, 0.06);
    segments[size_t(BodySegment::LeftArm)] =
        elliptic_limb({0.7, 1.35, 0}, {0.2, 1.35, 0}, Vec3::UnitZ(), 0.04, 0.04);
    segments[size_t(BodySegment::RightArm)] =
        elliptic_limb({-0.7, 1.35, 0}, {-0.2, 1.35, 0}, Vec3::UnitZ(), 0.04, 0.04);
    segments[size_t(BodySegment::LeftLeg)] =
        elliptic_limb({0.1, 0, 0}, {0.1, 0.8, 0}, Vec3::UnitZ(), 0.06, 0.06);
    segments[size_t(BodySegment::RightLeg)] =
        elliptic_limb({-0.1, 0, 0}, {-0.1, 0.8, 0}, Vec3::UnitZ(), 0.06, 0.06);
    return segments;
}

/// A rectangle of w x h with its lower left corner at the origin, as a grid of points 1 cm apart.
struct Sheet {
    Pattern pattern;
    std::vector<Vec2> uv;
    std::vector<int> panel;
    std::vector<std::array<int, 2>> edges; ///< of the grid, with diagonals
    int columns = 0, rows = 0;

    Sheet(double w, double h, const std::optional<BodyPlacement>& place, bool clockwise = false)
    {
        Panel sheet = rectangle("sheet", w, h);
        if (clockwise) {
            std::reverse(sheet.edges.begin(), sheet.edges.end());
            for (PanelEdge& edge : sheet.edges)
                std::swap(edge.start, edge.end);
        }
        sheet.place = place;
        pattern.source = "sheet.json";
        pattern.panels.push_back(sheet);
        columns = int(std::lround(w / 0.01)) + 1;
        rows = int(std::lround(h / 0.01)) + 1;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                uv.emplace_back(w * i / (columns - 1), h * j / (rows - 1));
                panel.push_back(0);
                for (const auto& [di, dj] : {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
                    if (i + di < columns && j + dj < rows)
                        edges.push_back({j * columns + i, (j + dj) * columns + i + di});
            }
    }

    std::vector<Vec3> placed(const ArrangementSegments& segments) const
    {
        return place_panels(pattern, uv, panel, &segments);
    }
    int middle() const { return (rows / 2) * columns + columns / 2; }

    /// Normal of the loop, counter-clockwise as it runs, at the middle.
    Vec3 normal(const std::vector<Vec3>& x) const
    {
        const int v = middle();
        const Vec3 n =
            (x[size_t(v + 1)] - x[size_t(v)]).cross(x[size_t(v + columns)] - x[size_t(v)]).normalized();
        return signed_area(pattern.panels[0]) < 0.0 ? Vec3(-n) : n;
    }
    double largest_stretch(const std::vector<Vec3>& x) const
    {
        double most = 0.0;
        for (const auto& [a, b] : edges) {
            const double rest = (uv[size_t(b)] - uv[size_t(a)]).norm();
            most = std::max(most, std::abs((x[size_t(b)] - x[size_t(a)]).norm() / rest - 1.0));
        }
        return most;
    }
};

double distance(const std::vector<Vec3>& skin, const Vec3& x)
{
    double nearest = 1e300;
    for (const Vec3& p : skin)
        nearest = std::min(nearest, (p - x).norm());
    return nearest;
}

} // namespace

TEST(PlacePanels, BentPanelsKeepTheirLengthsSidesAndDistance)
{
    const ArrangementSegments segments = body();
    for (const bool clockwise : {false, true})
        for (const double angle : {0.0, 90.0, 180.0, -90.0, 37.0}) {
            const Sheet sheet(0.4, 0.3, BodyPlacement{BodySegment::Torso, angle, 0.5, 0.03, true}, clockwise);
            const std::vector<Vec3> x = sheet.placed(segments);
            EXPECT_LT(sheet.largest_stretch(x), 0.01);

            const Vec3 outwards(std::sin(angle * std::numbers::pi / 180.0), 0.0,
                                std::cos(angle * std::numbers::pi / 180.0));
            const Vec3 middle = x[size_t(sheet.middle())];
            EXPECT_NEAR(middle.y(), 1.1, 0.01);
            EXPECT_LT((Vec3(middle.x(), 0.0, middle.z()).normalized() - outwards).norm(), 0.06) << angle;
            EXPECT_GT(sheet.normal(x).dot(outwards), 0.8)
                << "outer side of a " << (clockwise ? "clockwise" : "usual") << " loop at " << angle;
            for (const Vec3& p : x) {
                EXPECT_GT(distance(segments[0].skin, p), 0.0295);
                EXPECT_LT(distance(segments[0].skin, p), 0.036);
            }
            EXPECT_GT(x.back().y(), x.front().y()) << "upright";
        }
}

TEST(PlacePanels, SleeveSurroundsAnArmInTPose)
{
    const ArrangementSegments segments = body();
    // 0.42 m around an arm whose curve at 3 cm is 0.44 m long: nearly closed, open below a left arm.
    const Sheet sleeve(0.42, 0.3, BodyPlacement{BodySegment::LeftArm, 90.0, 0.5, 0.03, true});
    const std::vector<Vec3> x = sleeve.placed(segments);
    EXPECT_LT(sleeve.largest_stretch(x), 0.01);
    EXPECT_GT(sleeve.normal(x).y(), 0.99) << "above the arm";
    EXPECT_GT(x[size_t(sleeve.middle())].y(), 1.35 + 0.069);
    double left = -1e300, right = 1e300, below = 1e300;
    for (const Vec3& p : x) {
        EXPECT_NEAR(Vec2(p.y() - 1.35, p.z()).norm(), 0.07, 0.001);
        left = std::max(left, p.x());
        right = std::min(right, p.x());
        below = std::min(below, p.y());
    }
    EXPECT_NEAR(left, 0.6, 1e-9);
    EXPECT_NEAR(right, 0.3, 1e-9);
    EXPECT_LT(below, 1.35 - 0.06);
    // Its y axis points to the shoulder.
    EXPECT_LT(x.back().x(), x.front().x());
}

TEST(PlacePanels, CylinderGrowsRatherThanLettingClothReachAroundItself)
{
    const ArrangementSegments segments = body();
    const Sheet wide(0.8, 0.2, BodyPlacement{BodySegment::LeftArm, 0.0, 0.5, 0.03, true});
    const std::vector<Vec3> x = wide.placed(segments);
    EXPECT_LT(wide.largest_stretch(x), 0.01);
    EXPECT_GT((x[0] - x[size_t(wide.columns - 1)]).norm(), 0.01) << "its ends stay apart";
    for (const Vec3& p : x)
        EXPECT_GT(distance(segments[2].skin, p), 0.07);
}

TEST(PlacePanels, CylinderGrowsUntilPanelsLieSideBySide)
{
    const ArrangementSegments segments = body();
    // Each fits around the arm, whose curve is 0.44 m long; both do not.
    const Sheet front(0.3, 0.2, BodyPlacement{BodySegment::LeftArm, 0.0, 0.5, 0.03, true});
    Pattern pattern = front.pattern;
    pattern.panels.push_back(pattern.panels[0]);
    pattern.panels[1].place->angle_deg = 180.0;
    std::vector<Vec2> uv = front.uv;
    uv.insert(uv.end(), front.uv.begin(), front.uv.end());
    std::vector<int> panel(front.uv.size(), 0);
    panel.resize(uv.size(), 1);
    const auto clearance = [&] {
        const std::vector<Vec3> x = place_panels(pattern, uv, panel, &segments);
        double nearest = 1e300;
        for (size_t v = 0; v < front.uv.size(); v += 7)
            for (size_t w = front.uv.size(); w < x.size(); ++w)
                nearest = std::min(nearest, (x[v] - x[w]).norm());
        for (size_t v = 0; v < x.size(); ++v)
            EXPECT_EQ(x[v].z() > 0.0, panel[v] == 0) << "front before, back behind the arm";
        return nearest;
    };
    EXPECT_GT(clearance(), 0.003);
}

TEST(PlacePanels, FlatPanelsTouchTheCylinder)
{
    const ArrangementSegments segments = body();
    const Sheet flat(0.4, 0.3, BodyPlacement{BodySegment::Torso, 180.0, 0.25, 0.05, false});
    const std::vector<Vec3> x = flat.placed(segments);
    for (const Vec3& p : x)
        EXPECT_NEAR(p.z(), -0.15, 1e-3);
    EXPECT_NEAR(x[size_t(flat.middle())].y(), 0.95, 1e-9);
    EXPECT_NEAR(flat.normal(x).z(), -1.0, 1e-9);
    EXPECT_LT(flat.largest_stretch(x), 1e-12);
}

TEST(PlacePanels, PanelsWithoutPlaceLieWhereThePatternPutsThem)
{
    Sheet sheet(0.2, 0.1, std::nullopt);
    sheet.pattern.panels[0].placement =
        Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY());
    const std::vector<Vec3> x = place_panels(sheet.pattern, sheet.uv, sheet.panel, nullptr);
    EXPECT_LT((x.front() - Vec3(1, 2, 3)).norm(), 1e-12);
    EXPECT_LT((x.back() - Vec3(1, 2.1, 2.8)).norm(), 1e-12);
}

TEST(PlacePanels, StartFurtherOutsideByTheirLayer)
{
    const ArrangementSegments segments = body();
    // Three copies: two flat ones, of which one has its outer side behind, and one around the body.
    Sheet sheet(0.2, 0.1, std::nullopt), back(0.2, 0.1, std::nullopt, true);
    Panel around = sheet.pattern.panels[0];
    around.place = BodyPlacement{};
    sheet.pattern.panels.push_back(back.pattern.panels[0]);
    sheet.pattern.panels.push_back(around);
    const auto placed = [&](std::array<int, 3> layers) {
        std::vector<Vec2> uv;
        std::vector<int> panel;
        for (int p = 0; p < 3; ++p) {
            sheet.pattern.panels[size_t(p)].layer = layers[size_t(p)];
            uv.insert(uv.end(), sheet.uv.begin(), sheet.uv.end());
            panel.insert(panel.end(), sheet.uv.size(), p);
        }
        return place_panels(sheet.pattern, uv, panel, &segments);
    };
    const size_t n = sheet.uv.size();
    const std::vector<Vec3> without = placed({0, 0, 0}), same = placed({3, 3, 3}),
                            layered = placed({2, 4, 3});
    EXPECT_EQ(without, same) << "layers are relative";
    for (size_t v = 0; v < n; ++v) {
        EXPECT_EQ(layered[v], without[v]) << "the lowest stays";
        EXPECT_LT((layered[n + v] - without[n + v] - Vec3(0, 0, -0.02)).norm(), 1e-12);
        EXPECT_NEAR(distance(segments[0].skin, layered[2 * n + v]) -
                        distance(segments[0].skin, without[2 * n + v]),
                    0.01, 1e-3);
    }
}

TEST(PlacePanels, LyingSleeveKeepsItsLengthAlongTheArm)
{
    const ArrangementSegments segments = body();
    Sheet lying(0.4, 0.2, BodyPlacement{BodySegment::RightArm, 0.0, 0.5, 0.03, true});
    // Its file lays the panel before the right arm in T-pose: x along the arm, to the shoulder.
    lying.pattern.panels[0].placement = Eigen::Isometry3d(Eigen::Translation3d(-0.6, 1.25, 0.2));
    const std::vector<Vec3> x = lying.placed(segments);
    EXPECT_NEAR(x[size_t(lying.columns - 1)].x() - x[0].x(), 0.4, 1e-9);
    EXPECT_GT(lying.normal(x).z(), 0.99);
    EXPECT_LT(lying.largest_stretch(x), 0.01);
}

TEST(PlacePanels, PlaceWithoutABodyIsRefused)
{
    const Sheet sheet(0.2, 0.1, BodyPlacement{});
    try {
        place_panels(sheet.pattern, sheet.uv, sheet.panel, nullptr);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "sheet.json: panel sheet is placed around a body, and there is none; name an avatar, or "
                     "remove its place");
    }
}

TEST(PlacePanels, SegmentWithoutSkinHasACircle)
{
    AxisSegment bare{Vec3::Zero(), Vec3(0, 1, 0), Vec3::UnitZ(), {}};
    const GirthCurve curve(bare, 0.2, 0.4, 0.05, 0.0);
    EXPECT_NEAR(curve.length(), 2.0 * std::numbers::pi * 0.05, 1e-3);
    EXPECT_LT((curve.at(curve.arc_at(90.0)) - Vec2(0.0, 0.05)).norm(), 1e-4);
    EXPECT_LT((curve.at(-0.01) - curve.at(curve.length() - 0.01)).norm(), 1e-12) << "closed";
}

TEST(PlacementShift, NamesTheShiftToTheBody)
{
    const ArrangementSegments segments = body();
    Sheet sheet(0.3, 0.5, std::nullopt);
    const auto at = [&](const Vec3& x) {
        sheet.pattern.panels[0].placement =
            Eigen::Isometry3d(Eigen::Translation3d(x + Vec3(-0.15, 0.85, 0.2)));
        return placement_shift(sheet.pattern, segments);
    };
    EXPECT_TRUE(at(Vec3::Zero()).fits());
    EXPECT_GT(at(Vec3::Zero()).covering, 0.9);
    // The chest of this body is at 0.8 + 0.55 * 0.6.
    const PlacementShift chest = at({0.0, -1.13, 0.0});
    EXPECT_FALSE(chest.fits());
    EXPECT_LT((chest.shift - Vec3(0.0, 1.13, 0.0)).norm(), 1e-9);
    EXPECT_EQ(
        misplacement_text(sheet.pattern, chest),
        "sheet.json: its panels are not placed around the body: 46 % of them have skin behind them, 100 "
        "% after "
        "--shift 0,1.13,0; was the pattern drafted for another origin?");
    const PlacementShift aside = at({3.0, 0.0, 0.0});
    EXPECT_FALSE(aside.fits());
    EXPECT_NEAR(aside.shift.x(), -3.0, 0.03);
    // No origin in use is as far above.
    const PlacementShift nowhere = at({0.0, 40.0, 0.0});
    EXPECT_FALSE(nowhere.fits());
    EXPECT_NE(misplacement_text(sheet.pattern, nowhere).find("name the body that they were drafted for"),
              std::string::npos);
    sheet.pattern.panels[0].place = BodyPlacement{};
    EXPECT_TRUE(at({0.0, 40.0, 0.0}).fits()) << "it is placed by the body";
}

} // namespace toile::test
