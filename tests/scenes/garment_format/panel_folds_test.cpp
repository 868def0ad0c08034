#include <gtest/gtest.h>

#include "tests/scenes/garment_format/texts.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Folds of panels in garment files.
namespace toile::test {

using namespace garment;
using garment_format::read_pattern;

namespace {

class PanelFolds : public ::testing::Test {
protected:
    PanelFolds() { folder_.write("tube.json", tube_json()); } // front and back of 40 x 60 cm

    std::filesystem::path file(const std::string& folds, const std::string& panels) const
    {
        return folder_.write("t.garment.json",
                             R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}], "panels": {)" +
                                 panels + R"(}, "folds": [)" + folds + "]}");
    }
    Pattern read(const std::string& folds, const std::string& panels = "") const
    {
        return read_pattern(file(folds, panels));
    }

    std::string complaint(const std::string& folds) const
    {
        std::string text = refusal([&] { static_cast<void>(read(folds)); });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = 0; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }

    TemporaryFolder folder_;
};

TEST_F(PanelFolds, LieAlongALineOrBetweenTwoEdges)
{
    const Pattern pattern =
        read(R"({"panel": "front", "line": [[0.1, 0], [0.12, 0.3], [0.1, 0.6]], "angle_deg": -180},
        {"between": ["back.2[0.25]", "back.0[0.5]"], "angle_deg": 90, "stiffness": 0.2})");
    ASSERT_EQ(pattern.folds.size(), 2u);
    const PanelFold& line = pattern.folds[0];
    EXPECT_EQ(pattern.panels[size_t(line.panel)].name, "front");
    EXPECT_EQ(line.points, (std::vector<Vec2>{{0.1, 0.0}, {0.12, 0.3}, {0.1, 0.6}}));
    EXPECT_EQ(line.angle_deg, -180.0);
    EXPECT_EQ(line.stiffness, kFoldStiffness);
    EXPECT_EQ(line.name, "folds[0]");
    const PanelFold& between = pattern.folds[1];
    EXPECT_EQ(pattern.panels[size_t(between.panel)].name, "back");
    ASSERT_EQ(between.points.size(), 2u);
    EXPECT_LT((between.points[0] - Vec2(0.3, 0.6)).norm(), 1e-9) << "the top runs from right to left";
    EXPECT_LT((between.points[1] - Vec2(0.2, 0.0)).norm(), 1e-9);
    EXPECT_EQ(between.stiffness, 0.2);
}

TEST_F(PanelFolds, AreOnAllCopiesOfTheirPanelAndMirroredWithIt)
{
    const std::string fold = R"({"panel": "front", "line": [[0.1, 0], [0.1, 0.6]], "angle_deg": -90})";
    const Pattern pattern = read(fold, R"("front": {"copies": 3, "mirror": true})");
    ASSERT_EQ(pattern.folds.size(), 3u);
    const std::string names[] = {"front", "front_2", "front_3"};
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(pattern.panels[size_t(pattern.folds[size_t(k)].panel)].name, names[k]);
        EXPECT_EQ(pattern.folds[size_t(k)].points[1], Vec2(k == 1 ? -0.1 : 0.1, 0.6));
        EXPECT_EQ(pattern.folds[size_t(k)].angle_deg, -90.0) << "folded to its own outside";
    }
    EXPECT_EQ(pattern.folds[1].name, "folds[0] of copy 2");

    // One that names a copy is on that alone.
    const Pattern one = read(R"({"between": ["front_2.0[0.5]", "front_2.2[0.5]"], "angle_deg": 90})",
                             R"("front": {"copies": 2})");
    ASSERT_EQ(one.folds.size(), 1u);
    EXPECT_EQ(one.panels[size_t(one.folds[0].panel)].name, "front_2");
}

TEST_F(PanelFolds, AreRefusedInOneLine)
{
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {R"({"panel": "front", "line": [[0, 0], [0, 1]]})",
         "folds[0]: the key \"angle_deg\" is missing; add it"},
        {R"({"line": [[0, 0], [0, 1]], "angle_deg": 90})",
         "folds[0]: names no panel; add \"panel\", or write \"between\" for \"line\""},
        {R"({"panel": "frnt", "line": [[0, 0], [0, 1]], "angle_deg": 90})",
         "folds[0].panel: no panel is named \"frnt\"; did you mean \"front\"?"},
        {R"({"panel": "front", "line": [[0, 0]], "angle_deg": 90})",
         "folds[0].line: 1 point; a fold needs two or more"},
        {R"({"panel": "front", "line": [[0, 0], [0, 200]], "angle_deg": 90})",
         "folds[0].line[1][1]: 200 is out of range; give a number from -100 to 100 m"},
        {R"({"between": ["front.0[0.5]"], "angle_deg": 90})",
         "folds[0].between: 1 point; give the two ends of the fold"},
        {R"({"between": ["front.0[0.5]", "back.2[0.5]"], "angle_deg": 90})",
         "folds[0].between[1]: \"back.2[0.5]\" is on another panel than \"front.0[0.5]\"; a fold lies on one "
         "panel"},
        {R"({"between": ["front.0", "front.2[0.5]"], "angle_deg": 90})",
         "folds[0].between[0]: \"front.0\" names no point of an edge; write PANEL.EDGE[0.25], with an index "
         "or "
         "a label and a fraction of its length"},
        {R"({"between": ["front.0[1.5]", "front.2[0.5]"], "angle_deg": 90})",
         "folds[0].between[0]: \"front.0[1.5]\" lies beyond its edge; give a fraction from 0 to 1"},
        {R"({"between": ["front.7[0.5]", "front.2[0.5]"], "angle_deg": 90})",
         "folds[0].between[0]: panel \"front\" has no edge 7; its edges are 0 to 3"},
        {R"({"panel": "front", "between": ["front.0[0.5]", "front.2[0.5]"], "angle_deg": 90})",
         "folds[0].panel: is given together with \"between\", which names the panel and the ends; remove it"},
        {R"({"between": ["front.0[0.5]", "front.2[0.5]"], "angle_deg": 181})",
         "folds[0].angle_deg: 181 is out of range; give a number from -180 to 180 degrees"},
    };
    for (const auto& [fold, message] : mistakes)
        EXPECT_EQ(complaint(fold), "t.garment.json: " + message) << fold;
}

} // namespace
} // namespace toile::test
