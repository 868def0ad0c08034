#include "scenes/world/scene_costs.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/cloth_group.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

using namespace scenes;

namespace {

/// A scene of two cloths and blocks of 125 vertices.
class SceneCostsTest : public testing::Test {
protected:
    SceneCostsTest()
    {
        write_msh(folder_.path() / "block.msh", make_block(Vec3::Constant(0.1), {4, 4, 4}, 0.1).mesh);
    }

    Scene scene(const std::string& keys) const
    {
        return parse_scene("{\"toile\": 1, \"frames\": 2, " + keys + "}", folder_.path() / "test.json");
    }
    SceneCosts costs(const std::string& keys, bool on_gpu = true) const
    {
        const Scene scene = this->scene(keys);
        const std::vector<SceneCloth> cloths = make_cloths(scene, {}, {});
        int vertices = 0;
        for (const SceneCloth& cloth : cloths)
            vertices += cloth.vertex_count();
        return expected_costs(scene, cloths, make_bodies(scene, {}, vertices), on_gpu);
    }
    static std::string block(const std::string& name, const std::string& keys)
    {
        return R"({"name": ")" + name + R"(", "file": "block.msh", )" + keys + "}";
    }
    static std::string sheet(const std::string& name, const std::string& keys = "")
    {
        return R"({"name": ")" + name + R"(", "rectangle": {"size": [0.3, 0.3], "resolution": 0.05})" + keys +
               "}";
    }

    TemporaryFolder folder_;
};

const std::string kNoCloths = R"("cloths": [], )";

TEST_F(SceneCostsTest, CountTablesThatBodiesShareOnce)
{
    const std::string soft = R"("young": 1000)", stiff = R"("young": 2000)",
                      elsewhere = R"("young": 1000, "translate": [1, 0, 0], "rotate_deg": [0, 40, 0])";
    const SceneCosts one = costs(kNoCloths + "\"soft_bodies\": [" + block("a", soft) + "]");
    const SceneCosts three = costs(kNoCloths + "\"soft_bodies\": [" + block("a", soft) + ", " +
                                   block("b", elsewhere) + ", " + block("c", stiff) + "]");
    EXPECT_EQ(one.tables, 1);
    EXPECT_EQ(three.parts, 3);
    EXPECT_EQ(three.tables, 2);
    EXPECT_EQ(three.body_vertices, 3 * 125);
    EXPECT_DOUBLE_EQ(three.table_seconds, 2.0 * one.table_seconds);
    EXPECT_DOUBLE_EQ(three.table_bytes, 2.0 * one.table_bytes);
    EXPECT_NEAR(double(three.max_bytes - one.max_bytes), one.table_bytes + 2 * 125 * 21'000.0, 1.0);
}

TEST_F(SceneCostsTest, CountTablesThatClothsShareOnce)
{
    EXPECT_EQ(costs("\"cloths\": [" + sheet("a") + ", " + sheet("b") + "]").tables, 1);
    EXPECT_EQ(costs("\"cloths\": [" + sheet("a") + ", " + sheet("b", R"(, "fabric": "silk")") + "]").tables,
              2);
    EXPECT_EQ(costs("\"cloths\": [" + sheet("a") + ", " + sheet("b") +
                    R"(], "attachments": [{"cloth": "b", "select": {"vertices": [0]}}])")
                  .tables,
              2);
}

TEST_F(SceneCostsTest, TakeNoMemoryOfAGpuOnACpu)
{
    const SceneCosts cpu = costs("\"cloths\": [" + sheet("a") + "]", false);
    EXPECT_GT(cpu.table_seconds, 0.0);
    EXPECT_EQ(cpu.max_bytes, 0u);
}

/// Costs of the paper's letters.
SceneCosts letters()
{
    SceneCosts costs;
    costs.body_vertices = 177'533;
    costs.parts = 17;
    costs.tables = 11;
    costs.table_seconds = 3.214;
    costs.table_bytes = 62e6;
    costs.min_bytes = std::size_t(1000) << 20;
    costs.max_bytes = std::size_t(3000) << 20;
    return costs;
}

FreeMemory free_mebibytes(std::size_t mebibytes) { return {"CUDA device 0 (NVIDIA H200)", mebibytes << 20}; }

TEST(SceneCosts, AreStated)
{
    EXPECT_EQ(table_text(letters()),
              "11 quadrature tables for 17 cloths and bodies of 177533 vertices: about "
              "3.21 s to build if none is stored, 0.349 kB a vertex");
    EXPECT_EQ(memory_text(letters(), free_mebibytes(80'000)),
              "memory of the GPU: 1000 to 3000 MiB, 5.91 to 17.7 kB a vertex; 80000 MiB are free");
    EXPECT_EQ(memory_text(letters(), free_mebibytes(2000)),
              "memory of the GPU: 1000 to 3000 MiB, 5.91 to 17.7 kB a vertex; 2000 MiB are free, which may "
              "be too little");
}

TEST(SceneCosts, LeaveAutoTheCpuWhereASceneMayNotFit)
{
    EXPECT_EQ(why_too_large(letters(), free_mebibytes(3000)), "");
    EXPECT_EQ(why_too_large(letters(), free_mebibytes(2999)),
              "CUDA device 0 (NVIDIA H200) has 2999 MiB left, 177533 vertices may take 3000 MiB");
}

TEST(SceneCosts, RefuseASceneThatCannotFit)
{
    EXPECT_NO_THROW(require_capacity(letters(), free_mebibytes(1000)));
    try {
        require_capacity(letters(), free_mebibytes(999));
        FAIL() << "took it";
    } catch (const DeviceError& error) {
        EXPECT_STREQ(error.what(),
                     "CUDA device 0 (NVIDIA H200) is out of memory: 177533 vertices need 1000 to 3000 MiB, "
                     "999 MiB are free; choose a GPU with more, the backend cpu, or fewer vertices");
    }
}

TEST_F(SceneCostsTest, AreToldBeforeTablesAreBuilt)
{
    std::vector<std::string> events;
    WorldOptions options;
    options.note = [&](const std::string& text) { events.push_back(text); };
    options.tables = std::make_shared<TableStore>();
    options.building = [&](const std::string&, double) {
        events.push_back("built");
        return true;
    };
    const std::string cloths = "\"cloths\": [" + sheet("a") + "], \"solver\": {\"method\": ";
    World world(scene(cloths + "\"quadrature\"}"), options);
    world.prepare();
    ASSERT_GE(events.size(), 2u);
    EXPECT_EQ(events.front().find("1 quadrature table for 1 cloth or body of "), 0u) << events.front();
    EXPECT_EQ(events.back(), "built");
    events.clear();
    World(scene(cloths + "\"direct\"}"), options).prepare();
    EXPECT_TRUE(events.empty()) << events.front();
}

} // namespace
} // namespace toile::test
