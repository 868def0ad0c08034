#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "scenes/world/world_crossings.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

inline const std::string kFloor = R"("avatars": [{"name": "floor", "plane": {}}], )";

/// Scenes with blocks of edge 0.1 m, whose lowest corner is in the origin.
class SoftBodyTest : public testing::Test {
protected:
    SoftBodyTest()
    {
        write_msh(folder.path() / "block.msh", make_block(Vec3::Constant(0.1), {4, 4, 4}, 0.1).mesh);
    }

    scenes::Scene scene_of(const std::string& keys) const
    {
        return scenes::parse_scene("{\"toile\": 1, " + keys + "}", folder.path() / "test.json");
    }
    scenes::World world_of(const std::string& keys, const scenes::WorldOptions& options = {}) const
    {
        return scenes::World(scene_of(keys), options);
    }
    std::string block(const std::string& name, const std::string& keys) const
    {
        return R"({"name": ")" + name + R"(", "file": "block.msh", )" + keys + "}";
    }
    std::string refusal(const std::string& keys) const
    {
        try {
            world_of(keys);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    }

    /// Advances to the last frame; every step must end converged.
    static void run(scenes::World& world)
    {
        while (world.frame() + 1 < world.frame_count()) {
            const StepReport report = world.advance_frame();
            ASSERT_EQ(report.status, StepReport::Status::Converged)
                << world.frame() << ": " << report.message;
            ASSERT_EQ(crossing_count(world), 0) << world.frame();
        }
    }

    TemporaryFolder folder;
};

inline Vec3 mean(const std::vector<Vec3>& points)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points)
        sum += p;
    return sum / double(points.size());
}

inline double lowest(const std::vector<Vec3>& points)
{
    double y = INFINITY;
    for (const Vec3& p : points)
        y = std::min(y, p.y());
    return y;
}

} // namespace toile::test
