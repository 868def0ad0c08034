#include <gtest/gtest.h>

#include "tests/scenes/garment_format/texts.h"
#include "tests/support/temporary_folder.h"

/// Points of panels in garment files: tacks and buttons, and what is held on the body.
namespace toile::test {

using namespace garment;
using garment_format::read_pattern;

namespace {

class Closures : public ::testing::Test {
protected:
    Closures() { folder_.write("tube.json", tube_json()); } // front and back of 40 x 60 cm

    Pattern read(const std::string& closures, const std::string& panels = "") const
    {
        return read_pattern(folder_.write(
            "t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}], "panels": {)" +
                                  panels + R"(}, "closures": [)" + closures + "]}"));
    }

    std::string complaint(const std::string& closures) const
    {
        std::string text = refusal([&] { static_cast<void>(read(closures)); });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = 0; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }

    TemporaryFolder folder_;
};

std::string panel_of(const Pattern& pattern, const PanelPoint& point)
{
    return pattern.panels[size_t(point.panel)].name;
}

TEST_F(Closures, JoinPointsOfEdgesAndOfThePlane)
{
    const Pattern pattern =
        read(R"({"a": "front.2[0.25]", "b": "back[0.1, 0.35]", "close_at": 1.5}, {"a": "front[0,0.6]",
                 "b": "front.0[1]"})");
    ASSERT_EQ(pattern.closures.size(), 2u);
    const Closure& first = pattern.closures[0];
    EXPECT_EQ(panel_of(pattern, first.a), "front");
    EXPECT_LT((first.a.point - Vec2(0.3, 0.6)).norm(), 1e-12) << "the top runs from right to left";
    EXPECT_EQ(panel_of(pattern, first.b), "back");
    EXPECT_EQ(first.b.point, Vec2(0.1, 0.35));
    EXPECT_EQ(first.close_at, 1.5);
    EXPECT_EQ(first.name, "closures[0]");
    EXPECT_EQ(pattern.closures[1].close_at, 0.0);
    EXPECT_EQ(pattern.closures[1].a.point, Vec2(0.0, 0.6)) << "a corner is on the panel";
}

TEST_F(Closures, AreOnAllCopiesOfBothPanels)
{
    const std::string both = R"("front": {"copies": 2, "mirror": true}, "back": {"copies": 3})";
    const Pattern pattern = read(R"({"a": "front[0.1,0.2]", "b": "back[0.3,0.2]"})", both);
    ASSERT_EQ(pattern.closures.size(), 2u);
    EXPECT_EQ(panel_of(pattern, pattern.closures[1].a), "front_2");
    EXPECT_EQ(pattern.closures[1].a.point, Vec2(-0.1, 0.2)) << "mirrored with its panel";
    EXPECT_EQ(panel_of(pattern, pattern.closures[1].b), "back_2");
    EXPECT_EQ(pattern.closures[1].b.point, Vec2(0.3, 0.2));
    EXPECT_EQ(pattern.closures[1].name, "closures[0] of copy 2");

    EXPECT_EQ(read(R"({"a": "front[0.1,0.2]", "b": "front_2[-0.1,0.2]"})", both).closures.size(), 1u)
        << "the original and its copy";
}

TEST_F(Closures, AreRefusedInOneLine)
{
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {R"({"a": "front[0.1,0.2]"})", "closures[0]: the key \"b\" is missing; add it"},
        {R"({"a": "frnt[0.1,0.2]", "b": "back[0,0]"})",
         "closures[0].a: no panel is named \"frnt\"; did you mean \"front\"?"},
        {R"({"a": "front[0.1,0.7]", "b": "back[0,0]"})", "closures[0].a: \"front[0.1,0.7]\" lies outside of "
                                                         "the panel, which has x from 0 to 0.4 and y from 0 "
                                                         "to 0.6 m"},
        {R"({"a": "front[0.1,two]", "b": "back[0,0]"})", "closures[0].a: \"front[0.1,two]\" names no point "
                                                         "of a panel; write PANEL[0.1,0.2], by metres in its "
                                                         "plane, or PANEL.EDGE[0.25]"},
        {R"({"a": "front[0.1,]", "b": "back[0,0]"})",
         "closures[0].a: \"front[0.1,]\" names no point of a panel; write PANEL[0.1,0.2], by metres in its "
         "plane, or PANEL.EDGE[0.25]"},
        {R"({"a": "front.9[0.5]", "b": "back[0,0]"})",
         "closures[0].a: panel \"front\" has no edge 9; its edges are 0 to 3"},
        {R"({"a": "front.0[0.5]", "b": "front[0.2,0]"})",
         "closures[0]: closes a point with itself; name two"},
        {R"({"a": "front.0[0.5]", "b": "back[0,0]", "close_at": -1})",
         "closures[0].close_at: -1 is out of range; give a number from 0 to 60 s"},
    };
    for (const auto& [closure, message] : mistakes)
        EXPECT_EQ(complaint(closure), "t.garment.json: " + message) << closure;
}

class Attachments : public Closures {
protected:
    Pattern read_attach(const std::string& attach) const
    {
        return read_pattern(folder_.write(
            "t.garment.json",
            R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}], "attach": [)" + attach + "]}"));
    }
    std::string complaint_about(const std::string& attach) const
    {
        const std::string text = refusal([&] { static_cast<void>(read_attach(attach)); });
        return text.substr(std::min(text.size(), folder_.path().string().size() + 1));
    }
};

TEST_F(Attachments, NameEdgesAndPoints)
{
    const Pattern pattern = read_attach(
        R"({"edges": ["front.2[0.2:0.6]", "back.2"]}, {"points": ["back[0.1,0.3]"], "release": true})");
    ASSERT_EQ(pattern.attachments.size(), 2u);
    ASSERT_EQ(pattern.attachments[0].edges.size(), 2u);
    EXPECT_EQ(pattern.attachments[0].edges[0].edge, 2);
    EXPECT_EQ(pattern.attachments[0].edges[0].to, 0.6);
    EXPECT_FALSE(pattern.attachments[0].is_released);
    ASSERT_EQ(pattern.attachments[1].points.size(), 1u);
    EXPECT_EQ(pattern.attachments[1].points[0].point, Vec2(0.1, 0.3));
    EXPECT_TRUE(pattern.attachments[1].is_released);
}

TEST_F(Attachments, AreRefusedInOneLine)
{
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {R"({"release": true})", "attach[0]: holds nothing; name \"edges\" or \"points\""},
        {R"({"edges": ["front.7"]})",
         "attach[0].edges[0]: panel \"front\" has no edge 7; its edges are 0 to 3"},
        {R"({"points": ["front[0,0]", "bck[0,0]"]})",
         "attach[0].points[1]: no panel is named \"bck\"; did you mean \"back\"?"},
        {R"({"edges": ["front.2"], "release": 1})",
         "attach[0].release: 1 is neither true nor false; write one of the two"},
    };
    for (const auto& [entry, message] : mistakes)
        EXPECT_EQ(complaint_about(entry), "t.garment.json: " + message) << entry;
}

} // namespace
} // namespace toile::test
