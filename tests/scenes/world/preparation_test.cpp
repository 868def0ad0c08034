#include <algorithm>
#include <atomic>
#include <mutex>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Sheet attached by one edge until 0.05 s, with the global solver `method`.
Scene sheet(const std::string& method, double settle = 0.0)
{
    return parse_scene(R"({"toile": 1, "frames": 4, "settle": )" + std::to_string(settle) +
                           R"(, "solver": {"method": ")" + method + R"("},
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.3], "resolution": 0.02}}],
        "attachments": [{"cloth": "sheet", "release": 0.05,
                         "select": {"box": {"lower": [-0.3, -1, -1], "upper": [-0.19, 1, 1]}}}]})",
                       "test.json");
}

WorldOptions without_disk()
{
    WorldOptions options;
    options.tables = std::make_shared<TableStore>();
    return options;
}

TEST(Preparation, DoesTheWorkOfTheFirstStep)
{
    for (const double settle : {0.0, 0.1}) {
        World world(sheet("quadrature", settle), without_disk());
        world.prepare();
        EXPECT_EQ(world.stages().calls("quadrature/build"), 1);
        world.settle();
        world.advance_frame();
        EXPECT_EQ(world.stages().calls("quadrature/build"), 1) << "settled for " << settle;
        world.advance_frame();
        EXPECT_EQ(world.stages().calls("quadrature/build"), 2) << "the edge was let go";
    }
}

TEST(Preparation, ReportsClothAndProgress)
{
    WorldOptions options = without_disk();
    std::string cloth;
    double largest = 0.0;
    std::mutex mutex;
    options.building = [&](const std::string& name, double fraction) {
        const std::lock_guard lock(mutex);
        cloth = name;
        largest = std::max(largest, fraction);
        return true;
    };
    World world(sheet("quadrature"), options);
    world.prepare();
    EXPECT_EQ(cloth, "sheet");
    EXPECT_EQ(largest, 1.0);
    largest = 0.0;
    world.prepare();
    EXPECT_EQ(largest, 0.0) << "nothing left to do";
}

TEST(Preparation, CanBeCancelledAndResumed)
{
    WorldOptions options = without_disk();
    std::atomic<bool> wants_more = false;
    options.building = [&](const std::string&, double) { return wants_more.load(); };
    World world(sheet("quadrature"), options), undisturbed(sheet("quadrature"), without_disk());
    EXPECT_THROW(world.prepare(), Cancelled);
    wants_more = true;
    world.advance_frame();
    undisturbed.advance_frame();
    EXPECT_EQ(world.cloths()[0].positions, undisturbed.cloths()[0].positions);
}

TEST(Preparation, ReadsTablesFromDiskAndReportsTheirErrors)
{
    const TemporaryFolder folder;
    const auto positions = [&](std::vector<std::string>& warnings) {
        WorldOptions options;
        options.tables = std::make_shared<TableStore>(folder.path());
        options.warn = [&](const std::string& text) { warnings.push_back(text); };
        World world(sheet("quadrature"), options);
        world.advance_frame();
        return std::pair(world.cloths()[0].positions, world.stages().calls("quadrature/build"));
    };
    std::vector<std::string> warnings;
    const auto built = positions(warnings), read = positions(warnings);
    EXPECT_EQ(built.second, 1);
    EXPECT_EQ(read.second, 0);
    EXPECT_EQ(read.first, built.first);
    EXPECT_TRUE(warnings.empty());
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        std::filesystem::resize_file(entry.path(), 300);
    EXPECT_EQ(positions(warnings).second, 1);
    EXPECT_EQ(warnings.size(), 1u);
}

} // namespace
} // namespace toile::test
