#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/backend.h"
#include "tests/scenes/folds/folded_strip.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Folds of a scene: the edges that they name, and what is refused.
namespace toile::test {

using namespace scenes;

namespace {

class FoldEdges : public testing::Test {
protected:
    Scene scene_of(const std::string& folds, const std::string& cloth_keys = "",
                   const std::string& keys = "") const
    {
        return parse_scene(
            R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "file": "strip.obj", "folds": )" + folds +
                cloth_keys + "}]" + keys + "}",
            folder_.path() / "scene.json");
    }

    LoadedCloth load(const std::string& folds) const
    {
        const Scene scene = scene_of(folds);
        return load_cloth(scene, scene.cloths[0], {}, {});
    }

    /// Error without the folder.
    std::string complaint(const std::string& folds, const std::string& cloth_keys = "",
                          const std::string& keys = "") const
    {
        std::string text = refusal([&] {
            const Scene scene = scene_of(folds, cloth_keys, keys);
            static_cast<void>(load_cloth(scene, scene.cloths[0], {}, {}));
        });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = 0; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }

    FoldEdges() { folder_.write("strip.obj", strip_.obj()); }

    TemporaryFolder folder_;
    Strip strip_{6, 4};
};

std::string fold(const std::string& vertices, const std::string& more = R"("angle_deg": 90)")
{
    return R"([{"vertices": )" + vertices + ", " + more + "}]";
}

TEST_F(FoldEdges, AreThoseAlongTheVertices)
{
    const LoadedCloth loaded = load(fold(strip_.column(2), R"("angle_deg": -90, "stiffness": 0.3)"));
    ASSERT_EQ(loaded.folds.size(), 4u);
    for (int k = 0; k < 4; ++k) {
        const Edge& edge = loaded.rest->topology.edges[loaded.folds[k].edge];
        EXPECT_EQ(std::min(edge.vertex[0], edge.vertex[1]), strip_.vertex(2, k));
        EXPECT_EQ(std::max(edge.vertex[0], edge.vertex[1]), strip_.vertex(2, k + 1));
        EXPECT_NEAR(loaded.folds[k].angle, -1.5707963267948966, 1e-15);
        EXPECT_EQ(loaded.folds[k].stiffness, 0.3);
    }
    EXPECT_EQ(load(fold(strip_.column(2))).folds[0].stiffness, garment::kFoldStiffness);
    EXPECT_TRUE(load("[]").folds.empty());
}

/// Numbers are those of the file, also where its seams are joined.
TEST_F(FoldEdges, AreNamedByVerticesOfTheFile)
{
    std::string obj = strip_.obj();
    obj.insert(0, "v 5 5 5\n"); // a vertex without faces: every vertex has a smaller number in the cloth
    for (size_t at = obj.find("f "); at != std::string::npos; at = obj.find(' ', at + 1)) {
        size_t end = at + 1;
        while (end < obj.size() && std::isdigit(static_cast<unsigned char>(obj[end])) != 0)
            ++end;
        if (end > at + 1)
            obj.replace(at + 1, end - at - 1, std::to_string(std::stoi(obj.substr(at + 1)) + 1));
    }
    folder_.write("strip.obj", obj);
    const LoadedCloth loaded = load(fold("[12, 13]"));
    ASSERT_EQ(loaded.folds.size(), 1u);
    EXPECT_EQ(loaded.rest->topology.edges[loaded.folds[0].edge].vertex[0] +
                  loaded.rest->topology.edges[loaded.folds[0].edge].vertex[1],
              11 + 12);
    EXPECT_EQ(
        complaint(fold("[0, 1]")),
        "scene.json: cloths[0].folds[0].vertices[0]: vertex 0 of \"c\" has no face; fold along vertices "
        "of the surface");
}

TEST_F(FoldEdges, MayRunRoundALoop) { EXPECT_EQ(load(fold("[11, 12, 17, 16, 11]")).folds.size(), 4u); }

TEST_F(FoldEdges, AreRefusedWhereTheyDoNotExist)
{
    const std::string at = "scene.json: cloths[0].folds[0]";
    EXPECT_EQ(complaint(fold("[11, 12, 19]")),
              at + ".vertices[2]: no edge joins vertices 12 and 19; edges join 12 to 6, 7, 11, 13, 17, 18");
    EXPECT_EQ(complaint(fold("[11, 35]")),
              at + ".vertices[1]: vertex 35 is out of range; \"c\" has vertices 0 to 34");
    EXPECT_EQ(complaint(fold("[10, 15]")),
              at + ".vertices[1]: an edge at the border joins vertices 10 and 15; cloth folds between two "
                   "faces, name edges inside");
    EXPECT_EQ(complaint(fold("[11, 12, 11]")), at + ": the edge from vertex 12 to 11 is in it twice; an edge "
                                                    "is folded once");
    EXPECT_EQ(
        complaint(R"([{"vertices": [11, 12], "angle_deg": 90}, {"vertices": [13, 12, 11], "angle_deg": 9}])"),
        "scene.json: cloths[0].folds[1]: the edge from vertex 12 to 11 is in folds[0] too; an edge is "
        "folded once");
}

TEST_F(FoldEdges, AreRefusedWithKeysThatDoNotWork)
{
    EXPECT_EQ(complaint(fold("[11]")),
              "scene.json: cloths[0].folds[0].vertices: 1 vertex; a fold needs two or more");
    EXPECT_EQ(complaint(fold("[11, 12]", R"("angle_deg": 190)")),
              "scene.json: cloths[0].folds[0].angle_deg: 190 is out of range; give a number from -180 to 180 "
              "degrees");
    EXPECT_EQ(
        complaint(fold("[11, 12]", R"("angle_deg": 90, "stiffness": 0)")),
        "scene.json: cloths[0].folds[0].stiffness: 0 is out of range; give a number above 0 and at most "
        "100 N");
    EXPECT_EQ(complaint(fold("[11, 12]", R"("stiffness": 1)")),
              "scene.json: cloths[0].folds[0]: the key \"angle_deg\" is missing; add it");
    EXPECT_EQ(
        complaint(fold("[11, 12]"), R"(, "subdivide": 1)"),
        "scene.json: cloths[0].subdivide: splits the edges that folds run along; remove it, or the folds");
    EXPECT_EQ(complaint(fold("[11, 12]"), "", R"(, "solver": {"method": "xpbd"})"),
              "scene.json: cloths[0].folds: \"xpbd\" has no folds; choose another solver.method, or remove "
              "them");
}

TEST_F(FoldEdges, RunOnTheCpu)
{
    EXPECT_EQ(why_not_on_gpu(scene_of(fold("[11, 12]"))), "folds of cloth run on the CPU only");
    EXPECT_EQ(why_not_on_gpu(scene_of("[]")), "");
}

} // namespace
} // namespace toile::test
