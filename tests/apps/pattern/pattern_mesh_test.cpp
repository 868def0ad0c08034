#include <array>
#include <tuple>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/mesh/obj.h"
#include "core/mesh/topology.h"
#include "tests/apps/program.h"

/// toile pattern mesh: what it writes, prints and refuses; toile info on what it wrote.
namespace toile::test {

namespace {

using Json = nlohmann::json;

/// Panel JSON of a tube of 40 x 60 cm with a strip of 6 mm along one side: front 20 cm before the axis, back
/// behind it. `third` follows the edges of the first stitch.
std::string tube(const std::string& third = "")
{
    const auto rectangle = [](const std::string& name, const std::string& place, const std::string& width) {
        return "\"" + name + "\": {" + place + R"(, "vertices": [[0, 0], [)" + width + ", 0], [" + width +
               R"(, 60], [0, 60]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
               {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
    };
    return R"({"properties": {"units_in_meter": 100}, "pattern": {"panels": {)" +
           rectangle("front", R"("translation": [-20, 0, 20])", "40") + ", " +
           rectangle("back", R"("translation": [20, 0, -20], "rotation": [0, 180, 0])", "40") + ", " +
           rectangle("strip", R"("translation": [20, 0, 20], "rotation": [0, 90, 0])", "0.6") +
           R"(}, "stitches": [
        [{"panel": "front", "edge": 1}, {"panel": "strip", "edge": 3})" +
           third + R"(],
        [{"panel": "strip", "edge": 1}, {"panel": "back", "edge": 3}],
        [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]]}})";
}

class PatternMesh : public FileTest {
protected:
    PatternMesh()
    {
        temporary_.write("tube.json", tube());
        temporary_.write("moebius.json", tube(", \"right_wrong\""));
    }

