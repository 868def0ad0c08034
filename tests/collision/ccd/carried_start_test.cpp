#include "collision/ccd/carried_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <Eigen/Geometry>

#include "collision/ccd/cpu/ccd_search.h"
#include "collision/check/find_crossings.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kEdge = 0.02; // [m]

/// Sheets of cloth across y, and a block of a body above them.
struct Press {
    std::vector<Triangle> triangles, cloth, body;
    std::vector<Vec3> x;
    int cloth_vertices = 0;

    explicit Press(int layers, double block_at = 0.01)
    {
        const int side = 9;
        for (int layer = 0; layer < layers; ++layer) {
            const int first = int(x.size());
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i)
                    x.emplace_back(kEdge * (i - 4) + 0.003 * layer, -0.001 * layer, kEdge * (j - 4));
            for (int j = 0; j + 1 < side; ++j)
                for (int i = 0; i + 1 < side; ++i) {
                    const int a = first + j * side + i;
                    cloth.emplace_back(a, a + side, a + 1);
                    cloth.emplace_back(a + 1, a + side, a + side + 1);
                }
        }
        cloth_vertices = int(x.size());
        add_block(Vec3(-0.05, block_at, -0.05), Vec3(0.05, block_at + 0.05, 0.05));
    }

    void add_block(const Vec3& lower, const Vec3& upper)
    {
        const int first = int(x.size());
        for (int c = 0; c < 8; ++c)
            x.emplace_back(c & 1 ? upper.x() : lower.x(), c & 2 ? upper.y() : lower.y(),
                           c & 4 ? upper.z() : lower.z());
        for (const auto& q :
             {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
            body.emplace_back(first + q[0], first + q[1], first + q[2]);
            body.emplace_back(first + q[0], first + q[2], first + q[3]);
        }
    }

    /// Carries the cloth while the bodies move by `motion` each [m].
    std::vector<CarriedStart::StuckPair> carry(const std::vector<Vec3>& motion,
                                               const CarriedStart::Release& release)
    {
        std::vector<Vec3> end(x.begin() + cloth_vertices, x.end());
        for (size_t v = 0; v < end.size(); ++v)
            end[v] += motion[v / 8];
        return carry_to(end, release);
    }

    /// Carries the cloth while the bodies move to `end`.
    std::vector<CarriedStart::StuckPair> carry_to(const std::vector<Vec3>& end,
                                                  const CarriedStart::Release& release)
    {
        triangles = cloth;
        triangles.insert(triangles.end(), body.begin(), body.end());
        std::vector<int> rigid(x.size(), -1);
        std::fill(rigid.begin() + cloth_vertices, rigid.end(), kPrescribed);
        NearPairs near(triangles, x, rigid);
        const ExemptPairs exempt(x, std::vector<double>(x.size(), kEdge), 2e-6);
        CollisionFreeStep::Settings settings;
        settings.first_prescribed = cloth_vertices;
        const std::vector<double> slack(x.size(), 1e-4);
        CpuCcdSearch search(near, exempt, settings.gap(), slack);
        CarriedStart carried(search, near.edges(), settings, {});
        carried.carry(x, std::vector<Vec3>(cloth_vertices, Vec3::Zero()), end,
                      std::vector<unsigned char>(x.size(), 0), release);
        for (size_t v = 0; v < end.size(); ++v)
            EXPECT_EQ(x[cloth_vertices + v], end[v]) << "a body arrives on time";
        return carried.stuck();
    }

    int crossings() const
    {
        std::vector<Triangle> all = cloth;
        all.insert(all.end(), body.begin(), body.end());
        const auto found = find_crossings(all, x);
        return int(std::count_if(found.begin(), found.end(),
                                 [&](const Crossing& c) { return c.a < int(cloth.size()); }));
    }
};

const CarriedStart::Release kNothing = [](View<const BlockedPair>, bool) { return false; };

TEST(CarriedStart, TakesClothAlongWithABodyThatHitsIt)
{
    for (const double way : {0.012, 0.05, 0.3}) {
        Press press(1);
        EXPECT_TRUE(press.carry({Vec3(0.0, -way, 0.0)}, kNothing).empty()) << way;
        EXPECT_EQ(press.crossings(), 0) << way;
        EXPECT_LT(press.x[4 * 9 + 4].y(), 0.01 - way) << "the middle is in front of the body";
    }
}

TEST(CarriedStart, TakesLayersBeneathAlongToo)
{
    Press press(3);
    EXPECT_TRUE(press.carry({Vec3(0.0, -0.03, 0.0)}, kNothing).empty());
    EXPECT_EQ(press.crossings(), 0);
}

/// Edges that turn come nearer on their way than at its ends.
TEST(CarriedStart, TakesClothAlongWithABodyThatTurns)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int k = 0; k < 200; ++k) {
        Press press(1 + k % 3, 0.003);
        const Vec3 axis = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
        const Eigen::AngleAxisd turn(0.3 * uniform(random), axis);
        const Vec3 centre(0.0, 0.028, 0.0), way(0.01 * uniform(random), -0.01, 0.01 * uniform(random));
        std::vector<Vec3> end(press.x.begin() + press.cloth_vertices, press.x.end());
        for (Vec3& at : end)
            at = centre + way + turn * (at - centre);
        EXPECT_TRUE(press.carry_to(end, kNothing).empty()) << k;
        EXPECT_EQ(press.crossings(), 0) << k;
    }
}

TEST(CarriedStart, LeavesClothWhereNothingMeetsIt)
{
    Press press(2);
    const std::vector<Vec3> before = press.x;
    EXPECT_TRUE(press.carry({Vec3(0.3, 0.1, 0.0)}, kNothing).empty());
    for (int v = 0; v < press.cloth_vertices; ++v)
        EXPECT_EQ(press.x[v], before[v]);
}

/// A second block comes from below until both overlap: there is no place for cloth.
TEST(CarriedStart, AsksForAReleaseWhereBodiesCloseOnCloth)
{
    Press press(1);
    press.add_block(Vec3(-0.05, -0.06, -0.05), Vec3(0.05, -0.01, 0.05));
    int asked = 0, asked_last = 0;
    const auto stuck = press.carry({Vec3(0.0, -0.02, 0.0), Vec3(0.0, 0.02, 0.0)},
                                   [&](View<const BlockedPair> left, bool is_last) {
                                       ++asked;
                                       asked_last += is_last ? 1 : 0;
                                       EXPECT_FALSE(left.empty());
                                       return false;
                                   });
    EXPECT_GT(asked_last, 0);
    EXPECT_GT(asked, asked_last) << "also in larger parts of the motion";
    EXPECT_FALSE(stuck.empty());
}

} // namespace
} // namespace toile::test
