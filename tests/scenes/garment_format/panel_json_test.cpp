#include <gtest/gtest.h>

#include <numbers>

#include "garment/pattern/edge_curve.h"
#include "garment/pattern/seam_side.h"
#include "tests/scenes/garment_format/texts.h"

/// Panel JSON: both dialects, units, curves, rotations, stitches, and what is wrong with a file.
namespace toile::test {

using namespace garment;
using garment_format::parse_pattern;

namespace {

/// A rectangle of 40 x 60 whose bottom edge has this curvature.
std::string curved(const std::string& curvature, const std::string& properties = "\"units_in_meter\": 100")
{
    return panel_json(R"("p": {"vertices": [[10, 0], [50, 0], [50, 60], [10, 60]], "edges": [
        {"endpoints": [0, 1], "curvature": )" +
                          curvature + R"(}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
        {"endpoints": [3, 0]}]})",
                      "", properties);
}

const PanelEdge& first_edge(const Pattern& pattern) { return pattern.panels[0].edges[0]; }

std::vector<Vec2> controls_of(const std::string& text)
{
    return std::get<Bezier>(first_edge(parse_pattern(text, "p.json")).curve).controls;
}

void expect_points(const std::vector<Vec2>& found, const std::vector<Vec2>& expected)
{
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i)
        EXPECT_LT((found[i] - expected[i]).norm(), 1e-12) << i;
}

TEST(PanelJson, ReadsControlPointsOfBothDialects)
{
    // p + a e + b n with e = (0.4, 0), n = (0, 0.4).
    expect_points(controls_of(curved("[0.5, -0.25]")), {{0.3, -0.1}});
    expect_points(controls_of(curved(R"({"type": "quadratic", "params": [[0.5, -0.25]]})")), {{0.3, -0.1}});
    expect_points(controls_of(curved(R"({"type": "cubic", "params": [[0.25, -0.25], [0.75, 0.5]]})")),
                  {{0.2, -0.1}, {0.4, 0.2}});
    expect_points(controls_of(curved("null")), {});
}

TEST(PanelJson, ReadsAbsoluteControlPoints)
{
    const std::string absolute = R"("units_in_meter": 100, "curvature_coords": "absolute")";
    expect_points(controls_of(curved("[30, -10]", absolute)), {{0.3, -0.1}});
    expect_points(controls_of(curved(R"({"type": "quadratic", "params": [[30, -10]]})", absolute)),
                  {{0.3, -0.1}});
    expect_points(
        controls_of(curved("[0.5, -0.25]", R"("units_in_meter": 100, "curvature_coords": "relative")")),
        {{0.3, -0.1}});
}

/// Radii scale with the unit, relative control points do not.
TEST(PanelJson, ScalesRadiiByUnitsInMeter)
{
    const std::string arc = R"({"type": "circle", "params": [25, 0, 1]})";
    for (const double units : {100.0, 300.0}) {
        const Pattern pattern =
            parse_pattern(curved(arc, "\"units_in_meter\": " + std::to_string(units)), "p.json");
        const double scale = 100.0 / units;
        EXPECT_NEAR(std::get<CircularArc>(first_edge(pattern).curve).radius, 0.25 * scale, 1e-12);
        // Half the chord over the radius is 0.8.
        EXPECT_NEAR(EdgeCurve(pattern.panels[0], 0).length(), 0.25 * scale * 2.0 * std::asin(0.8), 1e-5);
        // Right: bulges to the right of travel, below the edge.
        EXPECT_NEAR(EdgeCurve(pattern.panels[0], 0).at(0.5).y(), -0.1 * scale, 1e-5);
    }
    const Pattern quadratic = parse_pattern(curved("[0.5, -0.25]", "\"units_in_meter\": 300"), "p.json");
    EXPECT_NEAR(EdgeCurve(quadratic.panels[0], 0).at(0.5).y(), -0.05 / 3.0, 1e-6);
}

