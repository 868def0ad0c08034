#include <gtest/gtest.h>

#include <cmath>

#include "avatars/mannequin/mannequin.h"
#include "avatars/mannequin/rig.h"
#include "core/base/error.h"
#include "core/mesh/topology.h"
#include "tests/avatars/column.h"

namespace toile::test {

using namespace avatars;

namespace {

/// Mannequin shared by all tests that only read it.
SkinnedAvatar& mannequin()
{
    static const std::unique_ptr<Avatar> avatar = make_mannequin();
    return dynamic_cast<SkinnedAvatar&>(*avatar);
}

/// True if segment pq crosses the triangle's interior.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const auto volume = [](const Vec3& o, const Vec3& u, const Vec3& v, const Vec3& w) {
        return (u - o).cross(v - o).dot(w - o);
    };
    if (volume(a, b, c, p) * volume(a, b, c, q) >= 0.0)
        return false;
    const double s = volume(p, q, a, b), t = volume(p, q, b, c), u = volume(p, q, c, a);
    return (s > 0.0 && t > 0.0 && u > 0.0) || (s < 0.0 && t < 0.0 && u < 0.0);
}

/// Number of edges that cross a triangle with which they share no vertex, by a sweep along y.
int count_crossings(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles)
{
    const Topology topology = build_topology(triangles, int(x.size()), "mannequin");
    std::vector<Bounds> box(triangles.size());
    std::vector<int> order(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
        order[t] = int(t);
        for (const int v : triangles[t])
            box[t].extend(x[v]);
    }
    std::sort(order.begin(), order.end(), [&](int a, int b) { return box[a].lower.y() < box[b].lower.y(); });
    int crossings = 0;
    for (size_t i = 0; i < order.size(); ++i)
        for (size_t j = i + 1; j < order.size() && box[order[j]].lower.y() <= box[order[i]].upper.y(); ++j) {
            const Bounds &a = box[order[i]], &b = box[order[j]];
            if ((a.lower.array() > b.upper.array()).any() || (b.lower.array() > a.upper.array()).any())
                continue;
            for (const auto& [one, other] : {std::pair{order[i], order[j]}, std::pair{order[j], order[i]}})
                for (const int e : topology.triangle_edge[one]) {
                    const auto& [p, q] = topology.edges[e].vertex;
                    const Triangle& t = triangles[other];
                    const bool touches = (t.array() == p).any() || (t.array() == q).any();
                    if (!touches && topology.edges[e].triangle[0] == one &&
                        pierces(x[p], x[q], x[t[0]], x[t[1]], x[t[2]]))
                        ++crossings;
                }
        }
    return crossings;
}

double signed_volume(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles)
{
    double volume = 0.0;
    for (const Triangle& t : triangles)
        volume += x[t[0]].cross(x[t[1]]).dot(x[t[2]]) / 6.0;
    return volume;
}

} // namespace

TEST(Mannequin, IsOneClosedManifoldFacingOutwards)
{
    SkinnedAvatar& avatar = mannequin();
    const Topology topology = build_topology(avatar.triangles(), avatar.vertex_count(), "mannequin");
    EXPECT_TRUE(topology.is_closed());
    // One piece without handles: V - E + F = 2.
    EXPECT_EQ(avatar.vertex_count() - int(topology.edges.size()) + int(avatar.triangles().size()), 2);
    EXPECT_GE(avatar.vertex_count(), 6000);
    EXPECT_LE(avatar.vertex_count(), 12000);
    const double volume = signed_volume(posed(avatar, {}), avatar.triangles());
    EXPECT_GT(volume, 0.045); // [m^3] a slim woman of 1.75 m holds about 0.055
    EXPECT_LT(volume, 0.070);
}

TEST(Mannequin, StandsOnTheFloorAndHasTheRequestedHeight)
{
    for (const double height : {1.60, 1.75}) {
        MannequinSettings settings;
        settings.height = height;
        settings.edge_length = 0.02;
        const Bounds box = bounds(posed(*make_mannequin(settings), {}));
        EXPECT_NEAR(box.lower.y(), 0.0, 1e-3);
        EXPECT_NEAR(box.upper.y(), height, 0.01);
        EXPECT_NEAR(box.lower.x(), -box.upper.x(), 1e-4); // mirrored but for the quads' diagonals
    }
}

