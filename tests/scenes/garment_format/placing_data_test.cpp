#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "avatars/landmarks/body_segments.h"
#include "avatars/load_avatar.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/place/placement_shift.h"
#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/garment_format/pattern_files.h"

/// Patterns of the data folder around its bodies.
namespace toile::test {

using namespace garment;

namespace {

ArrangementSegments segments_of(const std::string& name, const Vec3& moved = Vec3::Zero())
{
    avatars::AvatarSettings settings;
    settings.file = std::filesystem::path(TOILE_DATA_DIR) / name;
    avatars::Affine world = avatars::identity_affine();
    world.col(3) = moved;
    return avatars::find_segments(*avatars::load_avatar(settings), {}, world).segments;
}

/// Points along the edges of a panel, 1 cm apart or less.
std::vector<Vec2> border_of(const Panel& panel)
{
    std::vector<Vec2> points;
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const EdgeCurve curve(panel, int(e));
        const int parts = std::max(1, int(std::ceil(curve.length() / 0.01)));
        for (int k = 0; k < parts; ++k)
            points.push_back(curve.at(double(k) / parts));
    }
    return points;
}

/// Pieces of patterns of one kind, with their places.
Pattern with_places(const std::string& file, BodySegment at, double height,
                    const std::map<std::string, double>& angle)
{
    Pattern pattern = garment_format::read_pattern(pattern_file(file));
    std::erase_if(pattern.panels, [&](const Panel& panel) { return !angle.contains(panel.name); });
    for (Panel& panel : pattern.panels)
        panel.place = BodyPlacement{at, angle.at(panel.name), height, 0.03, true};
    pattern.seams.clear();
    return pattern;
}

struct Placed {
    std::vector<Vec2> uv;
    std::vector<int> panel;
    std::vector<Vec3> x;
};

Placed place(const Pattern& pattern, const ArrangementSegments& body)
{
    Placed placed;
    for (size_t p = 0; p < pattern.panels.size(); ++p)
        for (const Vec2& x : border_of(pattern.panels[p])) {
            placed.uv.push_back(x);
            placed.panel.push_back(int(p));
        }
    placed.x = place_panels(pattern, placed.uv, placed.panel, &body);
    return placed;
}

/// Angle of a point about the axis of a segment [degrees].
double angle_about(const AxisSegment& segment, const Vec3& x)
{
    const Vec3 r = x - segment.start;
    return std::atan2(segment.left().dot(r), segment.front.dot(r)) * 180.0 / std::numbers::pi;
}

bool data_is_missing() { return !std::filesystem::is_directory(TOILE_DATA_DIR); }

} // namespace

TEST(PlacingData, SleevesSurroundArmsInAAndTPose)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    for (const char* name :
         {"bodies/gc_mean_all.obj", "avatars/gc_mean_all.glb", "bodies/smpl_f_template.obj"}) {
        const ArrangementSegments body = segments_of(name);
        for (const BodySegment at : {BodySegment::LeftArm, BodySegment::RightArm}) {
            const std::string side = at == BodySegment::LeftArm ? "left" : "right";
            const Pattern pattern =
                with_places("garmentcode/long_sleeve_turtle_mean_all_specification.json", at, 0.5,
                            {{side + "_sleeve_f", 0.0}, {side + "_sleeve_b", 180.0}});
            ASSERT_EQ(pattern.panels.size(), 2u);
            const Placed placed = place(pattern, body);
            const AxisSegment& arm = body[size_t(at)];

            double nearest = 1e300, along_low = 1e300, along_high = -1e300;
            std::vector<bool> quarter(4, false);
            for (size_t v = 0; v < placed.x.size(); ++v) {
                quarter[size_t((angle_about(arm, placed.x[v]) + 180.0) / 90.0001)] = true;
                along_low = std::min(along_low, arm.axis().dot(placed.x[v] - arm.start));
                along_high = std::max(along_high, arm.axis().dot(placed.x[v] - arm.start));
                for (const Vec3& skin : arm.skin)
                    nearest = std::min(nearest, (placed.x[v] - skin).norm());
            }
            for (const bool there : quarter)
                EXPECT_TRUE(there) << name << ": the sleeve leaves a quarter of the arm bare";
            EXPECT_GT(nearest, 0.029) << name;
            // It is drafted lying, 44 cm long: along the arm, not around it.
            EXPECT_NEAR(along_high - along_low, 0.44, 0.01) << name;

            for (size_t v = 1; v < placed.x.size(); ++v)
                if (placed.panel[v] == placed.panel[v - 1]) {
                    const double rest = (placed.uv[v] - placed.uv[v - 1]).norm();
                    EXPECT_NEAR((placed.x[v] - placed.x[v - 1]).norm(), rest, 0.01 * rest + 1e-9) << name;
                }
            // Front panel before, back panel behind, in the mean over their borders.
            std::array<Vec3, 2> sum{Vec3::Zero(), Vec3::Zero()};
            for (size_t v = 0; v < placed.x.size(); ++v)
                sum[size_t(placed.panel[v])] += placed.x[v] - arm.start;
            for (size_t p = 0; p < 2; ++p)
                EXPECT_GT((pattern.panels[p].name.ends_with("_f") ? 1.0 : -1.0) * arm.front.dot(sum[p]), 0.0);
        }
    }
}

