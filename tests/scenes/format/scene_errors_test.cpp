#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Error of the reader about a text; "accepted" if there is none.
std::string complaint(const std::string& text)
{
    try {
        static_cast<void>(parse_scene(text, "bad.json"));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "accepted";
}

/// Scene with one disc, the given keys on top and in the disc's entry.
std::string scene_with(const std::string& top, const std::string& cloth = "")
{
    return R"({"toile": 1, "frames": 1, )" + (top.empty() ? "" : top + ", ") +
           R"("cloths": [{"name": "sheet", "disc": {})" + (cloth.empty() ? "" : ", " + cloth) + "}]}";
}

std::string avatar_scene(const std::string& avatar) { return scene_with(R"("avatars": [{)" + avatar + "}]"); }

struct Mistake {
    std::string text;
    std::string message;
};

void expect_complaints(const std::vector<Mistake>& mistakes)
{
    for (const Mistake& mistake : mistakes) {
        const std::string said = complaint(mistake.text);
        EXPECT_EQ(said, mistake.message) << mistake.text;
        EXPECT_EQ(said.find('\n'), std::string::npos) << "more than one line";
    }
}

TEST(SceneErrors, GiveLineAndColumnOfASyntaxError)
{
    expect_complaints({
        {"{\n  \"toile\": 1,\n  \"frames\": }",
         "bad.json:3:13: not valid JSON: syntax error while parsing value "
         "- unexpected '}'; expected '[', '{', or a literal"},
        {"", "bad.json:1:1: not valid JSON: syntax error while parsing value - unexpected end of input; "
             "expected '[', '{', or a literal"},
        {R"({"toile": 1, "toile": 1})",
         R"(bad.json: the key "toile" is given twice in one object; keep one of them)"},
        {"// a scene\n{}",
         R"(bad.json:1:1: not valid JSON: JSON has no comments; remove them, or write a "description")"},
        {"{/* a scene */}",
         R"(bad.json:1:2: not valid JSON: JSON has no comments; remove them, or write a "description")"},
        {"{\"toile\": 1,\n}", "bad.json:2:1: not valid JSON: a comma stands before }; remove it"},
        {R"({"cloths": [1, ]})", "bad.json:1:16: not valid JSON: a comma stands before ]; remove it"},
        {std::string("\xff\xfe{\0}\0", 6), "bad.json:1:1: not valid JSON: it is in UTF-16; save it in UTF-8"},
        {"{\"\xff\": 1}",
         "bad.json:1:3: not valid JSON: syntax error while parsing object key - invalid string: "
         "ill-formed UTF-8 byte; last read: '\"?'; expected string literal"},
    });
}

TEST(SceneErrors, TellPatternsFromScenes)
{
    const std::string message =
        "bad.json: is a sewing pattern, not a scene; look at it with toile pattern show";
    expect_complaints(
        {{R"({"toile_garment": 1, "patterns": []})", message}, {R"({"pattern": {}})", message}});
}

/// Paths as shells, Windows and browsers have them.
TEST(SceneErrors, SayHowPathsAreWritten)
{
    const auto file = [](const std::string& path) {
        return R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "file": ")" + path + "\"}]}";
    };
    const std::string variables = "~ and variables are not expanded, except ${TOILE_DATA_DIR}";
    for (const auto& [path, remedy] : std::vector<std::pair<std::string, std::string>>{
             {"none.obj", "paths are relative to the folder of the file that names them"},
             {"~/none.obj", variables},
             {"$HOME/none.obj", variables},
             {R"(a b\\none.obj)", "write / between folders, also for Windows"},
             {R"(C:\\none.obj)", "write / between folders, also for Windows"}}) {
        std::string message = "bad.json: cloths[0].file: the file \"";
        message.append(path).append("\" does not exist; ").append(remedy);
        expect_complaints({{file(path), message}});
    }
}

/// Editors complete and check by it.
TEST(SceneErrors, AllowTheNameOfTheSchema)
{
    EXPECT_EQ(complaint(scene_with(R"("$schema": "toile.schema.json")")), "accepted");
    EXPECT_NE(complaint(scene_with("", R"("$schema": "toile.schema.json")")), "accepted");
}

TEST(SceneErrors, NameTheNearestKnownKey)
{
    expect_complaints({
        {scene_with("", R"("fabrc": "silk")"),
         R"(bad.json: cloths[0].fabrc: unknown key; did you mean "fabric"?)"},
        {scene_with(R"("solver": {"sleep": {"sped": 1}})"),
         R"(bad.json: solver.sleep.sped: unknown key; did you mean "speed"?)"},
        {scene_with(R"("solver": {"sleep": {"qqqqqqqqqq": 1}})"),
         "bad.json: solver.sleep.qqqqqqqqqq: unknown key; known are enabled and speed"},
        {scene_with(R"("fabrics": {"felt": {"stretch": {"wrap": 1}}})"),
         R"(bad.json: fabrics.felt.stretch.wrap: unknown key; did you mean "warp"?)"},
    });
}

TEST(SceneErrors, NameMissingAndExclusiveKeys)
{
    expect_complaints({
        {R"({"frames": 1, "cloths": []})", R"(bad.json: the key "toile" is missing; add it)"},
        {R"({"toile": 1, "frames": 1})",
         "bad.json: cloths: nothing to simulate; add a cloth, a solid or a soft body"},
        {R"({"toile": 1, "frames": 1, "cloths": []})",
         "bad.json: cloths: nothing to simulate; add a cloth, a solid or a soft body"},
        {R"({"toile": 2, "frames": 1, "cloths": []})",
         "bad.json: toile: 2 is a version of the format that this program does not know; write 1"},
        {R"({"toile": 1, "frames": 1, "cloths": [{"name": "a"}]})",
         "bad.json: cloths[0]: none of file, rectangle, disc and skirt is given; give exactly one of file, "
         "rectangle, disc or skirt"},
        {scene_with("", R"("rectangle": {})"), "bad.json: cloths[0]: rectangle and disc exclude each other; "
                                               "give exactly one of file, rectangle, disc "
                                               "or skirt"},
    });
}

TEST(SceneErrors, GiveTheAllowedRangeOfANumber)
{
    expect_complaints({
        {R"({"toile": 1, "frames": 0, "cloths": []})",
         "bad.json: frames: 0 is out of range; give a number from 1 to 1000000"},
        {R"({"toile": 1, "frames": 1.5, "cloths": []})",
         "bad.json: frames: 1.5 is not a whole number; give one from 1 to 1000000"},
        {R"({"toile": 1, "frames": 1e400, "cloths": []})",
         "bad.json:1:24: 1e400 is out of range; give a smaller number"},
        {R"({"toile": 1, "frames": 99999999999999999999, "cloths": []})",
         "bad.json: frames: 1e+20 is out of range; give a number from 1 to 1000000"},
        {scene_with(R"("solver": {"tolerance": 0})"),
         "bad.json: solver.tolerance: 0 is out of range; give a number above 0 and at most 0.01 m"},
        {scene_with(R"("gravity": [0, "down", 0])"),
         R"(bad.json: gravity[1]: "down" is not a number; give a number from -1000 to 1000 m/s^2)"},
        {scene_with(R"("gravity": -9.81)"),
         "bad.json: gravity: -9.81 is not a list of 3 numbers; write [x, y, z]"},
        {scene_with("", R"("color": [1, 1, 255])"),
         "bad.json: cloths[0].color[2]: 255 is out of range; give a number from 0 to 1"},
        {scene_with(R"("fabrics": {"felt": {"bend": {"warp": -1}}})"),
         "bad.json: fabrics.felt.bend.warp: -1 is out of range; give a number from 0 to 1 N m"},
        {scene_with(R"("render": {"ground": "none"})"),
         R"(bad.json: render.ground: "none" is neither a number nor "off"; give a number from -1000 to 1000 m)"},
    });
}

TEST(SceneErrors, NameTheExpectedType)
{
    expect_complaints({
        {"[]",
         "bad.json: [] is not an object; write {...} with keys among toile, name, description, frames, fps, "
         "gravity, wind, air, settle, avatars, cloths, solids, soft_bodies, fabrics, attachments, contact, "
         "solver, export "
         "and render"},
        {scene_with(R"("name": 3)"), "bad.json: name: 3 is not text; write it in double quotes"},
        {scene_with(R"("avatars": {})"), "bad.json: avatars: {} is not a list; write [...]"},
        {scene_with(R"("fabrics": [])"), R"(bad.json: fabrics: [] is not an object; write {"name": {...}})"},
        {scene_with(R"("solver": {"sleep": {"enabled": 1}})"),
         "bad.json: solver.sleep.enabled: 1 is neither true nor false; write one of the two"},
        {scene_with("", R"("unit": "ft")"),
         R"(bad.json: cloths[0].unit: "ft" is unknown; write "m", "cm", "mm" or "in")"},
    });
}

TEST(SceneErrors, RefuseAvatarsThatContradictThemselves)
{
    expect_complaints({
        {avatar_scene(R"("name": "fixed", "sphere": {})"),
         R"(bad.json: avatars[0].name: "fixed" stands for the world in attachments; choose another name)"},
        {avatar_scene(R"("name": "a", "sphere": {}, "clip": "walk")"),
         "bad.json: avatars[0].clip: a shape has no clips; move it with keyframes"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "speed": 2)"),
         "bad.json: avatars[0].speed: has no effect without a clip; name the clip to play"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "clip": "walk", "keyframes": [{"time": 0}])"),
         "bad.json: avatars[0].keyframes: an animated avatar is not moved by keyframes; remove them or the "
         "clip"},
        {avatar_scene(R"("name": "a", "box": {}, "unit": "cm")"),
         "bad.json: avatars[0].unit: only a file has a unit; lengths here are in metres"},
        {avatar_scene(R"("name": "a", "box": {}, "keyframes": [{"time": 1}, {"time": 1}])"),
         "bad.json: avatars[0].keyframes[1].time: 1.0 s does not follow 1.0 s; put keyframes in ascending "
         "order "
         "of time"},
        {avatar_scene(R"("name": "a", "file": "body.stl")"),
         R"(bad.json: avatars[0].file: "body.stl" is of an unknown format; use .glb, .gltf, .fbx, .obj or a cache )"
         R"((.abc, .usda, .usdc, .pc2, .mdd, or a sequence of .obj or .ply))"},
        {avatar_scene(R"("name": "a", "box": {}, "motion": {"file": "walk.bvh"})"),
         "bad.json: avatars[0].motion: a shape has no clips; move it with keyframes"},
        {avatar_scene(R"("name": "a", "file": "body.obj", "motion": {"file": "walk.bvh"})"),
         "bad.json: avatars[0].motion: an .obj body has no bones; use a .glb, .gltf or .fbx body"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "clip": "walk", "motion": {"file": "walk.bvh"})"),
         "bad.json: avatars[0].motion: excludes clip; remove one of them"},
        {avatar_scene(
             R"("name": "a", "mannequin": {}, "motion": {"file": "walk.bvh"}, "keyframes": [{"time": 0}])"),
         "bad.json: avatars[0].keyframes: an animated avatar is not moved by keyframes; remove them or the "
         "clip"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "motion": {"clip": "walk"})"),
         R"(bad.json: avatars[0].motion: the key "file" is missing; add it)"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "motion": {"file": "walk.mdd"})"),
         R"(bad.json: avatars[0].motion.file: "walk.mdd" is of an unknown format; use .bvh, .fbx, .glb or .gltf)"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "motion": {"file": "walk.bvh", "map": "cmuu"})"),
         R"(bad.json: avatars[0].motion.map: "cmuu" is unknown; write "names", "cmu" or the path of a .json file; )"
         R"(did you mean "cmu"?)"},
        {avatar_scene(R"("name": "a", "mannequin": {}, "motion": {"file": "none.bvh", "map": "cmu"})"),
         "bad.json: avatars[0].motion.file: the file \"none.bvh\" does not exist; paths are relative to the "
         "folder "
         "of the file that names them"},
        {scene_with(R"("avatars": [{"name": "a", "box": {}}, {"name": "a", "sphere": {}}])"),
         R"(bad.json: avatars[1].name: "a" is taken by an earlier entry; choose another name)"},
    });
}