TEST(Mannequin, IsClosedAndManifoldForEverySetting)
{
    MannequinSettings settings;
    for (const double edge_length : {0.010, 0.0137, 0.02})
        for (const double angle : {25.0, 50.0, 75.0}) {
            settings.edge_length = edge_length;
            settings.arm_angle_deg = angle;
            const auto avatar = make_mannequin(settings);
            const Topology topology =
                build_topology(avatar->triangles(), avatar->vertex_count(), "mannequin");
            EXPECT_TRUE(topology.is_closed());
            EXPECT_EQ(avatar->vertex_count() - int(topology.edges.size()) + int(avatar->triangles().size()),
                      2)
                << edge_length << " m, " << angle << " degrees";
        }
}

TEST(Mannequin, HasTrianglesThatAClothCanRestOn)
{
    SkinnedAvatar& avatar = mannequin();
    const std::vector<Vec3> x = posed(avatar, {});
    double min_angle = 1e300;
    for (const Triangle& t : avatar.triangles())
        for (int k = 0; k < 3; ++k) {
            const Vec3 u = x[t[(k + 1) % 3]] - x[t[k]], v = x[t[(k + 2) % 3]] - x[t[k]];
            min_angle = std::min(min_angle, std::atan2(u.cross(v).norm(), u.dot(v)));
        }
    EXPECT_GT(min_angle, 15.0 * 3.14159265 / 180.0);
    EXPECT_EQ(count_crossings(x, avatar.triangles()), 0);
}

TEST(Mannequin, IsReproducible)
{
    const auto again = make_mannequin();
    EXPECT_EQ(posed(*again, {1, 0.4}), posed(mannequin(), {1, 0.4}));
}

TEST(Mannequin, BindsEveryVertexToAtMostFourNearbyBonesWithUnitSum)
{
    const SkinnedMesh& mesh = mannequin().model().mesh;
    for (int v = 0; v < mesh.rest.vertex_count(); ++v) {
        double sum = 0.0;
        ASSERT_LE(mesh.first[v + 1] - mesh.first[v], 4);
        for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k) {
            const Influence& part = mesh.influences[k];
            sum += part.weight;
            const bool arm = part.bone >= kUpperArmL && part.bone <= kHandR;
            // An arm moves neither the middle of the trunk nor the other side.
            if (arm) {
                const double side = part.bone <= kHandL ? 1.0 : -1.0;
                EXPECT_GT(side * mesh.rest.positions[v].x(), 0.08) << "vertex " << v;
            }
        }
        EXPECT_NEAR(sum, 1.0, 1e-14);
    }
}

TEST(Mannequin, WalksWithItsFeetOnTheFloor)
{
    SkinnedAvatar& avatar = mannequin();
    const int walk = avatar.clip_index("walk_in_place");
    for (int k = 0; k < 20; ++k) {
        const double lowest = bounds(posed(avatar, {walk, 1.1 * k / 20})).lower.y();
        EXPECT_GT(lowest, -0.010) << "phase " << k / 20.0;
        EXPECT_LT(lowest, 0.010) << "phase " << k / 20.0;
    }
}

TEST(Mannequin, WalksInACycleThatClosesAndAdvancesAlongZ)
{
    SkinnedAvatar& avatar = mannequin();
    const std::vector<Vec3> begin = posed(avatar, {avatar.clip_index("walk_in_place"), 0.0});
    const std::vector<Vec3> end = posed(avatar, {avatar.clip_index("walk_in_place"), 1.1});
    EXPECT_EQ(begin, end);

    const int walk = avatar.clip_index("walk");
    const double distance =
        bounds(posed(avatar, {walk, 6.6})).center().z() - bounds(posed(avatar, {walk, 0.0})).center().z();
    EXPECT_GT(distance / 6.6, 0.9); // [m/s]
    EXPECT_LT(distance / 6.6, 1.5);
}

TEST(Mannequin, NeverCrossesItselfWhileWalking)
{
    SkinnedAvatar& avatar = mannequin();
    const int walk = avatar.clip_index("walk_in_place");
    for (int k = 0; k < 16; ++k)
        EXPECT_EQ(count_crossings(posed(avatar, {walk, 1.1 * k / 16}), avatar.triangles()), 0)
            << "pose " << k;
}

TEST(Mannequin, RefusesSettingsOutOfRange)
{
    MannequinSettings settings;
    settings.edge_length = 0.05;
    try {
        make_mannequin(settings);
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("mannequin: edge_length = 0.05"), std::string::npos);
    }
}

} // namespace toile::test
