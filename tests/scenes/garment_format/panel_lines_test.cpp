#include <gtest/gtest.h>

#include "garment/pattern/edge_curve.h"
#include "tests/scenes/garment_format/texts.h"
#include "tests/support/temporary_folder.h"

/// Lines inside of panels in garment files, and what is sewn to them.
namespace toile::test {

using namespace garment;
using garment_format::read_pattern;

namespace {

class PanelLines : public ::testing::Test {
protected:
    PanelLines()
    {
        folder_.write("p.json",
                      panel_json(panel_text("front", 40, 60) + ", " + panel_text("pocket", 12, 10)));
    }

    Pattern read(const std::string& panels, const std::string& seams = "") const
    {
        return read_pattern(folder_.write(
            "t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "p.json"}], "panels": {)" +
                                  panels + R"(}, "seams": [)" + seams + "]}"));
    }

    std::string complaint(const std::string& panels, const std::string& seams = "") const
    {
        const std::string text = refusal([&] { static_cast<void>(read(panels, seams)); });
        return text.substr(std::min(text.size(), folder_.path().string().size() + 1));
    }

    TemporaryFolder folder_;
};

const std::string kPlace =
    R"("lines": {"place": {"points": [[0.1, 0.3], [0.1, 0.2], [0.22, 0.2], [0.22, 0.3]]}})";

TEST_F(PanelLines, AreSidesOfSeams)
{
    const Pattern pattern =
        read(R"("front": {)" + kPlace + "}",
             R"({"a": ["front.place"], "b": ["pocket.3", "pocket.0", "pocket.1"], "join": "start-start"})");
    ASSERT_EQ(pattern.panels[0].lines.size(), 1u);
    const Seam& seam = pattern.seams.at(0);
    EXPECT_TRUE(is_on_line(pattern, seam.a[0]));
    EXPECT_FALSE(is_on_line(pattern, seam.b[0]));
    const EdgeCurve curve(pattern.panels[0], seam.a[0].edge);
    EXPECT_NEAR(curve.length(), 0.32, 1e-12);
    EXPECT_LT((curve.at(0.5) - Vec2(0.16, 0.2)).norm(), 1e-12);
    EXPECT_EQ(read(R"("front": {)" + kPlace + "}",
                   R"({"a": ["front.place[0:0.3125]"], "b": ["pocket.3"], "join": "start-start"})")
                  .seams[0]
                  .a[0]
                  .to,
              0.3125);
}

TEST_F(PanelLines, AreMirroredWithTheirPanels)
{
    const Pattern pattern = read(R"("front": {"copies": 2, "mirror": true, )" + kPlace + "}");
    const Panel& copy = pattern.panels[2];
    EXPECT_EQ(copy.name, "front_2");
    EXPECT_EQ(copy.lines[0].points[2], Vec2(-0.22, 0.2));
}

TEST_F(PanelLines, AreRefusedInOneLine)
{
    const std::string with_place = R"("front": {)" + kPlace + "}";
    EXPECT_EQ(
        complaint(with_place, R"({"a": ["front.palce"], "b": ["pocket.3"]})"),
        "t.garment.json: seams[0].a[0]: panel \"front\" has no edge \"palce\"; did you mean \"place\"?");
    EXPECT_EQ(
        complaint(with_place, R"({"a": ["front.place"], "b": ["pocket.3", "pocket.0", "pocket.1"],
                                       "join": "start-start", "fold_deg": 90})"),
        "t.garment.json: seams[0].fold_deg: has no effect on a seam on a line inside of a panel; remove it");
    EXPECT_EQ(complaint(R"("front": {"lines": {"2": {"points": [[0, 0], [0.1, 0.1]]}}})"),
              "t.garment.json: panels.front.lines.2: is the name of an edge of \"front\"; choose another");
    EXPECT_EQ(complaint(R"("front": {"lines": {"a.b": {"points": [[0, 0], [0.1, 0.1]]}}})"),
              "t.garment.json: panels.front.lines.a.b: can't be named in seams; choose letters and digits");
    EXPECT_EQ(complaint(R"("front": {"lines": {"a": {"points": [[0, 0]]}}})"),
              "t.garment.json: panels.front.lines.a.points: 1 point; a line needs two or more");
    EXPECT_EQ(
        complaint(with_place, R"({"a": ["front.place[0:0.5]"], "b": ["pocket.3"]},
                                       {"a": ["front.place[0.4:1]"], "b": ["pocket.1"]})"),
        "t.garment.json: seams[1]: front line place[0.4:1] is in seams[0] too; an edge is sewn once, or "
        "each part of it once");
}

} // namespace
} // namespace toile::test