TEST(SceneErrors, RefuseImpossibleCloths)
{
    expect_complaints({
        {R"({"toile": 1, "frames": 1, "cloths": [{"name": "../a", "disc": {}}]})",
         R"(bad.json: cloths[0].name: "../a" can't name a file; use letters, digits, _ and -)"},
        {R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "rectangle": {"size": [50, 50], "resolution": 0.001}}]})",
         "bad.json: cloths[0]: resolution and subdivide make more than 5 million vertices; choose a coarser "
         "resolution"},
        {R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "skirt": {"waist_radius": 0.25, "hem_radius": 1, "length": 0.5}}]})",
         "bad.json: cloths[0].skirt.hem_radius: 1.0 m does not fit the cloth; give a radius from 0.25 "
         "(waist_radius) to 0.75 (waist_radius + length)"},
        {scene_with("", R"("fabric": "coton")"),
         R"(bad.json: cloths[0].fabric: no fabric is named "coton"; did you mean "cotton"?)"},
        {scene_with(R"("fabrics": {"felt": {"base": "wol"}})"),
         R"(bad.json: fabrics.felt.base: no preset is named "wol"; did you mean "wool"?)"},
    });
    EXPECT_NE(complaint(scene_with(R"("fabrics": {"felt": {"shear": 1e6}})", R"("fabric": "felt")"))
                  .find("at most half of the smaller stretch modulus"),
              std::string::npos);
}

