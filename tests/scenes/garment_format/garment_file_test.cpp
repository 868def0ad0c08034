#include <gtest/gtest.h>

#include "garment/pattern/edge_curve.h"
#include "garment/pattern/seam_measure.h"
#include "garment/pattern/seam_side.h"
#include "garment/pattern/sewn_sides.h"
#include "tests/scenes/garment_format/texts.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// The garment file: patterns, settings of panels, copies and mirror images, seams.
namespace toile::test {

using namespace garment;
using garment_format::read_pattern;

namespace {

class GarmentFile : public ::testing::Test {
protected:
    GarmentFile() { folder_.write("tube.json", tube_json()); }

    /// Writes a garment of tube.json with more keys.
    std::filesystem::path file(const std::string& keys) const
    {
        return folder_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}])" +
                                                   (keys.empty() ? "" : ", " + keys) + "}");
    }

    Pattern read(const std::string& keys) const { return read_pattern(file(keys)); }

    /// Error of the reader, without the folder.
    std::string complaint(const std::string& keys) const { return complaint_about(file(keys)); }
    std::string complaint_about(const std::filesystem::path& path) const
    {
        std::string text = refusal([&] { static_cast<void>(read_pattern(path)); });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = 0; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }

    TemporaryFolder folder_;
};

const Panel& panel_of(const Pattern& pattern, const std::string& name)
{
    for (const Panel& panel : pattern.panels)
        if (panel.name == name)
            return panel;
    throw std::out_of_range(name);
}

TEST_F(GarmentFile, HasThePanelsAndStitchesOfItsPatterns)
{
    const Pattern pattern = read(R"("description": "A tube.")");
    EXPECT_EQ(pattern.panels.size(), 2u);
    EXPECT_EQ(pattern.seams.size(), 2u);
    EXPECT_EQ(pattern.description, "A tube.");
    EXPECT_EQ(pattern.files.size(), 2u);
    EXPECT_NEAR(signed_area(pattern.panels[0]), 0.24, 1e-12);
}

TEST_F(GarmentFile, SetsUnits)
{
    folder_.write("inches.json", panel_json(panel_text("front", 16, 24), "", ""));
    const Pattern pattern = read_pattern(folder_.write(
        "t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "inches.json", "unit": "in"}]})"));
    EXPECT_NEAR(signed_area(pattern.panels[0]), 16.0 * 24.0 * 0.0254 * 0.0254, 1e-12);
}

TEST_F(GarmentFile, SetsElastics)
{
    const Pattern pattern = read(R"("elastics": [{"edges": ["back.2", "front.2[0.25:0.75]"], "ratio": 0.7,
        "stiffness": 12}])");
    ASSERT_EQ(pattern.elastics.size(), 1u);
    const Elastic& elastic = pattern.elastics[0];
    EXPECT_EQ(elastic.ratio, 0.7);
    EXPECT_EQ(elastic.stiffness, 12.0);
    ASSERT_EQ(elastic.edges.size(), 2u);
    EXPECT_EQ(pattern.panels[size_t(elastic.edges[0].panel)].name, "back");
    EXPECT_EQ(elastic.edges[0].to, 1.0);
    EXPECT_EQ(pattern.panels[size_t(elastic.edges[1].panel)].name, "front");
    EXPECT_EQ(elastic.edges[1].edge, 2);
    EXPECT_EQ(elastic.edges[1].from, 0.25);
    EXPECT_EQ(elastic.edges[1].to, 0.75);
}

TEST_F(GarmentFile, SetsPanels)
{
    const Pattern pattern = read(R"("panels": {"front": {"fabric": "denim", "edge": 0.008, "grain_deg": 45,
        "shrink": {"warp": 0.95}, "layer": 2, "place": {"at": "left_arm", "angle_deg": 30, "height": 0.9, "distance": 0.05, "wrap": false}}})");
    const Panel& front = panel_of(pattern, "front");
    EXPECT_EQ(front.fabric, "denim");
    EXPECT_EQ(front.edge_length, 0.008);
    EXPECT_EQ(front.grain_deg, 45.0);
    EXPECT_EQ(front.shrink_warp, 0.95);
    EXPECT_EQ(front.shrink_weft, 1.0);
    EXPECT_EQ(front.layer, 2);
    ASSERT_TRUE(front.place);
    EXPECT_EQ(front.place->at, BodySegment::LeftArm);
    EXPECT_EQ(front.place->angle_deg, 30.0);
    EXPECT_EQ(front.place->height, 0.9);
    EXPECT_EQ(front.place->distance, 0.05);
    EXPECT_FALSE(front.place->wrap);
    const Panel& back = panel_of(pattern, "back");
    EXPECT_EQ(back.fabric, "");
    EXPECT_FALSE(back.place || back.edge_length);
}