    Finished mesh(const std::vector<std::string>& arguments) const
    {
        std::vector<std::string> words{"pattern", "mesh"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        return run_toile(words, temporary_.path());
    }

    Json json_of(std::vector<std::string> arguments, int exit_code = 0) const
    {
        arguments.emplace_back("--json");
        const Finished finished = mesh(arguments);
        EXPECT_EQ(finished.exit_code, exit_code) << finished.errors;
        return Json::parse(finished.output);
    }

    std::string info(const std::string& file) const
    {
        return run_toile({"info", file}, temporary_.path()).output;
    }
};

void expect_part(const std::string& text, const std::string& part)
{
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin:\n" << text;
}

TEST_F(PatternMesh, PrintsPanelsSeamsAndTheSewnSurface)
{
    const Finished finished = mesh({"tube.json", "--edge", "0.02"});
    EXPECT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_EQ(finished.errors, "");
    EXPECT_EQ(finished.output.find("tube.json: 3 panels, "), 0u) << finished.output;
    expect_part(finished.output, "panel front: ");
    expect_part(finished.output, ", target 0.02 m, smallest angle ");
    expect_part(finished.output, " % of edges within 0.6 to 1.6 of the target\n");
    // 3 x 0.006 x 0.6 / 1.212: the strip is narrower than 2 cm.
    expect_part(finished.output,
                ", target 0.00891 m instead of 0.02 m, because the panel is narrow, smallest angle ");
    // 60 cm at 8.91 mm are 68 intervals, at 2 cm 30.
    expect_part(finished.output, "seam 0: front.1 to strip.3, 69 pairs\n");
    expect_part(finished.output, "seam 2: front.3 to back.1, 31 pairs\n");
    expect_part(finished.output, ", 1 piece, 2 border loops, Euler characteristic 0, orientable, manifold\n");
    expect_part(finished.output, "class: ok\n");
    EXPECT_EQ(finished.output.find("twisted"), std::string::npos);
}

TEST_F(PatternMesh, PrintsTheSameAsJson)
{
    const Json json = json_of({"tube.json", "--edge", "0.02"});
    EXPECT_EQ(json["class"], "ok");
    ASSERT_EQ(json["panels"].size(), 3u);
    int vertices = 0, triangles = 0;
    for (const Json& panel : json["panels"]) {
        vertices += int(panel["vertices"]);
        triangles += int(panel["triangles"]);
        EXPECT_EQ(panel["asked_edge_m"], 0.02);
        EXPECT_GE(panel["smallest_angle_deg"], json["smallest_angle_deg"]);
        EXPECT_GE(panel["in_range"], 0.9);
    }
    const Json& strip = json["panels"][2];
    EXPECT_EQ(strip["name"], "strip");
    EXPECT_NEAR(double(strip["edge_m"]), 3.0 * 0.006 * 0.6 / 1.212, 1e-9);
    EXPECT_EQ(json["panels"][0]["edge_m"], 0.02);
    EXPECT_EQ(json["vertices"], vertices);
    EXPECT_EQ(json["triangles"], triangles);
    EXPECT_EQ(json["seams"][0]["pairs"], 69);
    EXPECT_EQ(json["seams"][0]["twisted"], false);
    EXPECT_EQ(json["sewn"]["vertices"], vertices - 69 - 69 - 31);
    EXPECT_EQ(json["sewn"]["pieces"], 1);
    EXPECT_EQ(json["sewn"]["border_loops"], 2);
    EXPECT_EQ(json["sewn"]["euler_characteristic"], 0);
    EXPECT_EQ(json["sewn"]["orientable"], true);
    EXPECT_EQ(json["sewn"]["one_sided_seam"], nullptr);
    EXPECT_EQ(json["sewn"]["non_manifold_edges"], 0);
}

TEST_F(PatternMesh, WritesPanelsWhereTheyStartWithTextureGroupsAndLines)
{
    const Json json = json_of({"tube.json", "--edge", "0.02", "-o", "out/tube.obj"});
    const ObjMesh obj = read_obj(temporary_.path() / "out/tube.obj");
    EXPECT_EQ(obj.positions.size(), size_t(json["vertices"]));
    EXPECT_EQ(obj.polygons.size(), size_t(json["triangles"]));
    EXPECT_EQ(obj.lines.size(), 69u + 69u + 31u);
    ASSERT_EQ(obj.groups.size(), 3u);
    EXPECT_EQ(obj.groups[1].name, "front");
    EXPECT_EQ(obj.groups[1].first_polygon, int(json["panels"][0]["triangles"]));
    ASSERT_EQ(obj.polygon_uvs, obj.polygons);
    const size_t first = json["panels"][0]["vertices"], count = json["panels"][1]["vertices"];
    for (size_t v = first; v < first + count; ++v) {
        const Vec2& uv = obj.texture_coordinates[v];
        EXPECT_LT((obj.positions[v] - Vec3(uv.x() - 0.2, uv.y(), 0.2)).norm(), 1e-8);
    }
    // Nothing is sewn yet.
    EXPECT_EQ(surface_topology(obj.triangulated().triangles).pieces, 3);
}

TEST_F(PatternMesh, WritesTheSameBytesTwice)
{
    const Finished once = mesh({"tube.json", "-o", "a.obj"}), again = mesh({"tube.json", "-o", "b.obj"});
    EXPECT_EQ(once.output, again.output);
    EXPECT_EQ(bytes_of(temporary_.path() / "a.obj"), bytes_of(temporary_.path() / "b.obj"));
}

TEST_F(PatternMesh, TakesTheTargetsOfAGarmentFile)
{
    temporary_.write("t.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}],
        "panels": {"front": {"edge": 0.05}}})");
    const Json json = json_of({"t.garment.json", "--edge", "0.02"});
    EXPECT_EQ(json["panels"][0]["edge_m"], 0.02);
    EXPECT_EQ(json["panels"][1]["edge_m"], 0.05);
}