TEST(PanelJson, ReadsTheFlagsOfArcs)
{
    const auto arc = [](const std::string& flags) {
        return std::get<CircularArc>(
            first_edge(
                parse_pattern(curved(R"({"type": "circle", "params": [20.5, )" + flags + "]}"), "p.json"))
                .curve);
    };
    EXPECT_FALSE(arc("0, 1").large);
    EXPECT_TRUE(arc("0, 1").counter_clockwise);
    EXPECT_FALSE(arc("0, 0").counter_clockwise);
    EXPECT_TRUE(arc("1, 1").large);
    EXPECT_TRUE(arc("true, true").large);
    EXPECT_FALSE(arc("false, false").counter_clockwise);
}

Eigen::Matrix3d rotation(double degrees, const Vec3& axis)
{
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis).toRotationMatrix();
}

/// The collar back of a lapel, (90, 45, 0): the two orders differ.
TEST(PanelJson, ComposesRotationsAsTheWriterOfTheFileDid)
{
    const std::string placed = R"("rotation": [90, 45, 0], "translation": [10, 20, 30])";
    const Eigen::Matrix3d x = rotation(90, Vec3::UnitX());
    const Eigen::Matrix3d y = rotation(45, Vec3::UnitY());
    const auto rotation_of = [&](const std::string& more) {
        const Pattern pattern = parse_pattern(panel_json(panel_text("p", 40, 60, placed + more)), "p.json");
        EXPECT_LT((pattern.panels[0].placement.translation() - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
        return Eigen::Matrix3d(pattern.panels[0].placement.linear());
    };
    EXPECT_LT((rotation_of("") - y * x).norm(), 1e-12) << "older: Rz Ry Rx";
    EXPECT_LT((rotation_of(R"(, "label": "body")") - x * y).norm(), 1e-12) << "GarmentCode: Rx Ry Rz";
    // Curvature as an object is GarmentCode's too.
    std::string text = curved(R"({"type": "quadratic", "params": [[0.5, -0.25]]})");
    text.insert(text.find("\"vertices\""), placed + ", ");
    EXPECT_LT((parse_pattern(text, "p.json").panels[0].placement.linear() - x * y).norm(), 1e-12);
}

/// Start of one to end of the other, unless the stitch is right_wrong.
TEST(PanelJson, JoinsOppositeEnds)
{
    const auto seam_of = [](const std::string& third) {
        std::string stitch = stitch_text("front", 1, "back", 3);
        stitch.insert(stitch.size() - 1, third);
        return parse_pattern(
                   panel_json(panel_text("front", 40, 60) + ", " + panel_text("back", 40, 60), stitch),
                   "p.json")
            .seams.at(0);
    };
    const Seam seam = seam_of("");
    EXPECT_EQ(seam.a[0].from, 0.0);
    EXPECT_EQ(seam.a[0].to, 1.0);
    EXPECT_EQ(seam.b[0].from, 1.0);
    EXPECT_EQ(seam.b[0].to, 0.0);
    EXPECT_EQ(seam.name, "pattern.stitches[0]");
    EXPECT_EQ(seam.flip, "add \"right_wrong\" as its third entry");
    const Seam same_way = seam_of(", \"right_wrong\"");
    EXPECT_EQ(same_way.b[0].from, 0.0);
    EXPECT_EQ(same_way.b[0].to, 1.0);
    EXPECT_EQ(same_way.flip, "remove \"right_wrong\" from it");
}

TEST(PanelJson, KeepsTheOrderOfPanels)
{
    std::string text = tube_json();
    text.insert(text.find("\"panels\""), R"("panel_order": ["front", "gone", "back"], )");
    const Pattern pattern = parse_pattern(text, "p.json");
    EXPECT_EQ(pattern.panels[0].name, "front");
    EXPECT_EQ(pattern.panels[1].name, "back");
}

/// Keys of templates, and of later versions, mean nothing here.
TEST(PanelJson, IgnoresForeignKeys)
{
    EXPECT_EQ(
        pattern_complaint(R"({"parameters": {"length": {}}, "constraints": 3,)" + tube_json().substr(1)), "");
    EXPECT_EQ(
        pattern_complaint(panel_json(panel_text("p", 40, 60, R"("seam_allowance_of_some_program": 1)"))), "");
}

struct Mistake {
    std::string text;
    std::string message;
};

void expect_complaints(const std::vector<Mistake>& mistakes)
{
    for (const Mistake& mistake : mistakes)
        EXPECT_EQ(pattern_complaint(mistake.text), mistake.message) << mistake.text;
}

TEST(PanelJsonErrors, NameWhatIsNoPattern)
{
    expect_complaints({
        {R"({"toile": 1, "frames": 1})", "bad.json: is a scene; name a garment file or panel JSON"},
        {R"({"body": {}, "sim": {}})", "bad.json: is neither a garment file (\"toile_garment\": 1) nor a "
                                       "panel JSON (\"pattern\": {\"panels\": "
                                       "{...}, \"stitches\": [...]}); name one of them"},
        {"[1]", "bad.json: is neither a garment file (\"toile_garment\": 1) nor a panel JSON (\"pattern\": "
                "{\"panels\": {...}, \"stitches\": [...]}); name one of them"},
        {R"({"pattern": 3})", "bad.json: pattern: 3 is not an object; write {...}"},
        {R"({"pattern": {}})", "bad.json: pattern: the key \"panels\" is missing; add it"},
        {R"({"pattern": {"panels": []}})",
         "bad.json: pattern.panels: [] is not an object; write {\"name\": {...}}"},
        {panel_json(""), "bad.json: has no panel; a garment needs one at least"},
        {R"({"pattern": {"panels": {"a": {}, "a": {}}}})",
         "bad.json: the key \"a\" is given twice in one object; keep one of them"},
    });
}

TEST(PanelJsonErrors, NameUnits)
{
    expect_complaints({
        {panel_json(panel_text("p", 40, 60), "", ""),
         "bad.json: properties: the key \"units_in_meter\" is missing; add it: 100 for centimetres"},
        {panel_json(panel_text("p", 40, 60), "", "\"units_in_meter\": 0"),
         "bad.json: properties.units_in_meter: 0 is out of range; give a number above 0 and at most 100000"},
        {panel_json(panel_text("p", 40, 60), "", "\"units_in_metre\": 100"),
         "bad.json: properties.units_in_metre: unknown key; did you mean \"units_in_meter\"?"},
        {panel_json(panel_text("p", 40, 60), "", R"("units_in_meter": 100, "curvature_coords": "polar")"),
         "bad.json: properties.curvature_coords: \"polar\" is unknown; write \"relative\" or \"absolute\""},
        {panel_json(panel_text("front", 40, 60), "", "\"units_in_meter\": 1"),
         "bad.json: panel \"front\": is the largest and 60 m long, a house; the unit is wrong, with 100 "
         "times as "
         "many units in a metre it would have 0.6 m: properties.units_in_meter of panel JSON, or \"unit\" in "
         "a "
         "garment file"},
    });
}

TEST(PanelJsonErrors, NamePanelsAndEdges)
{
    const auto with = [](const std::string& vertices, const std::string& edges) {
        return panel_json(R"("p": {"vertices": )" + vertices + R"(, "edges": )" + edges + "}");
    };
    const std::string triangle = "[[0, 0], [40, 0], [0, 60]]";
    expect_complaints({
        {with(triangle, "3"), "bad.json: pattern.panels.p.edges: 3 is not a list; write [...]"},
        {with("[[0, 0, 0]]", "[]"),
         "bad.json: pattern.panels.p.vertices[0]: [0,0,0] is not a list of 2 numbers; write [x, y]"},
        {with(triangle, R"([{"endpoints": [0, 3]}])"),
         "bad.json: pattern.panels.p.edges[0].endpoints[1]: 3 is out of range; give a number from 0 to 2"},
        {with(triangle, R"([{"endpoints": [0, 1, 2]}])"),
         "bad.json: pattern.panels.p.edges[0].endpoints: [0,1,2] is not a list of 2 vertices; write [start, "
         "end]"},
        {with(triangle, R"([{"endpoint": [0, 1]}])"),
         "bad.json: pattern.panels.p.edges[0]: the key \"endpoints\" is missing; add it"},
        {with(triangle, R"([{"endpoints": [0, 1], "curvatur": [0.5, 0.1]}])"),
         "bad.json: pattern.panels.p.edges[0].curvatur: unknown key; did you mean \"curvature\"?"},
        {curved("[0.5]"),
         "bad.json: pattern.panels.p.edges[0].curvature: [0.5] is not a list of 2 numbers; write "
         "[x, y]"},
        {curved(R"({"type": "spline", "params": []})"),
         "bad.json: pattern.panels.p.edges[0].curvature.type: \"spline\" is unknown; write \"quadratic\", "
         "\"cubic\" "
         "or \"circle\""},
        {curved(R"({"type": "cubic", "params": [[0.5, 0.1]]})"),
         "bad.json: pattern.panels.p.edges[0].curvature.params: [[0.5,0.1]] is not a list of 2 control "
         "points; write "
         "[[x, y], [x, y]]"},
        {curved(R"({"type": "circle", "params": [25, 0]})"),
         "bad.json: pattern.panels.p.edges[0].curvature.params: [25,0] does not describe a circle; write "
         "[radius, "
         "large, right], the latter two 0 or 1"},
        {curved(R"({"type": "circle", "params": [25, 2, 0]})"),
         "bad.json: pattern.panels.p.edges[0].curvature.params[1]: 2 is neither 0 nor 1; write one of the "
         "two"},
        {curved(R"({"type": "circle", "params": [15, 0, 1]})"),
         "bad.json: panel \"p\", edge 0: an arc of radius 0.15 m cannot join ends that are 0.4 m apart; use "
         "at least "
         "half that distance"},
        {panel_json(panel_text("ba#nd", 40, 60)),
         "bad.json: pattern.panels: \"ba#nd\" can't name a panel; use letters, digits, _ and -"},
        {panel_json(panel_text("my panel", 40, 60)),
         "bad.json: pattern.panels: \"my panel\" can't name a panel; use letters, digits, _ and -"},
        {with(triangle, R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}])"),
         "bad.json: panel \"p\", edge 1: ends at vertex 2, but edge 0 starts at vertex 0; the edges of a "
         "panel must "
         "form one closed loop"},
    });
}