TEST(SceneErrors, RefuseAttachmentsToUnknownObjects)
{
    const auto attachment = [](const std::string& keys) {
        return scene_with(R"("avatars": [{"name": "ball", "sphere": {}}], "attachments": [{)" + keys + "}]");
    };
    const std::string first = R"("select": {"vertices": [0]})";
    expect_complaints({
        {attachment(R"("cloth": "sheat", )" + first),
         R"(bad.json: attachments[0].cloth: no cloth is named "sheat"; did you mean "sheet"?)"},
        {attachment(R"("cloth": "sheet", "to": "bal", )" + first),
         R"(bad.json: attachments[0].to: no avatar is named "bal"; did you mean "ball"?)"},
        {attachment(R"("cloth": "sheet", "to": "qqqqqqqq", )" + first),
         R"(bad.json: attachments[0].to: no avatar is named "qqqqqqqq"; known are ball and fixed)"},
        {attachment(R"("cloth": "sheet", "to": "ball", "keyframes": [{"time": 0}], )" + first),
         R"(bad.json: attachments[0].keyframes: an avatar moves these vertices already; remove the keyframes or write "to": "fixed")"},
        {attachment(R"("cloth": "sheet", "select": {"vertices": []})"),
         "bad.json: attachments[0].select.vertices: the list is empty; name at least one or remove the "
         "attachment"},
        {attachment(R"("cloth": "sheet", "select": {"box": {"lower": [0, 1, 0], "upper": [1, 0, 1]}})"),
         "bad.json: attachments[0].select.box: a coordinate of lower exceeds that of upper; exchange them"},
        {attachment(R"("cloth": "sheet", "select": {"all_within": {"avatar": "bll", "distance": 1}})"),
         R"(bad.json: attachments[0].select.all_within.avatar: no avatar is named "bll"; did you mean "ball"?)"},
        {attachment(R"("cloth": "sheet", "select": {})"),
         "bad.json: attachments[0].select: none of vertices, box, nearest and all_within is given; give "
         "exactly "
         "one of vertices, box, nearest or all_within"},
    });
}

