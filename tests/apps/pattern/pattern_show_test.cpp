#include <gtest/gtest.h>

#include <sstream>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include "core/compute/types.h"
#include "tests/apps/program.h"

/// toile pattern show: what it prints, draws and refuses.
namespace toile::test {

namespace {

/// Panel JSON of a tube of 40 x 60 cm: front before and back behind the axis. `third` follows the edges of
/// the first stitch.
std::string tube(const std::string& third = "")
{
    const std::string shape = R"("vertices": [[0, 0], [40, 0], [40, 60], [0, 60]], "edges": [
        {"endpoints": [0, 1]}, {"endpoints": [1, 2], "label": "side & <hem>"}, {"endpoints": [2, 3],
        "curvature": {"type": "quadratic", "params": [[0.5, 0.1]]}}, {"endpoints": [3, 0]}])";
    return R"({"properties": {"units_in_meter": 100}, "pattern": {"panels": {
        "front": {"translation": [-20, 0, 20], "label": "body", )" +
           shape + R"(}, "back": {"translation": [20, 0, -20], "rotation": [0, 180, 0], )" + shape +
           R"(}}, "stitches": [
        [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3})" +
           third + R"(],
        [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]]}})";
}

class PatternShow : public FileTest {
protected:
    PatternShow()
    {
        temporary_.write("tube.json", tube());
        temporary_.write("moebius.json", tube(", \"right_wrong\""));
    }

    Finished show(const std::vector<std::string>& arguments) const
    {
        std::vector<std::string> words{"pattern", "show"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        return run_toile(words, temporary_.path());
    }

    std::string drawing(const std::string& pattern) const
    {
        EXPECT_EQ(show({pattern, "-o", "out/x.svg"}).exit_code, 0);
        return bytes_of(temporary_.path() / "out/x.svg");
    }
};

TEST_F(PatternShow, PrintsPanelsEdgesAndSeams)
{
    const Finished finished = show({"tube.json"});
    EXPECT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_EQ(finished.errors, "");
    EXPECT_EQ(finished.output.find("tube.json: 2 panels, 0.4693 m^2, 2 seams\n"), 0u) << finished.output;
    for (const char* line :
         {"panel front (body): 0.2347 m^2, 0.400 x 0.600 m\n", "  edge 0: 0.4000 m, straight\n",
          "  edge 1: 0.6000 m, straight, side & <hem>, seam 0\n", "  edge 3: 0.6000 m, straight, seam 1\n",
          "seam 0: front.1 to back.3, start-end, 0.6000 and 0.6000 m, ratio 1.000, gap 0.400 m\n"})
        EXPECT_NE(finished.output.find(line), std::string::npos) << line << finished.output;
    EXPECT_EQ(finished.output.find("twisted"), std::string::npos);
}

TEST_F(PatternShow, DrawsClosuresAndLinesInside)
{
    temporary_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}],
        "panels": {"front": {"lines": {"dart": {"points": [[0.1, 0.2], [0.1, 0.3]]}}}},
        "closures": [{"a": "front[0.1,0.1]", "b": "back.0[0.5]"}]})");
    const std::string picture = drawing("t.garment.json"), plain = drawing("tube.json");
    const auto count = [](const std::string& text, const std::string& word) {
        int found = 0;
        for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
            ++found;
        return found;
    };
    EXPECT_EQ(count(picture, "class=\"closure\""), 2);
    EXPECT_EQ(count(picture, "stroke-dasharray"), 1);
    EXPECT_EQ(count(plain, "class=\"closure\"") + count(plain, "stroke-dasharray"), 0);
}

TEST_F(PatternShow, PrintsJson)
{
    const Finished finished = show({"tube.json", "--json"});
    const auto json = nlohmann::json::parse(finished.output);
    EXPECT_NEAR(json["area_m2"], 0.469333, 2e-6); // 2 (0.24 - 2/3 0.4 0.02): a parabola cuts into the top
    ASSERT_EQ(json["panels"].size(), 2u);
    const auto& front = json["panels"][1];
    EXPECT_EQ(front["name"], "front");
    EXPECT_EQ(front["label"], "body");
    EXPECT_EQ(front["size_m"], (nlohmann::json{0.4, 0.6}));
    EXPECT_EQ(front["edges"][1]["label"], "side & <hem>");
    EXPECT_EQ(front["edges"][1]["length_m"], 0.6);
    EXPECT_EQ(front["edges"][1]["seams"], nlohmann::json{0});
    EXPECT_EQ(front["edges"][2]["curve"], "quadratic");
    const auto& seam = json["seams"][0];
    EXPECT_EQ(seam["a"], nlohmann::json{"front.1"});
    EXPECT_EQ(seam["b"], nlohmann::json{"back.3"});
    EXPECT_EQ(seam["ratio"], 1.0);
    EXPECT_EQ(seam["gap_m"], 0.4);
    EXPECT_EQ(seam["twisted"], false);
    EXPECT_FALSE(seam.contains("mend"));
}

