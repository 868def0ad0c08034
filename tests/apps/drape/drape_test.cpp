#include <algorithm>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/mesh/obj.h"
#include "export/folder_lock.h"
#include "scenes/format/read_scene.h"
#include "tests/apps/program.h"

/// toile drape: what it writes, and what it refuses.
namespace toile::test {

namespace {

using Json = nlohmann::json;

/// Panel JSON of a tube of cloth around the mannequin's waist; sizes in metres.
/// @param size    width and height of its two panels
/// @param second  appended to the second stitch
std::string tube(double size = 0.6, const std::string& second = "")
{
    const auto panel = [&](const std::string& name, double z, bool is_back) {
        const std::string a = std::to_string(is_back ? 0.5 * size : -0.5 * size), s = std::to_string(size),
                          b = std::to_string(is_back ? -0.5 * size : 0.5 * size);
        return "\"" + name + R"(": {"vertices": [[)" + a + ", 0], [" + b + ", 0], [" + b + ", " + s + "], [" +
               a + ", " + s +
               R"(]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                  {"endpoints": [3, 0]}], "translation": [0, 0.7, )" +
               std::to_string(z) + "]}";
    };
    return R"({"pattern": {"panels": {)" + panel("front", 0.25, false) + ", " + panel("back", -0.25, true) +
           R"(}, "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1})" +
           second + R"(]]}, "properties": {"units_in_meter": 1, "curvature_coords": "relative"}})";
}

class Drape : public FileTest {
protected:
    Finished drape(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "drape");
        return run_toile(arguments, folder_);
    }