TEST(PanelJsonErrors, NameStitches)
{
    const auto with = [](const std::string& stitches) {
        return panel_json(panel_text("front", 40, 60) + ", " + panel_text("back", 40, 60), stitches);
    };
    std::string third = stitch_text("front", 1, "back", 3);
    third.insert(third.size() - 1, ", \"wrong_right\"");
    expect_complaints({
        {with(stitch_text("frnt", 1, "back", 3)), "bad.json: pattern.stitches[0][0].panel: no panel is named "
                                                  "\"frnt\"; did you mean \"front\"?"},
        {with(stitch_text("front", 1, "back", 4)),
         "bad.json: pattern.stitches[0][1].edge: panel \"back\" has no "
         "edge 4; its edges are 0 to 3"},
        {with(stitch_text("front", 1, "back", -1)),
         "bad.json: pattern.stitches[0][1].edge: panel \"back\" has no "
         "edge -1; its edges are 0 to 3"},
        {with("[{\"panel\": \"front\", \"edge\": 1}]"),
         "bad.json: pattern.stitches[0]: [{\"edge\":1,\"panel\":\"front\"}] does not join two edges; write "
         "[{\"panel\": ..., \"edge\": ...}, {...}]"},
        {with(third),
         "bad.json: pattern.stitches[0][2]: \"wrong_right\" is unknown; write \"right_wrong\", or nothing"},
        {with(stitch_text("front", 1, "back", 3) + ", " + stitch_text("front", 1, "back", 1)),
         "bad.json: pattern.stitches[1]: front edge 1 is in pattern.stitches[0] too; an edge is sewn once, "
         "or each "
         "part of it once"},
    });
}

} // namespace
} // namespace toile::test