TEST_F(PatternShow, NamesTwistedSeamsAndWhatMendsThem)
{
    const Finished text = show({"moebius.json"});
    EXPECT_EQ(text.exit_code, 0);
    const std::string line =
        "seam 0 is twisted: its sides run against each other as they are placed, 0.520 m apart "
        "in the mean, 0.400 m if the other ends are joined; it makes the sewn surface "
        "one-sided; in pattern.stitches[0]: remove \"right_wrong\" from it\n";
    EXPECT_NE(text.output.find(line), std::string::npos) << text.output;
    const auto seam = nlohmann::json::parse(show({"moebius.json", "--json"}).output)["seams"][0];
    EXPECT_EQ(seam["twisted"], true);
    EXPECT_EQ(seam["one_sided"], true);
    EXPECT_EQ(seam["join"], "start-start");
    EXPECT_EQ(seam["mend"], "pattern.stitches[0]: remove \"right_wrong\" from it");
    EXPECT_NE(drawing("moebius.json").find("seam 0 is twisted"), std::string::npos);

    // A garment file flips by its own key.
    temporary_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}],
        "seams": [{"a": ["front.1"], "b": ["back.3"], "join": "start-start"}]})");
    const auto seams = nlohmann::json::parse(show({"t.garment.json", "--json"}).output)["seams"];
    EXPECT_EQ(seams[1]["mend"], "seams[0]: write \"join\": \"start-end\" in it");
}

size_t count(const std::string& text, const std::string& word)
{
    size_t found = 0;
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size())
        ++found;
    return found;
}

TEST_F(PatternShow, DrawsPanelsAndSeams)
{
    const std::string svg = drawing("tube.json");
    EXPECT_EQ(svg.find("<svg "), 0u);
    EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
    EXPECT_EQ(count(svg, ">front<"), 1u);
    EXPECT_EQ(count(svg, ">back<"), 1u);
    EXPECT_EQ(count(svg, "<circle "), 4u) << "both seams are numbered on both sides";
    EXPECT_EQ(count(svg, "1  side &amp; &lt;hem&gt;"), 2u);
    EXPECT_EQ(count(svg, "font-weight=\"bold\">0<"), 2u);
    // To scale: the bottom of a panel is 400 mm long.
    const size_t outline = svg.find("stroke-linejoin");
    ASSERT_NE(outline, std::string::npos);
    double x = 0.0;
    double y = 0.0;
    double to_x = 0.0;
    double to_y = 0.0;
    const size_t data = svg.rfind("d=\"M", outline);
    ASSERT_EQ(std::sscanf(svg.c_str() + data, "d=\"M%lf,%lf L%lf,%lf", &x, &y, &to_x, &to_y), 4);
    EXPECT_NEAR(to_x - x, 400.0, 0.01);
    EXPECT_NEAR(to_y, y, 0.01);
}

/// Every pair of panels, by the boxes about their outlines, on sheets of many panels.
TEST_F(PatternShow, LaysPanelsOutSideBySide)
{
    const std::filesystem::path folder = std::filesystem::path(TOILE_DATA_DIR) / "patterns/garmentcode";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no patterns/garmentcode";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".json")
            continue;
        const std::string svg = drawing(entry.path().string());
        std::vector<Eigen::AlignedBox2d> boxes;
        for (size_t at = 0; (at = svg.find("fill=\"#fdf8ee\"", at)) != std::string::npos; ++at) {
            const size_t start = svg.rfind("d=\"", at) + 3;
            std::istringstream data(svg.substr(start, svg.find('"', start) - start));
            Eigen::AlignedBox2d box;
            for (std::string word; data >> word;) {
                double x = 0.0;
                double y = 0.0;
                const size_t number = word.find_first_of("0123456789-");
                if (word[0] != 'A' && number != std::string::npos &&
                    std::sscanf(word.c_str() + number, "%lf,%lf", &x, &y) == 2)
                    box.extend(Vec2(x, y));
            }
            for (const Eigen::AlignedBox2d& other : boxes)
                EXPECT_FALSE(box.intersects(other)) << entry.path();
            boxes.push_back(box);
        }
        EXPECT_GE(boxes.size(), 4u) << entry.path();
    }
}

TEST_F(PatternShow, RefusesBadInput)
{
    const auto complaint = [&](const std::vector<std::string>& arguments) {
        const Finished finished = show(arguments);
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_EQ(finished.error_lines(), 1);
        EXPECT_EQ(finished.output, "");
        return finished.errors;
    };
    EXPECT_EQ(complaint({"none.json"}),
              "toile: error: none.json: can't be opened; check the path and its permissions\n");
    EXPECT_EQ(complaint({"tube.json", "-o", "tube.json"}),
              "toile: error: tube.json: drawings are SVG; name a file that ends in .svg\n");
    EXPECT_EQ(complaint({"tube.json", "--jsn"}),
              "toile: error: unknown option --jsn; did you mean --json?\n");
    EXPECT_EQ(bytes_of(temporary_.path() / "tube.json"), tube());

    // A pattern under the name of a drawing stays.
    temporary_.write("pattern.svg", tube());
    EXPECT_NE(complaint({"pattern.svg", "-o", "pattern.svg"}).find("pattern.svg"), std::string::npos);
    EXPECT_EQ(bytes_of(temporary_.path() / "pattern.svg"), tube());

    const Finished unknown = run_toile({"pattern", "shwo"}, temporary_.path());
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_EQ(unknown.errors, "toile: error: unknown command \"shwo\"; did you mean \"show\"?\n");
    EXPECT_EQ(run_toile({"pattern"}, temporary_.path()).exit_code, 2);
    EXPECT_EQ(run_toile({"pattern", "show", "--help"}, temporary_.path()).exit_code, 0);
}

} // namespace
} // namespace toile::test