TEST(SceneErrors, KeepExportsInsideTheOutputFolder)
{
    const auto with_render = [](const std::string& entry) {
        return scene_with(R"("soft_bodies": [{"name": "jelly", "file": "a.msh", "render": "a.obj"}],
            "export": [)" +
                          entry + "]");
    };
    expect_complaints({
        {scene_with(R"("export": [{"file": "../a.pc2"}])"),
         R"(bad.json: export[0].file: "../a.pc2" leaves the output folder; give a path inside it)"},
        {scene_with(R"("export": [{"file": "a.mc"}])"),
         R"(bad.json: export[0].file: "a.mc" is of an unknown format; use .pc2, .mdd, .abc, .usda, .usdc, .obj, .ply, .glb or .pvd)"},
        {scene_with(R"("export": [{"file": "a.pc2"}, {"file": "./a.pc2"}])"),
         R"(bad.json: export[1].file: "./a.pc2" is written by an earlier entry; choose another file)"},
        {scene_with(R"("export": [{"file": "a.pc2", "cloth": "shet"}])"),
         R"(bad.json: export[0].cloth: no cloth is named "shet"; did you mean "sheet"?)"},
        {R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "disc": {}}, {"name": "b", "disc": {}}],
             "export": [{"file": "a.pc2"}]})",
         R"(bad.json: export[0]: the scene has 2 cloths; name the one to write with the key "cloth")"},
        {with_render(R"({"file": "a.pc2"})"),
         R"(bad.json: export[0]: the scene has 3 surfaces; name the one to write with the key "cloth")"},
        {with_render(R"({"file": "a.pc2", "cloth": "jely_render"})"),
         R"(bad.json: export[0].cloth: no surface is named "jely_render"; did you mean "jelly_render"?)"},
    });
}

