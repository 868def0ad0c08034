#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "collision/cloth/safe_step.h"
#include "collision/crossings/find_crossings.h"

namespace toile {
namespace {

/// A tetrahedron, body 0, over one of body 1, and a free triangle below, 1 cm between each.
struct Layers {
    std::vector<Vec3> x;
    std::vector<Triangle> triangles{{8, 9, 10}};
    std::vector<int> rigid{0, 0, 0, 0, 1, 1, 1, 1, -1, -1, -1};

    Layers()
    {
        for (int body = 0; body < 2; ++body) {
            for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.3, 0.3, 0.3)})
                x.push_back(corner + (body == 0 ? 0.31 : 0.0) * Vec3::UnitY());
            for (const Triangle& t :
                 {Triangle(0, 2, 1), Triangle(0, 1, 3), Triangle(1, 2, 3), Triangle(2, 0, 3)})
                triangles.push_back(t + Triangle::Constant(4 * body));
        }
        for (const Vec3& corner : {Vec3(0, -0.01, 0), Vec3(0, -0.01, 1), Vec3(1, -0.01, 0)})
            x.push_back(corner);
    }

    std::vector<NearPair> pairs(const std::vector<Vec3>& motion, double slack,
                                const std::vector<int>& bodies) const
    {
        const std::vector<double> slacks(x.size(), slack);
        std::vector<NearPair> found;
        NearPairs(triangles, x, bodies).find(x, {motion, slacks}, 0.001, found);
        return found;
    }

    /// What SafeStep makes of x + motion, where nobody was expected to move.
    std::vector<Vec3> limited(const std::vector<Vec3>& motion) const
    {
        NearPairs near(triangles, x, rigid);
        const ExemptPairs exempt(x, std::vector<double>(x.size(), 1.0), 2e-6);
        SafeStep safe(near, exempt, {}, RigidWays(rigid, {1000.0, 1000.0}));
        const std::vector<double> slack(x.size(), 1e-4);
        const std::vector<unsigned char> fixed(x.size(), 0);
        safe.begin(x, x, slack, fixed, {});
        std::vector<Vec3> end = x;
        for (size_t v = 0; v < x.size(); ++v)
            end[v] += motion[v];
        safe.limit(end);
        return end;
    }

    /// Turns the vertices from first on about the middle of the first, by an angle about an axis [rad], and
    /// moves them.
    std::vector<Vec3> motion_of(int first, const Vec3& turn, const Vec3& move) const
    {
        std::vector<Vec3> motion(x.size(), Vec3::Zero());
        const Mat3 R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
        for (int v = first; v < first + 4; ++v)
            motion[v] = R * (x[v] - x[first]) + x[first] - x[v] + move;
        return motion;
    }
};

/// Largest change of a distance between two vertices of a body [m].
double deformation(const std::vector<Vec3>& x, const std::vector<Vec3>& rest, int first)
{
    double most = 0.0;
    for (int a = first; a < first + 4; ++a)
        for (int b = first; b < a; ++b)
            most = std::max(most, std::abs((x[a] - x[b]).norm() - (rest[a] - rest[b]).norm()));
    return most;
}

TEST(RigidContact, FindsNoPairsWithinABody)
{
    const Layers layers;
    const std::vector<Vec3> still(layers.x.size(), Vec3::Zero());
    const size_t all = layers.pairs(still, 0.006, layers.rigid).size();
    EXPECT_LT(all, layers.pairs(still, 0.5, {}).size());
    // Both as one body: only what meets the triangle is left.
    const std::vector<NearPair> some = layers.pairs(still, 0.006, {0, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1});
    EXPECT_LT(some.size(), all);
    EXPECT_GT(some.size(), 0u);
    for (const NearPair& pair : some)
        EXPECT_TRUE(pair.vertex[0] >= 8 || pair.vertex[3] >= 8);
}

/// The upper body would turn by half a radian, through the lower one.
TEST(RigidContact, HoldsATurningBodyBackAsAWhole)
{
    const Layers layers;
    const std::vector<Vec3> motion = layers.motion_of(0, Vec3(0.5, 0.0, 0.2), Vec3(0.05, 0.1, 0.0));
    std::vector<Vec3> all_the_way = layers.x;
    for (size_t v = 0; v < motion.size(); ++v)
        all_the_way[v] += motion[v];
    ASSERT_FALSE(find_crossings(layers.triangles, all_the_way).empty());

    const std::vector<Vec3> x = layers.limited(motion);
    const double share = (x[2] - layers.x[2]).norm() / motion[2].norm();
    EXPECT_GT(share, 0.02);
    EXPECT_LT(share, 0.98);
    EXPECT_LT(deformation(x, layers.x, 0), 1e-15);
    for (int k = 0; k <= 8; ++k) {
        std::vector<Vec3> between(x.size());
        for (size_t v = 0; v < x.size(); ++v)
            between[v] = layers.x[v] + k / 8.0 * (x[v] - layers.x[v]);
        EXPECT_TRUE(find_crossings(layers.triangles, between).empty()) << k;
    }
}

/// Cloth that a body comes down on: the cloth gives way, no corner of the body moves by itself.
TEST(RigidContact, ClothGivesWayToABody)
{
    Layers layers;
    for (int v = 8; v < 11; ++v)
        layers.x[v].y() = -0.0005;
    std::vector<Vec3> motion = layers.motion_of(4, Vec3::UnitX(), Vec3::Zero());
    for (int v = 4; v < 8; ++v)
        motion[v] = Vec3(0.002, -0.0009, 0.0);
    const std::vector<Vec3> x = layers.limited(motion);
    for (int v = 4; v < 8; ++v)
        EXPECT_LT((x[v] - layers.x[v] - motion[v]).norm(), 1e-15);
    EXPECT_LT(x[8].y(), -0.0009);
    EXPECT_TRUE(find_crossings(layers.triangles, x).empty());
}

/// A body and a vertex of cloth in one zone go where their momentum takes them.
TEST(RigidContact, ZonesWeighABodyByItsMass)
{
    const std::vector<Vec3> ways{Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
    const std::vector<ImpactZones::Hold> hold(3, ImpactZones::Hold::kNone);
    ImpactZones zones;
    zones.reset(ways, hold, 0.0);
    zones.set_body(1, Vec3(0, 0, 0.5), 3.0); // of vertices 1 and 2
    zones.join(0, 1);
    zones.bring_back(0, 0.0);
    zones.close_round();
    EXPECT_LT((zones.common(1) - Vec3(0.25, 0.0, 0.375)).norm(), 1e-15);
    EXPECT_EQ(zones.motion(0), zones.common(1));
}

} // namespace
} // namespace toile