TEST(PlacingData, LegsBandsAndCollarsSurroundTheirSegments)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    struct Case {
        const char* file;
        BodySegment at;
        double height;
        std::map<std::string, double> angle;
    };
    const std::string pants = "garmentcode/pants_mean_all_specification.json";
    const std::string turtle = "garmentcode/long_sleeve_turtle_mean_all_specification.json";
    const std::vector<Case> cases{
        {pants.c_str(), BodySegment::RightLeg, 0.5, {{"pant_f_r", 0.0}, {"pant_b_r", 180.0}}},
        {pants.c_str(), BodySegment::LeftLeg, 0.5, {{"pant_f_l", 0.0}, {"pant_b_l", 180.0}}},
        {pants.c_str(), BodySegment::Torso, 0.45, {{"wb_front", 0.0}, {"wb_back", 180.0}}},
        {turtle.c_str(),
         BodySegment::Neck,
         0.4,
         {{"left_collar_front", 65.0},
          {"right_collar_front", -65.0},
          {"left_collar_back", 155.0},
          {"right_collar_back", -155.0}}}};
    for (const char* name : {"avatars/gc_mean_all.glb", "bodies/gc_mean_all.obj",
                             "bodies/smpl_f_template.obj", "avatars/mh_man.glb"}) {
        const ArrangementSegments body = segments_of(name);
        for (const Case& piece : cases) {
            const Pattern pattern = with_places(piece.file, piece.at, piece.height, piece.angle);
            ASSERT_EQ(pattern.panels.size(), piece.angle.size());
            const Placed placed = place(pattern, body);
            const AxisSegment& segment = body[size_t(piece.at)];
            std::vector<bool> quarter(4, false);
            for (size_t v = 0; v < placed.x.size(); ++v) {
                quarter[size_t((angle_about(segment, placed.x[v]) + 180.0) / 90.0001)] = true;
                for (const Vec3& skin : segment.skin)
                    ASSERT_GT((placed.x[v] - skin).norm(), 0.025)
                        << name << ", " << pattern.panels[size_t(placed.panel[v])].name;
                if (v == 0 || placed.panel[v] != placed.panel[v - 1])
                    continue;
                const double rest = (placed.uv[v] - placed.uv[v - 1]).norm();
                EXPECT_NEAR((placed.x[v] - placed.x[v - 1]).norm(), rest, 0.01 * rest + 1e-9) << name;
            }
            for (const bool there : quarter)
                EXPECT_TRUE(there) << name << ", " << pattern.panels[0].name;
        }
    }
}

TEST(PlacingData, PatternsFitTheBodyThatTheyWereDraftedForAndNoOther)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const ArrangementSegments floor = segments_of("bodies/gc_mean_all.obj");
    const ArrangementSegments chest = segments_of("bodies/smpl_f_template.obj");
    const ArrangementSegments raised = segments_of("bodies/gc_mean_all.obj", {0.0, 1.1, 0.0});
    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = garment_format::read_pattern(pattern_file(fact.file));
        const bool is_older = fact.file.starts_with("garment_pattern_generator");
        EXPECT_TRUE(placement_shift(pattern, is_older ? chest : floor).fits()) << fact.file;

        const PlacementShift other = placement_shift(pattern, is_older ? floor : chest);
        EXPECT_FALSE(other.fits()) << fact.file;
        EXPECT_LT((other.shift - Vec3(0.0, is_older ? 1.15 : -1.12, 0.0)).norm(), 0.03)
            << fact.file << ": " << other.shift.transpose();
        EXPECT_GT(other.covering_shifted, 0.4) << fact.file;

        const PlacementShift lifted = placement_shift(pattern, raised);
        EXPECT_FALSE(lifted.fits()) << fact.file;
        EXPECT_LT((lifted.shift - Vec3(0.0, is_older ? 2.25 : 1.1, 0.0)).norm(), 0.03)
            << fact.file << ": " << lifted.shift.transpose();
    }
}

TEST(PlacingData, MessageNamesTheShift)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const Pattern tee = garment_format::read_pattern(pattern_file("garment_pattern_generator/tee.json"));
    const std::string text =
        misplacement_text(tee, placement_shift(tee, segments_of("bodies/gc_mean_all.obj")));
    EXPECT_NE(text.find("tee.json: its panels are not placed around the body: "), std::string::npos) << text;
    EXPECT_NE(text.find("after --shift 0,1.15,0; was the pattern drafted for another origin?"),
              std::string::npos)
        << text;
}

} // namespace toile::test