TEST_F(GarmentFile, JoinsEdgesByIndexLabelAndPart)
{
    folder_.write("tube.json",
                  panel_json(panel_text("front", 40, 60) + ", " + panel_text("half", 40, 30) + R"(,
        "top": {"vertices": [[0, 0], [40, 0], [0, 60]], "edges": [{"endpoints": [0, 1], "label": "lower_interface"},
        {"endpoints": [1, 2]}, {"endpoints": [2, 0]}]})"));
    const Pattern pattern = read(R"("seams": [
        {"a": ["front.1[0.5:1]"], "b": ["half.3"], "fold_deg": 90, "order": 3, "gather": "long"},
        {"a": ["front.2"], "b": ["top.lower_interface"], "join": "start-start"}])");
    ASSERT_EQ(pattern.seams.size(), 2u);
    const Seam& part = pattern.seams[0];
    EXPECT_EQ(part.name, "seams[0]");
    EXPECT_EQ(pattern.panels[size_t(part.a[0].panel)].name, "front");
    EXPECT_EQ(part.a[0].edge, 1);
    EXPECT_EQ(part.a[0].from, 0.5);
    EXPECT_EQ(part.a[0].to, 1.0);
    EXPECT_EQ(part.b[0].from, 1.0);
    EXPECT_EQ(part.b[0].to, 0.0);
    EXPECT_EQ(part.fold_deg, 90.0);
    EXPECT_EQ(part.order, 3);
    EXPECT_EQ(part.gather, Gather::Long);
    EXPECT_NEAR(measure_seam(pattern, part).length_a, 0.3, 1e-12);
    EXPECT_EQ(part.flip, "write \"join\": \"start-start\" in it");
    const Seam& label = pattern.seams[1];
    EXPECT_EQ(pattern.panels[size_t(label.b[0].panel)].name, "top");
    EXPECT_EQ(label.b[0].edge, 0);
    EXPECT_EQ(label.b[0].from, 0.0);
    EXPECT_EQ(label.gather, Gather::Short);
    EXPECT_EQ(label.flip, "write \"join\": \"start-end\" in it");
}

/// A waistband round front and back: the chain is reversed as a whole.
TEST_F(GarmentFile, JoinsChains)
{
    folder_.write("band.json", panel_json(panel_text("band", 80, 10)));
    const Pattern pattern = read_pattern(folder_.write("t.garment.json", R"({"toile_garment": 1,
        "patterns": [{"file": "tube.json"}, {"file": "band.json"}],
        "seams": [{"a": ["band.0"], "b": ["back.2", "front.2"]}, {"a": ["band.1"], "b": ["band.3"]}]})"));
    const Seam& waist = pattern.seams[2];
    ASSERT_EQ(waist.b.size(), 2u);
    EXPECT_EQ(pattern.panels[size_t(waist.b[0].panel)].name, "front");
    EXPECT_EQ(pattern.panels[size_t(waist.b[1].panel)].name, "back");
    EXPECT_EQ(waist.b[0].from, 1.0);
    const SeamMeasure measure = measure_seam(pattern, waist);
    EXPECT_NEAR(measure.ratio(), 1.0, 1e-12);
    EXPECT_TRUE(sewn_sides(pattern).one_sided.empty());
    EXPECT_EQ(pattern.seams[0].name, "pattern.stitches[0] of tube.json");
}

TEST_F(GarmentFile, ReplacesAStitchBetweenTheSameEdges)
{
    const Pattern pattern = read(R"("seams": [{"a": ["back.3"], "b": ["front.1"], "fold_deg": 180}])");
    ASSERT_EQ(pattern.seams.size(), 2u);
    EXPECT_EQ(pattern.seams[0].name, "pattern.stitches[1]");
    EXPECT_EQ(pattern.seams[1].fold_deg, 180.0);
    // One that shares a single edge with a stitch is a contradiction.
    EXPECT_EQ(
        complaint(R"("seams": [{"a": ["back.0"], "b": ["front.1"]}])"),
        "t.garment.json: seams[0]: front edge 1 is in pattern.stitches[0] too; an edge is sewn once, or each "
        "part of it once");
}

