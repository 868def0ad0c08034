#include <sstream>

#include <gtest/gtest.h>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Five equal sheets at five positions, each fixed at one corner.
World five_sheets(const std::string& method)
{
    std::ostringstream cloths, attachments;
    for (int k = 0; k < 5; ++k) {
        const char* const comma = k > 0 ? ", " : "";
        const double x = k * 0.7;
        cloths << comma << R"({"name": "sheet)" << k
               << R"(", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [)" << x
               << ", 0.3, 0.1]}";
        attachments << comma << R"({"cloth": "sheet)" << k << R"(", "select": {"nearest": [[)" << x
                    << ", 0.3, 0.1]]}}";
    }
    return World(parse_scene(R"({"toile": 1, "frames": 3, "solver": {"substeps": 4, "method": ")" + method +
                                 R"("}, "cloths": [)" + cloths.str() + R"(], "attachments": [)" +
                                 attachments.str() + "]}",
                             "test.json"));
}

TEST(EqualCloths, ShareOneFactor)
{
    for (const char* method : {"direct", "auto"}) {
        World world = five_sheets(method);
        world.advance_frame();
        EXPECT_EQ(world.stages().calls("linear/factor"), 1) << method;
    }
}

TEST(EqualCloths, ShareOneTable)
{
    World world = five_sheets("quadrature");
    world.advance_frame();
    EXPECT_EQ(world.stages().calls("quadrature/build"), 1);
}

} // namespace
} // namespace toile::test