TEST_F(PatternMesh, WritesAOneSidedSurfaceAndExitsWith1)
{
    const Finished text = mesh({"moebius.json", "--edge", "0.02", "-o", "moebius.obj"});
    EXPECT_EQ(text.exit_code, 1);
    expect_part(text.output, ", one-sided by seam 0, manifold\n");
    expect_part(text.output, "; in pattern.stitches[0]: remove \"right_wrong\" from it\nclass: seams\n");
    EXPECT_EQ(text.errors,
              "toile: error: moebius.json: class seams: seam 0 makes the sewn surface one-sided; in "
              "pattern.stitches[0]: remove \"right_wrong\" from it\n");
    EXPECT_EQ(read_obj(temporary_.path() / "moebius.obj").groups.size(), 3u);

    const Json json = json_of({"moebius.json"}, 1);
    EXPECT_EQ(json["class"], "seams");
    EXPECT_EQ(json["sewn"]["orientable"], false);
    EXPECT_EQ(json["sewn"]["one_sided_seam"], 0);
    EXPECT_EQ(json["seams"][0]["mend"], "pattern.stitches[0]: remove \"right_wrong\" from it");
}

TEST_F(PatternMesh, IsDescribedByInfo)
{
    ASSERT_EQ(mesh({"tube.json", "--edge", "0.02", "-o", "tube.obj"}).exit_code, 0);
    const std::string text = info("tube.obj");
    expect_part(text, "groups: 3 (back, front, strip)\n");
    expect_part(text, "lines: 169\n");
    expect_part(text, "pieces: 3\nborder loops: 3\nEuler characteristic: 3\n");
}

/// Panels survive the cleaning of a mesh: here a face of the left one comes twice.
TEST_F(PatternMesh, KeepsPanelsAndStitchesInARun)
{
    temporary_.write(
        "squares.obj",
        "v 0 0 0\nv 0.1 0 0\nv 0.1 0 0.1\nv 0 0 0.1\nv 0.2 0 0\nv 0.3 0 0\nv 0.3 0 0.1\nv 0.2 0 0.1\n"
        "g left\nf 1 4 3 2\nf 1 2 3 4\ng right\nf 5 8 7 6\nl 2 5\nl 3 8\n");
    for (const auto& [name, subdivide, right] : {std::tuple{"plain", "0", 1}, {"fine", "1", 8}}) {
        const std::string scene = std::string(name) + ".json";
        temporary_.write(scene, R"({"toile": 1, "frames": 2, "cloths": [{"name": ")" + std::string(name) +
                                    R"(", "file": "squares.obj", "sewing": {}, "subdivide": )" + subdivide +
                                    "}]}");
        const Finished run = run_toile({"simulate", scene, "-o", ".", "--quiet"}, temporary_.path());
        ASSERT_EQ(run.exit_code, 0) << run.errors;
        const ObjMesh mesh = read_obj(temporary_.path() / (std::string(name) + ".obj"));
        EXPECT_EQ(mesh.groups, (std::vector<ObjGroup>{{0, "left"}, {right, "right"}})) << name;
        EXPECT_EQ(mesh.lines, (std::vector<std::array<int, 2>>{{1, 4}, {2, 7}})) << name;
    }
}

TEST_F(PatternMesh, RefusesBadInput)
{
    const auto complaint = [&](const std::vector<std::string>& arguments) {
        const Finished finished = mesh(arguments);
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_EQ(finished.error_lines(), 1);
        EXPECT_EQ(finished.output, "");
        return finished.errors;
    };
    EXPECT_EQ(complaint({"none.json"}),
              "toile: error: none.json: can't be opened; check the path and its permissions\n");
    EXPECT_EQ(complaint({"tube.json", "-o", "tube.json"}),
              "toile: error: tube.json: meshes are OBJ; name a file that ends in .obj\n");
    for (const char* edge : {"0", "-0.01", "2", "1e-9", "nan"})
        EXPECT_NE(complaint({"tube.json", "--edge", edge, "-o", "x.obj"})
                      .find(": is out of range; give a length from 0.0005 to 1 m\n"),
                  std::string::npos)
            << edge;
    EXPECT_FALSE(std::filesystem::exists(temporary_.path() / "x.obj"));

    // A pattern under the name of a mesh stays.
    temporary_.write("pattern.obj", tube());
    EXPECT_NE(complaint({"pattern.obj", "-o", "pattern.obj"}).find("pattern.obj"), std::string::npos);
    EXPECT_EQ(bytes_of(temporary_.path() / "pattern.obj"), tube());
}

} // namespace
} // namespace toile::test