/// A panel with a curve of each kind, at the wearer's right.
std::string sleeve_json()
{
    return panel_json(
        R"("sleeve": {"translation": [-30, 100, 5], "rotation": [0, 0, 45], "label": "left_part",
        "vertices": [[0, 0], [40, 0], [45, 30], [0, 30]], "edges": [
        {"endpoints": [0, 1], "label": "left_armhole"},
        {"endpoints": [1, 2], "curvature": {"type": "circle", "params": [40, 0, 1]}},
        {"endpoints": [2, 3], "curvature": {"type": "cubic", "params": [[0.2, 0.1], [0.7, -0.1]]}},
        {"endpoints": [3, 0]}]},)" +
            panel_text("cuff", 40, 10, R"("label": "arm")"),
        stitch_text("sleeve", 0, "cuff", 2) + ", " + stitch_text("cuff", 1, "cuff", 3));
}

TEST_F(GarmentFile, MirrorsCopiesThroughTheBodysPlane)
{
    folder_.write("tube.json", sleeve_json());
    const Pattern pattern =
        read(R"("panels": {"sleeve": {"copies": 2, "mirror": true, "grain_deg": 10, "fabric":
        "wool", "place": {"at": "left_arm", "angle_deg": 20}}, "cuff": {"copies": 2, "mirror": true}})");
    ASSERT_EQ(pattern.panels.size(), 4u);
    const Panel& sleeve = panel_of(pattern, "sleeve");
    const Panel& image = panel_of(pattern, "sleeve_2");
    EXPECT_EQ(image.fabric, "wool");
    EXPECT_EQ(image.grain_deg, -10.0);
    EXPECT_EQ(image.label, "right_part");
    EXPECT_EQ(image.edges[3].label, "right_armhole");
    ASSERT_TRUE(image.place);
    EXPECT_EQ(image.place->at, BodySegment::RightArm);
    EXPECT_EQ(image.place->angle_deg, -20.0);

    // The copy lies at the image of every edge, and keeps the area and its sign.
    EXPECT_NEAR(signed_area(image), signed_area(sleeve), 1e-9);
    EXPECT_NEAR(image.placement.linear().determinant(), 1.0, 1e-12);
    for (int e = 0; e < 4; ++e) {
        const EdgeCurve edge(sleeve, e);
        const EdgeCurve reflected(image, 3 - e);
        EXPECT_NEAR(edge.length(), reflected.length(), 1e-9);
        for (const double fraction : {0.0, 0.3, 1.0}) {
            const Vec2 flat = edge.at(fraction);
            const Vec2 flat_image = reflected.at(1.0 - fraction);
            Vec3 expected = sleeve.placement * Vec3(flat.x(), flat.y(), 0.0);
            expected.x() = -expected.x();
            EXPECT_LT((image.placement * Vec3(flat_image.x(), flat_image.y(), 0.0) - expected).norm(), 1e-6)
                << e;
        }
    }

    // Stitches between panels that are cut alike are repeated, and two-sided.
    ASSERT_EQ(pattern.seams.size(), 4u);
    const Seam& seam = pattern.seams[2];
    EXPECT_EQ(seam.name, "pattern.stitches[0] of copy 2");
    EXPECT_EQ(pattern.panels[size_t(seam.a[0].panel)].name, "sleeve_2");
    EXPECT_EQ(seam.a[0].edge, 3);
    EXPECT_EQ(seam.a[0].from, 1.0) << "runs where the original does";
    EXPECT_EQ(seam.b[0].from, 0.0);
    EXPECT_EQ(pattern.panels[size_t(seam.b[0].panel)].name, "cuff_2");
    EXPECT_NEAR(measure_seam(pattern, seam).gap, measure_seam(pattern, pattern.seams[0]).gap, 1e-9);
    const SewnSides sides = sewn_sides(pattern);
    EXPECT_TRUE(sides.one_sided.empty());
    EXPECT_EQ(std::count(sides.turned.begin(), sides.turned.end(), true), 0);
}