TEST(SceneErrors, KeepExportsToWhatTheirFormatHolds)
{
    const auto two = [](const std::string& entry) {
        return R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "disc": {}}, {"name": "b", "disc": {}}],
                   "solver": {"substeps": 4}, "export": [)" +
               entry + "]}";
    };
    expect_complaints({
        {two(R"({"file": "x.pc2", "cloth": "all"})"),
         R"(bad.json: export[0].cloth: ".pc2" holds one mesh; write one file each, or an .abc or .usda of all)"},
        {two(R"({"file": "x.pc2", "cloth": ["a", "b"]})"),
         R"(bad.json: export[0].cloth: ".pc2" holds one mesh; write one file each, or an .abc or .usda of all)"},
        {two(R"({"file": "x.abc", "cloth": ["a", "a"]})"),
         R"(bad.json: export[0].cloth: "a" is there twice; name it once)"},
        {two(R"({"file": "x.abc", "cloth": ["a", "c"]})"),
         R"(bad.json: export[0].cloth: no cloth is named "c"; known are a and b)"},
        {two(R"({"file": "x.abc", "cloth": 3})"),
         "bad.json: export[0].cloth: 3 is not text; write it in double quotes"},
        {two(R"({"file": "x.mdd", "cloth": "a", "avatars": true})"),
         R"(bad.json: export[0].avatars: ".mdd" holds one mesh; write the avatars to an .abc or .usda)"},
        {two(R"({"file": "x.mdd", "cloth": "a", "weld": false})"),
         R"(bad.json: export[0].weld: ".mdd" holds one mesh; write the panels to an .abc or .usda)"},
        {two(R"({"file": "x.obj", "cloth": "a", "normals": true})"),
         R"(bad.json: export[0].normals: ".obj" stores no normals; write an .abc or .usda)"},
        {two(R"({"file": "x_##.obj", "cloth": "a", "subframes": 2})"),
         R"(bad.json: export[0].subframes: ".obj" has a file for each frame and none between; write an .abc or .usda)"},
        {two(R"({"file": "x.abc", "subframes": 3})"), "bad.json: export[0].subframes: 3 does not divide "
                                                      "solver.substeps, 4; give a divisor of it, or leave "
                                                      "substeps out"},
        {two(R"({"file": "x.abc", "subframes": 2}, {"file": "y.abc", "subframes": 4})"),
         "bad.json: export[1].subframes: 4, and an earlier entry has 2; a run has one number besides 1"},
        {two(R"({"file": "x.pc2", "cloth": "a", "attributes": ["strain"]})"),
         R"(bad.json: export[0].attributes: ".pc2" stores no attributes; write an .abc, .usda, .usdc, .ply or .pvd)"},
        {two(R"({"file": "x.abc", "attributes": ["strain", "strain"]})"),
         R"(bad.json: export[0].attributes: "strain" is there twice; name it once)"},
        {two(R"({"file": "x.abc", "attributes": ["stress"]})"),
         R"(bad.json: export[0].attributes[0]: "stress" is unknown; write "strain", "gap" or "panel")"},
        {two(R"({"file": "x.abc", "attributes": ["gap"]})"),
         R"(bad.json: export[0].attributes: "gap" is the distance from avatars, and the scene has none but planes; add one, or leave gap out)"},
        {two(R"({"file": "x.abc", "unit": "mm"})"),
         R"(bad.json: export[0].unit: "mm" is unknown; write "m" or "cm")"},
        {scene_with(R"("fps": "24/0")"),
         R"(bad.json: fps: "24/0" is no such number; give one from 1 to 10000 1/s, or two as "24000/1001")"},
    });
}

} // namespace
} // namespace toile::test
