#include "scenes/drape/seam_lift.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace scenes;

namespace {

/// Box with its top at y = 0, 20 cm deep.
TriangleMesh shoulder()
{
    TriangleMesh mesh;
    for (const double y : {-0.5, 0.0})
        for (const auto& [x, z] : {std::pair(-0.2, -0.1), {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}})
            mesh.positions.emplace_back(x, y, z);
    mesh.triangles = {{4, 6, 5}, {4, 7, 6}, {0, 1, 2}, {0, 2, 3}};
    for (int k = 0; k < 4; ++k) {
        const int next = (k + 1) % 4;
        mesh.triangles.emplace_back(k, k + 4, next);
        mesh.triangles.emplace_back(next, k + 4, next + 4);
    }
    return mesh;
}

/// Seam of threads from front to back over the box.
struct Panels {
    std::vector<std::vector<std::array<int, 2>>> stitches;
    std::vector<Vec3> x;

    void add_seam(const std::vector<double>& heights)
    {
        stitches.emplace_back();
        for (size_t i = 0; i < heights.size(); ++i) {
            const int first = int(x.size());
            x.emplace_back(0.02 * double(i) + 0.003, heights[i], 0.3);
            x.emplace_back(0.02 * double(i) + 0.003, heights[i], -0.25);
            stitches.back().push_back({first, first + 1});
        }
    }
    double lift() const { return shoulder_lift(stitches, x, shoulder()); }
};

TEST(ShoulderLift, IsTheLeastThatClearsAllThreadsOfASeam)
{
    Panels panels;
    panels.add_seam({-0.012, -0.032, -0.021});
    EXPECT_GT(panels.lift(), 0.032);
    EXPECT_LE(panels.lift(), 0.032 + 0.005 + 1e-9);
    panels.add_seam({-0.052, -0.044});
    EXPECT_GT(panels.lift(), 0.052);
    EXPECT_LE(panels.lift(), 0.052 + 0.005 + 1e-9);
}

TEST(ShoulderLift, IsNoneForSeamsThatPassInPartOrOnlyFarBelow)
{
    Panels panels;
    EXPECT_EQ(panels.lift(), 0.0);
    panels.add_seam({-0.03, 0.01});             // in part beside the body
    panels.add_seam({-kMaxLift - 0.03, -0.02}); // through the trunk
    panels.add_seam({0.02, 0.01});              // above
    EXPECT_EQ(panels.lift(), 0.0);
}

} // namespace

} // namespace toile::test