TEST_F(GarmentFile, CutsCopiesThatAreSetByThemselves)
{
    const Pattern pattern =
        read(R"("panels": {"front": {"copies": 3, "layer": 1}, "front_3": {"layer": 5}})");
    ASSERT_EQ(pattern.panels.size(), 4u);
    EXPECT_EQ(panel_of(pattern, "front_2").layer, 1);
    EXPECT_EQ(panel_of(pattern, "front_3").layer, 5);
    EXPECT_EQ(pattern.seams.size(), 2u) << "the back is cut once";
    EXPECT_LT((panel_of(pattern, "front_3").placement.translation() -
               panel_of(pattern, "front").placement.translation() - Vec3(0.0, 0.0, 0.02))
                  .norm(),
              1e-12);
}

TEST_F(GarmentFile, NamesMistakes)
{
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {R"("panel": {})", "panel: unknown key; did you mean \"panels\"?"},
        {R"("buttons": [])", "buttons: unknown key; known are toile_garment, description, patterns, panels, "
                             "seams, elastics, folds, closures and attach"},
        {R"("panels": {"frnt": {}})", "panels.frnt: no panel is named \"frnt\"; did you mean \"front\"?"},
        {R"("panels": {"front": {"fabric": "demin"}})",
         "panels.front.fabric: no fabric is named \"demin\"; did you mean \"denim\"?"},
        {R"("panels": {"front": {"edge": 5}})",
         "panels.front.edge: 5 is out of range; give a number from 0.0005 to 1 m"},
        {R"("elastics": [{"edges": ["frnt.0"], "ratio": 0.5, "stiffness": 9}])",
         "elastics[0].edges[0]: no panel is named \"frnt\"; did you mean \"front\"?"},
        {R"("elastics": [{"edges": [], "ratio": 0.5, "stiffness": 9}])",
         "elastics[0].edges: names no edge; write [\"PANEL.EDGE\"]"},
        {R"("elastics": [{"edges": ["front.0"], "ratio": 0.1, "stiffness": 9}])",
         "elastics[0].ratio: 0.1 is out of range; give a number from 0.2 to 1"},
        {R"("elastics": [{"edges": ["front.0"], "ratio": 0.5}])",
         "elastics[0]: the key \"stiffness\" is missing; add it"},
        {R"("panels": {"front": {"shrink": {"warp": 5}}})",
         "panels.front.shrink.warp: 5 is out of range; give a number from 0.5 to 1.5"},
        {R"("panels": {"front": {"shrink": {"wrap": 0.9}}})",
         "panels.front.shrink.wrap: unknown key; did you mean \"warp\"?"},
        {R"("panels": {"front": {"mirror": true}})",
         "panels.front.mirror: has no effect on a panel that is cut once; write \"copies\": 2"},
        {R"("panels": {"front": {"copies": 2}, "front_2": {"copies": 2}})",
         "panels.front_2.copies: \"front_2\" is a copy; give the number of copies with its original"},
        {R"("panels": {"front": {"place": {"at": "tail"}}})",
         "panels.front.place.at: \"tail\" is unknown; write \"torso\", \"neck\", \"left_arm\", "
         "\"right_arm\", "
         "\"left_leg\" or \"right_leg\""},
        {R"("panels": {"front": {"place": {}}})", "panels.front.place: the key \"at\" is missing; add it"},
        {R"("seams": [{"a": ["front.0"], "b": []}])", "seams[0].b: names no edge; write [\"PANEL.EDGE\"]"},
        {R"("seams": [{"a": ["front"], "b": ["back.0"]}])",
         "seams[0].a[0]: \"front\" names no edge; write PANEL.EDGE, with an index or a label, or "
         "PANEL.EDGE[0.2:0.6]"},
        {R"("seams": [{"a": ["front.0[0.2]"], "b": ["back.0"]}])",
         "seams[0].a[0]: \"front.0[0.2]\" names no edge; write PANEL.EDGE, with an index or a label, or "
         "PANEL.EDGE[0.2:0.6]"},
        {R"("seams": [{"a": ["front.0[0.2:1.2]"], "b": ["back.0"]}])",
         "seams[0].a[0]: \"front.0[0.2:1.2]\" is no part of an edge; give two different fractions of its "
         "length, "
         "from 0 to 1"},
        {R"("seams": [{"a": ["front.9"], "b": ["back.0"]}])",
         "seams[0].a[0]: panel \"front\" has no edge 9; its edges are 0 to 3"},
        {R"("seams": [{"a": ["front.waist"], "b": ["back.0"]}])",
         "seams[0].a[0]: panel \"front\" has no edge \"waist\"; its edges are 0 to 3"},
        {R"("seams": [{"a": ["bck.0"], "b": ["front.0"]}])",
         "seams[0].a[0]: no panel is named \"bck\"; did you mean \"back\"?"},
        {R"("seams": [{"a": ["front.0"], "b": ["back.0"], "join": "end-end"}])",
         "seams[0].join: \"end-end\" is unknown; write \"start-end\" or \"start-start\""},
        {R"("seams": [{"a": ["front.0[0:0.2]"], "b": ["back.0"]}])",
         "seams[0]: front edge 0[0:0.2] is 0.08 m long, but back edge 0 0.4 m; at most 4 times as long can "
         "be "
         "gathered, sew other edges or parts of them"},
    };
    for (const auto& [keys, message] : mistakes)
        EXPECT_EQ(complaint(keys), "t.garment.json: " + message) << keys;
}