    /// The folder's files without the results of `drape`: refused, and unchanged.
    void expect_refusal(const std::vector<std::string>& arguments, const std::vector<std::string>& says) const
    {
        const auto before = temporary_.snapshot();
        const Finished finished = drape(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.errors;
        EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
        for (const std::string& part : says)
            EXPECT_NE(finished.errors.find(part), std::string::npos) << finished.errors;
        EXPECT_EQ(temporary_.snapshot(), before) << arguments.front();
    }

    Json json_in(const std::string& name) const { return Json::parse(bytes_of(file(name))); }

    /// The skirt goes around waist and hips, and around both thighs at once.
    void expect_fit_of_skirt(size_t vertices) const
    {
        const Json fit = json_in("out/fit.json")["garments"][0];
        EXPECT_EQ(fit["name"], "a_line_skirt");
        for (const Json& girth : fit["girths"]) {
            EXPECT_EQ(girth.contains("ease_m"), girth["key"] == "waist" || girth["key"] == "hips") << girth;
            if (girth.contains("ease_m")) {
                EXPECT_GT(girth["ease_m"], 0.0) << girth;
                EXPECT_NEAR(girth["garment_draped_m"], girth["garment_m"], 0.03) << girth;
            }
        }
        const std::string table = bytes_of(file("out/a_line_skirt_fit.csv"));
        EXPECT_EQ(size_t(std::count(table.begin(), table.end(), '\n')), vertices + 1);
        EXPECT_GT(fit["maps"][2]["min"], 0.0) << "no vertex is in the body";
        for (const char* map : {"tension", "strain", "gap"})
            EXPECT_EQ(bytes_of(file(std::string("out/a_line_skirt_") + map + ".png")).substr(1, 3), "PNG");
    }
};

/// Mean of the corners of some polygons [m]; the body looks along z.
double mean_z(const ObjMesh& mesh, int begin, int end)
{
    double sum = 0.0;
    int count = 0;
    for (int polygon = begin; polygon < end; ++polygon)
        for (const int corner : mesh.polygons[size_t(polygon)]) {
            sum += mesh.positions[size_t(corner)].z();
            ++count;
        }
    return sum / count;
}

/// One run of the script does all: it reads, meshes, drapes, simulates and certifies a skirt that walks off.
TEST_F(Drape, PassesTheAcceptanceOfASkirt)
{
    const std::string source = TOILE_SOURCE_DIR;
    const Finished script =
        run_shell("export TOILE EDGE=0.025 OUT=out\nbash " + source + "/tests/acceptance/drape.sh " + source +
                      "/assets/a_line_skirt.garment.json mannequin --clip walk",
                  folder_);
    ASSERT_EQ(script.exit_code, 0) << script.output << script.errors;
    EXPECT_EQ(std::count(script.output.begin(), script.output.end(), '\n'), 7) << script.output;

    const ObjMesh mesh = read_obj(file("out/a_line_skirt.obj"));
    ASSERT_EQ(mesh.groups.size(), 3u);
    EXPECT_EQ(mesh.groups[0].name, "front");
    EXPECT_EQ(mesh.groups[1].name, "back");
    EXPECT_EQ(mesh.groups[2].name, "band");
    EXPECT_GT(mean_z(mesh, mesh.groups[0].first_polygon, mesh.groups[1].first_polygon), 0.05);
    EXPECT_LT(mean_z(mesh, mesh.groups[1].first_polygon, mesh.groups[2].first_polygon), -0.05);

    const scenes::Scene scene = scenes::read_scene(file("out/scene.json"));
    EXPECT_EQ(scene.avatars.at(0).clip, "walk");
    EXPECT_TRUE(scene.avatars[0].preroll.from_bind);
    EXPECT_GE(scene.avatars[0].preroll.ease, 0.5);
    EXPECT_EQ(scene.attachments.size(), 1u) << "of the waist";
    EXPECT_EQ(scene.cloths.at(0).name, "a_line_skirt");
    EXPECT_NE(bytes_of(file("out/drape.err")).find("toile simulate out/scene.json -o out/simulated\n"),
              std::string::npos);

    const Json report = json_in("out/drape.json"), certificate = json_in("out/certificate.json");
    EXPECT_EQ(report["vertices"], mesh.positions.size());
    EXPECT_EQ(certificate["cloths"][0]["vertices"], mesh.positions.size());
    EXPECT_EQ(certificate["frames"], 1);
    EXPECT_EQ(report["seams"].size(), 4u);
    for (const Json& seam : report["seams"]) {
        EXPECT_NEAR(seam["ratio"], seam["name"] == "seams[0]" ? 1.05 : 1.0, 0.001) << "as the garment says";
        EXPECT_LT(seam["gap_before_weld_m"], 0.002);
    }
    int steps = 0;
    for (const Json& stage : report["stages"])
        steps += stage["steps"].get<int>();
    EXPECT_GT(steps, 100);

    // No triangle of the skirt is attached at all corners, so that the certificate measures all of them.
    const Json& strain = report["strain"]["cotton"];
    EXPECT_NEAR(strain["max"], certificate["max_strain"], 1e-6);
    EXPECT_LT(strain["p99"], strain["max"]);
    EXPECT_LT(strain["mean"], strain["p99"]);
    EXPECT_GE(report["uv_distortion"]["l2_stretch"], 1.0);
    EXPECT_LT(report["uv_distortion"]["l2_stretch"], 1.001);

    expect_fit_of_skirt(mesh.positions.size());

    const std::string png = bytes_of(file("out/a_line_skirt.png"));
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x02\xd0\0\0\x03\xc0", 8)) << "720 x 960";
}

/// The files of a garment are named by it, those of the outfit by all. One of the same name gets a number.
TEST_F(Drape, WritesSeveralGarments)
{
    temporary_.write("tube.json", tube());
    const Finished finished = drape({"tube.json", "tube.json", "--edge", "0.05", "--fabric", "denim,jersey",
                                     "--time-limit", "0.001", "-o", "out", "--quiet"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.errors.find("the time limit of 0.001 s"), std::string::npos) << finished.errors;
    EXPECT_TRUE(std::filesystem::exists(file("out/tube.obj")));
    EXPECT_FALSE(std::filesystem::exists(file("out/tube_2.obj"))) << "not begun";
    EXPECT_TRUE(std::filesystem::exists(file("out/tube_tube_2.png")));
    const Json report = json_in("out/drape.json");
    ASSERT_EQ(report["garments"].size(), 1u);
    EXPECT_EQ(report["garments"][0]["name"], "tube");
    EXPECT_TRUE(report["garments"][0]["strain"].contains("denim"));

    expect_refusal({"tube.json", "tube.json", "--fabric", "denim,jersey,cotton"},
                   {"--fabric: names 3 fabrics for 2 garments; give one for all or one for each"});
    expect_refusal({"tube.json", "--fabric", "denim,jersey"}, {"--fabric: names 2 fabrics for 1 garment;"});
    expect_refusal({"tube.json", "--shift", "nan,0,0"}, {"--shift nan: must be three numbers from -1000"});
    expect_refusal({"tube.json", "--fabric", "denim,jersy"}, {"--fabric", "did you mean \"jersey\"?"});
}

/// A panel in a fabric of its own: strain is reported by fabric, and the written scene has both.
TEST_F(Drape, KeepsTheFabricsOfPanels)
{
    temporary_.write("tube.panels.json", tube(0.5));
    temporary_.write("tube.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "tube.panels.json"}],
        "panels": {"back": {"fabric": "denim"}},
        "elastics": [{"edges": ["front.2", "back.2"], "ratio": 0.6, "stiffness": 40}]})");
    const Finished finished =
        drape({"tube.garment.json", "--edge", "0.04", "--fabric", "jersey", "-o", "out", "--quiet"});
    ASSERT_EQ(finished.exit_code, 0) << finished.errors;
    const scenes::Scene scene = scenes::read_scene(file("out/scene.json"));
    EXPECT_EQ(scene.cloths.at(0).fabric, "jersey");
    ASSERT_EQ(scene.cloths[0].groups.size(), 1u);
    EXPECT_EQ(scene.cloths[0].groups.at("back").fabric, "denim");
    const Json strain = json_in("out/drape.json")["strain"];
    EXPECT_EQ(strain.size(), 2u);
    EXPECT_EQ(strain["denim"]["max_panel"], "back");
    EXPECT_EQ(strain["jersey"]["max_panel"], "front");
}

TEST_F(Drape, EndsAtItsTimeLimitWithItsLastState)
{
    temporary_.write("tube.json", tube());
    std::filesystem::create_directory(file("out"));
    const std::vector<std::string> earlier{"out/certificate.json", "out/scene.json", "out/fit.json",
                                           "out/tube_fit.csv", "out/tube_gap.png"};
    for (const std::string& name : earlier)
        temporary_.write(name, "of an earlier drape");
    const Finished finished =
        drape({"tube.json", "--edge", "0.05", "--time-limit", "0.001", "-o", "out", "--quiet"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
    EXPECT_NE(finished.errors.find("the time limit of 0.001 s"), std::string::npos) << finished.errors;
    const Json report = json_in("out/drape.json");
    EXPECT_TRUE(report["class"] == "tangled" || report["class"] == "meshing") << report["class"];
    for (const std::string& name : earlier)
        EXPECT_FALSE(std::filesystem::exists(file(name))) << name;
    if (report["class"] == "meshing")
        return;
    EXPECT_EQ(read_obj(file("out/tube.obj")).groups.size(), 2u);
    EXPECT_TRUE(std::filesystem::exists(file("out/tube.png")));
}

TEST_F(Drape, ReportsWhatIsWrongWithTheInput)
{
    temporary_.write("broken.json", tube().substr(0, 300));
    temporary_.write("far.json", tube(20.0));
    temporary_.write("moebius.json", tube(0.6, ", \"right_wrong\""));
    temporary_.write("large.json", tube(3.0));
    struct Case {
        const char *garment, *edge, *word, *says;
    };
    for (const Case& wrong : {Case{"broken.json", "0.02", "pattern", "not valid JSON"},
                              Case{"far.json", "0.02", "pattern", "far.json"},
                              Case{"moebius.json", "0.02", "seams", "remove \"right_wrong\""},
                              Case{"large.json", "0.0005", "meshing", "large.json"}}) {
        const Finished finished = drape({wrong.garment, "--edge", wrong.edge, "-o", "out"});
        EXPECT_EQ(finished.exit_code, 2) << finished.errors;
        EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
        const Json report = json_in("out/drape.json");
        EXPECT_EQ(report["class"], wrong.word) << finished.errors;
        const std::string message = report["message"];
        EXPECT_NE(message.find(wrong.says), std::string::npos) << message;
        EXPECT_NE(finished.errors.find(message), std::string::npos) << finished.errors;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("out")), {}), 1) << "drape.json only";
    expect_refusal({"broken.json", "-o", "/proc/nowhere"}, {"not valid JSON"});
}

TEST_F(Drape, RefusesOptionsBeforeAnythingIsWritten)
{
    temporary_.write("tube.json", tube());
    expect_refusal({"tube.json", "--fabric", "cottn"}, {"--fabric", "did you mean \"cotton\"?"});
    expect_refusal({"tube.json", "--edge", "0"}, {"--edge 0", "0.0005"});
    expect_refusal({"tube.json", "--edge", "nan"}, {"--edge nan"});
    expect_refusal({"tube.json", "--time-limit", "0"}, {"--time-limit 0", "positive"});
    expect_refusal({"tube.json", "--time-limt", "5"}, {"did you mean --time-limit?"});
    expect_refusal({"tube.json", "--clip", "wolk"}, {"mannequin", "did you mean 'walk'?", "'turn'"});
    expect_refusal({"tube.json", "--map", "cmu"}, {"--map", "--motion"});
    expect_refusal({"tube.json", "--motion", "none.bvh"}, {"none.bvh: no such file"});
    expect_refusal({"none.json"}, {"none.json"});
}

TEST_F(Drape, LeavesAFolderToTheRunThatHasIt)
{
    temporary_.write("tube.json", tube());
    const exports::FolderLock lock(file("out"));
    expect_refusal({"tube.json", "-o", "out"}, {"out: another run"});
}

TEST_F(Drape, ReplacesNothingThatItReads)
{
    const std::string body = "v 0 -1 0\nv 0 -1 9\nv 9 -1 9\nf 1 2 3\n";
    std::filesystem::create_directories(file("stages/deep"));
    std::filesystem::create_directories(file("m"));
    for (const char* name : {"drape.json", "scene.json", "stages/deep/tube.json"})
        temporary_.write(name, tube());
    for (const char* name : {"drape.obj", "stages/body.obj"})
        temporary_.write(name, body);
    temporary_.write("g.garment.json", R"({"toile_garment": 1, "patterns": [{"file": "scene.json"}]})");
    temporary_.write("c.gltf",
                     R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "tube.png"}]})");
    temporary_.write("tube.png", "abcd");
    temporary_.write("tube.json", tube());

    expect_refusal({"drape.json", "-o", "."}, {"drape.json", "the pattern"});
    expect_refusal({"g.garment.json", "-o", "."}, {"scene.json", "the pattern"});
    expect_refusal({"stages/deep/tube.json", "-o", "."}, {"stages", "the pattern"});
    expect_refusal({"scene.json", "-o", "out", "--avatar", "none.obj"}, {"none.obj"});
    expect_refusal({"drape.json", "-o", "x/..", "--avatar", "drape.obj"}, {"drape."});
    expect_refusal({"tube.json", "-o", ".", "--avatar", "stages/body.obj"}, {"stages", "the avatar"});
    expect_refusal({"tube.json", "-o", ".", "--avatar", "c.gltf"}, {"tube.png", "a part of the avatar"});

    temporary_.write("m/tube.obj", "a motion");
    expect_refusal({"tube.json", "-o", "m", "--motion", "m/tube.obj"}, {"tube.obj", "the motion"});

    // A garment that can't be read may name a file that is called like the report.
    temporary_.write("h.garment.json",
                     R"({"toile_garment": 1, "patterns": [{"file": "drape.json"}], "x": 1})");
    expect_refusal({"h.garment.json", "-o", "."}, {"h.garment.json"});
}

} // namespace
} // namespace toile::test