TEST_F(GarmentFile, NamesMistakesAboutItsPatterns)
{
    const auto with = [&](const std::string& patterns) {
        return complaint_about(
            folder_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [)" + patterns + "]}"));
    };
    const std::string tube = R"({"file": "tube.json"})";
    EXPECT_EQ(with(""), "t.garment.json: patterns: names no file; a garment needs one at least");
    EXPECT_EQ(
        with(R"({"file": "none.json"})"),
        "t.garment.json: patterns[0].file: the file \"none.json\" does not exist; paths are relative to the "
        "folder of the file that names them");
    EXPECT_EQ(with(tube + ", " + tube),
              "t.garment.json: patterns[1].file: its panel \"back\" has the name of one in "
              "an earlier file; rename one of them");
    EXPECT_EQ(
        with(R"({"file": "t.garment.json"})"),
        "t.garment.json: patterns[0].file: \"t.garment.json\" is a garment file itself; name the panel JSON "
        "that it names");
    EXPECT_EQ(with(R"({"file": "tube.json", "unit": "ft"})"),
              "t.garment.json: patterns[0].unit: \"ft\" is unknown; write \"m\", \"cm\", \"mm\" or \"in\"");
    EXPECT_EQ(
        with(R"({"file": "tube.json", "unit": "m"})"),
        "t.garment.json: panel \"back\": is the largest and 60 m long, a house; the unit is wrong, with 100 "
        "times as many units in a metre it would have 0.6 m: properties.units_in_meter of panel JSON, or "
        "\"unit\" in a garment file");
    EXPECT_EQ(complaint_about(folder_.write("t.garment.json", R"({"toile_garment": 2})")),
              "t.garment.json: toile_garment: 2 is a version of the format that this program does not know; "
              "write 1");
    folder_.write("sides.json", panel_json(R"("p": {"vertices": [[0, 0], [40, 0], [0, 60]], "edges": [
        {"endpoints": [0, 1], "label": "hem"}, {"endpoints": [1, 2], "label": "hem"}, {"endpoints": [2, 0]}]})"));
    EXPECT_EQ(complaint_about(folder_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [
                  {"file": "sides.json"}], "seams": [{"a": ["p.hem"], "b": ["p.2"]}]})")),
              "t.garment.json: seams[0].a[0]: \"hem\" is the label of edges 0 and 1 of panel \"p\"; name one "
              "by its "
              "index");
}

/// The example of the guide.
TEST(GarmentExample, IsSewnToOneTubeWithoutTwists)
{
    const Pattern skirt =
        read_pattern(std::filesystem::path(TOILE_SOURCE_DIR) / "assets/a_line_skirt.garment.json");
    EXPECT_EQ(skirt.panels.size(), 3u);
    EXPECT_EQ(skirt.panels[0].name, "front");
    ASSERT_EQ(skirt.seams.size(), 4u);
    EXPECT_NEAR(measure_seam(skirt, skirt.seams[3]).ratio(), 1.05, 0.005);
    for (const Seam& seam : skirt.seams)
        EXPECT_FALSE(measure_seam(skirt, seam).crossed) << seam.name;
    EXPECT_TRUE(sewn_sides(skirt).one_sided.empty());
}

} // namespace
} // namespace toile::test
