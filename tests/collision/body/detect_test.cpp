#include "collision/body/detect.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/base/stages.h"
#include "core/mesh/topology.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::box_mesh;
using testing::merged;
using testing::sheet_mesh;
using testing::sphere_mesh;

MovingMesh still(const TriangleMesh& mesh) { return {mesh.triangles, mesh.positions, mesh.positions}; }

std::vector<ContactPair> detect(const TriangleMesh& cloth, const MeshCollider& collider,
                                const DetectSettings& settings)
{
    ContactDetector detector(cloth.triangles, cloth.positions);
    std::vector<ContactPair> pairs;
    detector.detect(collider, 7, settings, pairs);
    return pairs;
}

std::vector<ContactPair> of_kind(const std::vector<ContactPair>& pairs, ContactKind kind)
{
    std::vector<ContactPair> result;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(result),
                 [&](const ContactPair& pair) { return pair.kind == kind; });
    return result;
}

void expect_well_formed(const std::vector<ContactPair>& pairs)
{
    for (const ContactPair& pair : pairs) {
        ASSERT_TRUE(pair.point.allFinite() && pair.motion.allFinite());
        ASSERT_NEAR(pair.normal.norm(), 1.0, 1e-9);
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            ASSERT_GE(pair.weight[k], 0.0);
            sum += pair.weight[k];
        }
        ASSERT_NEAR(sum, 1.0, 1e-12);
        ASSERT_EQ(pair.collider, 7);
    }
}

bool equal_bits(const ContactPair& a, const ContactPair& b)
{
    return a.vertex == b.vertex && a.weight == b.weight && a.normal == b.normal && a.point == b.point &&
           a.motion == b.motion && a.kind == b.kind && a.feature == b.feature;
}

/// One cloth triangle with a vertex hanging down at `lowest`, the rest far above.
TriangleMesh hanging_corner(const Vec3& lowest)
{
    return {{lowest, lowest + Vec3(0.3, 0.5, 0.1), lowest + Vec3(0.1, 0.5, 0.3)}, {{0, 2, 1}}};
}

TEST(ContactDetector, PairsAVertexWithThePlateBelowIt)
{
    TriangleMesh plate = box_mesh(Vec3(-1, -0.1, -1), Vec3(1, 0, 1));
    MovingMesh moving = still(plate);
    for (Vec3& x : moving.x_t0)
        x -= Vec3(0.02, 0.03, 0.0);
    const TriangleMesh cloth = hanging_corner(Vec3(0.2, 0.004, 0.3));
    const auto pairs = detect(cloth, MeshCollider(moving), {});
    expect_well_formed(pairs);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].kind, ContactKind::kVertexFace);
    EXPECT_EQ(pairs[0].vertex, contact_vertices(0));
    EXPECT_LT((pairs[0].normal - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((pairs[0].point - Vec3(0.2, 0, 0.3)).norm(), 1e-12);
    EXPECT_LT((pairs[0].motion - Vec3(0.02, 0.03, 0)).norm(), 1e-12);
    EXPECT_NEAR(pairs[0].gap(cloth.positions), 0.004, 1e-12);
    EXPECT_TRUE(detect(hanging_corner(Vec3(0.2, 0.0101, 0.3)), MeshCollider(moving), {}).empty());
}

TEST(ContactDetector, ProjectsPenetratingVerticesUpToTheDepthLimit)
{
    const MeshCollider block(still(box_mesh(Vec3(-1, -1, -1), Vec3(1, 0, 1))));
    const TriangleMesh cloth = hanging_corner(Vec3(0.2, -0.06, 0.3));
    const auto pairs = of_kind(detect(cloth, block, {}), ContactKind::kVertexFace);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_LT((pairs[0].normal - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_NEAR(pairs[0].gap(cloth.positions), -0.06, 1e-12);
    DetectSettings shallow;
    shallow.max_depth = 0.05;
    EXPECT_TRUE(of_kind(detect(cloth, block, shallow), ContactKind::kVertexFace).empty());
}

TEST(ContactDetector, GivesAVertexOnePlanePerWallOfACorner)
{
    // Three slabs that meet in a concave corner at the origin; they overlap each other, as bodies do.
    TriangleMesh corner = box_mesh(Vec3(-0.5, -0.5, -0.5), Vec3(1, 0, 1));
    corner = merged(corner, box_mesh(Vec3(-0.5, -0.5, -0.5), Vec3(0, 1, 1)));
    const MeshCollider two_walls(still(corner));
    const MeshCollider three_walls(still(merged(corner, box_mesh(Vec3(-0.5, -0.5, -0.5), Vec3(1, 1, 0)))));
    const TriangleMesh cloth = hanging_corner(Vec3(0.005, 0.004, 0.006));
    const auto two = of_kind(detect(cloth, two_walls, {}), ContactKind::kVertexFace);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_LT((two[0].normal - Vec3::UnitY()).norm(), 1e-12) << "nearest first";
    EXPECT_LT((two[1].normal - Vec3::UnitX()).norm(), 1e-12);
    const auto three = of_kind(detect(cloth, three_walls, {}), ContactKind::kVertexFace);
    ASSERT_EQ(three.size(), 3u);
    EXPECT_LT((three[2].normal - Vec3::UnitZ()).norm(), 1e-12);
    const MeshCollider floor(still(box_mesh(Vec3(-0.5, -0.5, -0.5), Vec3(1, 0, 1))));
    EXPECT_EQ(of_kind(detect(cloth, floor, {}), ContactKind::kVertexFace).size(), 1u);
}

/// Tetrahedron standing on its face, its apex at the origin.
TriangleMesh spike()
{
    return {{{0, 0, 0}, {0.1, -0.3, 0.1}, {-0.1, -0.3, 0.1}, {0, -0.3, -0.15}},
            {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
}

TEST(ContactDetector, PairsAClothFaceWithTheTipBelowIt)
{
    for (const double height : {0.006, -0.007}) {
        const TriangleMesh cloth = {{{-0.5, height, -0.5}, {0.7, height, -0.5}, {-0.5, height, 0.8}},
                                    {{0, 2, 1}}};
        const auto pairs = detect(cloth, MeshCollider(still(spike())), {});
        expect_well_formed(pairs);
        const auto tips = of_kind(pairs, ContactKind::kFaceVertex);
        ASSERT_EQ(tips.size(), 1u) << height;
        EXPECT_EQ(tips[0].feature, 0);
        EXPECT_EQ(tips[0].point, Vec3::Zero());
        EXPECT_GT(tips[0].normal.y(), 0.9);
        EXPECT_NEAR(tips[0].gap(cloth.positions), height * tips[0].normal.y(), 1e-12);
        Vec3 at = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            at += tips[0].weight[k] * cloth.positions[tips[0].vertex[k]];
        EXPECT_LT((at - Vec3(0, height, 0)).norm(), 1e-12);
        EXPECT_TRUE(of_kind(pairs, ContactKind::kVertexFace).empty()) << "the cloth's vertices are far away";

        DetectSettings off;
        off.face_vertex = false;
        EXPECT_TRUE(
            of_kind(detect(cloth, MeshCollider(still(spike())), off), ContactKind::kFaceVertex).empty());
    }
}

/// Ridge along x at height 0: a roof of 90 degrees.
TriangleMesh roof()
{
    return {{{-1, 0, 0}, {1, 0, 0}, {-1, -1, 1}, {1, -1, 1}, {-1, -1, -1}, {1, -1, -1}},
            {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}}};
}

TEST(ContactDetector, PairsCrossedEdges)
{
    for (const double height : {0.006, -0.004}) {
        // The edge (0, 1) crosses the ridge at right angles; vertex 2 is far up.
        const TriangleMesh cloth = {{{0.2, height, -0.4}, {0.2, height, 0.6}, {0.3, 0.8, 0.1}}, {{0, 1, 2}}};
        const auto pairs = detect(cloth, MeshCollider(still(roof())), {});
        expect_well_formed(pairs);
        ASSERT_EQ(pairs.size(), 1u) << height;
        EXPECT_EQ(pairs[0].kind, ContactKind::kEdgeEdge);
        EXPECT_EQ(pairs[0].vertex, contact_vertices(0, 1));
        EXPECT_NEAR(pairs[0].weight[1], 0.4, 1e-12);
        EXPECT_LT((pairs[0].normal - Vec3::UnitY()).norm(), 1e-12);
        EXPECT_LT((pairs[0].point - Vec3(0.2, 0, 0)).norm(), 1e-12);
        EXPECT_NEAR(pairs[0].gap(cloth.positions), height, 1e-12);

        DetectSettings off;
        off.edge_edge = false;
        EXPECT_TRUE(detect(cloth, MeshCollider(still(roof())), off).empty());
    }
}

TEST(ContactDetector, MakesNoEdgePairsAtFlatEdgesAndValleys)
{
    TriangleMesh valley = roof();
    for (Vec3& x : valley.positions)
        x.y() = -x.y();
    const TriangleMesh cloth = {{{0.2, 0.006, -0.4}, {0.2, 0.006, 0.6}, {0.3, 0.8, 0.1}}, {{0, 1, 2}}};
    EXPECT_TRUE(of_kind(detect(cloth, MeshCollider(still(valley)), {}), ContactKind::kEdgeEdge).empty());
    const MeshCollider flat(still(sheet_mesh(0.7, 3, 0.0)));
    for (const ContactPair& pair : of_kind(detect(cloth, flat, {}), ContactKind::kEdgeEdge))
        EXPECT_EQ(flat.surface().edges().triangles.of(pair.feature).size(), 1) << "only the border";
}

TEST(ContactDetector, DoesNotPullClothThroughAThinPart)
{
    // Cloth below a 4 mm plate: its upper side's vertices and edges are within the radius, behind it.
    const TriangleMesh thin = subdivide(box_mesh(Vec3(-0.1, -0.004, -0.1), Vec3(0.1, 0.0, 0.1)), 3);
    const TriangleMesh cloth = sheet_mesh(0.11, 5, -0.006);
    const auto pairs = detect(cloth, MeshCollider(still(thin)), {});
    expect_well_formed(pairs);
    EXPECT_GT(pairs.size(), 10u);
    for (const ContactPair& pair : pairs)
        EXPECT_LT(pair.normal.y(), 0.0);
}

TEST(ContactDetector, FindsEveryVertexWithinTheRadiusAndNoOther)
{
    const TriangleMesh body = sphere_mesh(Vec3(0.2, 1.0, 0.1), 0.2, 3);
    TriangleMesh cloth = sheet_mesh(0.6, 40, 1.195);
    std::mt19937 random(30);
    std::uniform_real_distribution<double> uniform(-0.01, 0.01);
    for (Vec3& x : cloth.positions)
        x += Vec3(uniform(random), uniform(random), uniform(random));
    const auto pairs = of_kind(detect(cloth, MeshCollider(still(body)), {}), ContactKind::kVertexFace);

    std::map<int, double> expected; // vertex -> signed distance, by brute force on a convex body
    for (int v = 0; v < cloth.vertex_count(); ++v) {
        double nearest2 = 1e300, highest = -1e300;
        for (const Triangle& t : body.triangles) {
            const Vec3 &a = body.positions[t[0]], &b = body.positions[t[1]], &c = body.positions[t[2]];
            nearest2 = std::min(nearest2, closest_on_triangle(cloth.positions[v], a, b, c).distance2);
            highest = std::max(highest, (b - a).cross(c - a).normalized().dot(cloth.positions[v] - a));
        }
        const double signed_distance = std::copysign(std::sqrt(nearest2), highest);
        if (signed_distance < 0.01 && signed_distance > -0.1)
            expected[v] = signed_distance;
    }
    ASSERT_GT(expected.size(), 50u);
    std::map<int, double> found;
    for (const ContactPair& pair : pairs)
        found.emplace(pair.vertex[0], pair.gap(cloth.positions));
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [v, gap] : found)
        EXPECT_NEAR(gap, expected.at(v), 1e-9);
}

/// True if the edge of a closed mesh is convex by at least 1 degree, by the tetrahedron over it.
bool is_ridge(const TriangleMesh& mesh, const Edge& edge)
{
    const Vec3 &a = mesh.positions[edge.vertex[0]], &b = mesh.positions[edge.vertex[1]];
    const Vec3 &c = mesh.positions[edge.opposite[0]], &d = mesh.positions[edge.opposite[1]];
    const Vec3 left = (b - a).cross(c - a), right = (d - a).cross(b - a);
    const double angle = std::atan2(left.cross(right).norm(), left.dot(right));
    return left.dot(d - a) < 0.0 && angle > M_PI / 180.0;
}

TEST(ContactDetector, FindsEveryCrossingOfEdgesWithinTheRadius)
{
    const TriangleMesh body = sphere_mesh(Vec3(0.2, 1.0, 0.1), 0.2, 4);
    const MeshCollider collider(still(body));
    TriangleMesh cloth = sheet_mesh(0.6, 37, 1.202); // above the ball: no penetration
    for (Vec3& x : cloth.positions)
        x.y() += 0.002 * std::sin(40.0 * x.x()) + 0.003;
    std::set<std::array<int, 3>> found;
    for (const ContactPair& pair : of_kind(detect(cloth, collider, {}), ContactKind::kEdgeEdge))
        EXPECT_TRUE(found.insert({pair.vertex[0], pair.vertex[1], pair.feature}).second);

    const Topology cloth_topology = build_topology(cloth.triangles, cloth.vertex_count(), "cloth");
    const Topology body_topology = build_topology(body.triangles, body.vertex_count(), "body");
    std::set<std::array<int, 3>> expected;
    for (const Edge& edge : cloth_topology.edges)
        for (int e = 0; e < int(body_topology.edges.size()); ++e) {
            const Vec3 &a0 = cloth.positions[edge.vertex[0]], &a1 = cloth.positions[edge.vertex[1]];
            const Vec3 &b0 = body.positions[body_topology.edges[e].vertex[0]],
                       &b1 = body.positions[body_topology.edges[e].vertex[1]];
            const ClosestOnSegments closest = closest_on_segments(a0, a1, b0, b1);
            const Vec3 across = a0 + closest.s * (a1 - a0) - b0 - closest.t * (b1 - b0);
            const Vec3 outwards =
                0.5 * (b0 + b1) - Vec3(0.2, 1.0, 0.1); // the ball's ridges point away from it
            if (is_ridge(body, body_topology.edges[e]) && closest.s > 0 && closest.s < 1 && closest.t > 0 &&
                closest.t < 1 && closest.distance2 < 1e-4 &&
                across.normalized().dot(outwards.normalized()) > 0.5)
                expected.insert(
                    {std::min(edge.vertex[0], edge.vertex[1]), std::max(edge.vertex[0], edge.vertex[1]), e});
        }
    EXPECT_GT(expected.size(), 30u);
    EXPECT_EQ(found, expected);
}

TEST(ContactDetector, FindsEveryColliderVertexBelowAClothFace)
{
    const TriangleMesh body = sphere_mesh(Vec3(0.2, 1.0, 0.1), 0.2, 4);
    const TriangleMesh cloth = sheet_mesh(0.9, 3, 1.204);
    const auto pairs = of_kind(detect(cloth, MeshCollider(still(body)), {}), ContactKind::kFaceVertex);
    std::set<int> found, expected;
    for (const ContactPair& pair : pairs)
        found.insert(pair.feature);
    for (int v = 0; v < body.vertex_count(); ++v)
        if (1.204 - body.positions[v].y() < 0.01)
            expected.insert(v);
    EXPECT_GT(expected.size(), 20u);
    EXPECT_EQ(found, expected);
}

TEST(ContactDetector, NeverRefitsAStaticCollider)
{
    const TriangleMesh body = sphere_mesh(Vec3::Zero(), 0.2, 3);
    const TriangleMesh cloth = sheet_mesh(0.5, 10, 0.203);
    MeshCollider collider(still(body));
    ContactDetector detector(cloth.triangles, cloth.positions);
    std::vector<ContactPair> pairs;
    Stages stages;
    const Stages::Activate activate(stages);
    for (int i = 0; i < 3; ++i) {
        detector.move(cloth.positions);
        collider.move(still(body));
        detector.detect(collider, 0, {}, pairs);
    }
    EXPECT_EQ(stages.calls("collision/refit"), 0);
    EXPECT_EQ(stages.calls("collision/vertex_face"), 3);
    EXPECT_EQ(stages.calls("collision/cloth_refit"), 3);

    MovingMesh moved = still(body);
    moved.x_t1[5] += Vec3(0, 0.001, 0);
    for (int i = 0; i < 2; ++i) {
        collider.move(moved);
        EXPECT_EQ(stages.calls("collision/refit"), i) << "nobody has asked yet";
        detector.detect(collider, 0, {}, pairs);
        EXPECT_EQ(collider.surface().positions()[5], moved.x_t1[5]);
        EXPECT_EQ(stages.calls("collision/refit"), i + 1);
        moved.x_t1[5] += Vec3(0, 0.001, 0);
    }
}

TEST(ContactDetector, SkipsADistantCollider)
{
    const MeshCollider collider(still(sphere_mesh(Vec3(0, 5, 0), 0.2, 2)));
    Stages stages;
    const Stages::Activate activate(stages);
    EXPECT_TRUE(detect(sheet_mesh(0.5, 10, 0.0), collider, {}).empty());
    EXPECT_EQ(stages.calls("collision/vertex_face"), 0);
    EXPECT_EQ(stages.calls("collision/cloth_refit"), 0);
}

TEST(ContactDetector, FollowsTheColliderAndReportsItsMotion)
{
    MovingMesh moving = still(sphere_mesh(Vec3::Zero(), 0.2, 3));
    MeshCollider collider(moving);
    for (Vec3& x : moving.x_t1)
        x += Vec3(0, 1.0, 0);
    collider.move(moving);
    const auto pairs = detect(sheet_mesh(0.5, 10, 1.203), collider, {});
    EXPECT_FALSE(pairs.empty());
    for (const ContactPair& pair : pairs)
        EXPECT_LT((pair.motion - Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST(ContactDetector, SurvivesSelfIntersectingAndCollapsedColliders)
{
    MovingMesh moving =
        still(merged(sphere_mesh(Vec3(0, 0, 0), 0.2, 2), sphere_mesh(Vec3(0.1, 0.05, 0), 0.2, 2)));
    MeshCollider collider(moving);
    for (int v = 0; v < int(moving.x_t1.size()); ++v) {
        if (moving.x_t1[v].x() > 0.1)
            moving.x_t1[v] = Vec3(0.1, 0.1, 0.0);
        if (v % 3 == 0)
            moving.x_t1[v].z() = 0.0;
    }
    collider.move(moving);
    for (const double height : {0.0, 0.1, 0.15})
        expect_well_formed(detect(sheet_mesh(0.5, 30, height), collider, {}));
}

TEST(ContactDetector, GivesTheSamePairsInTheSameOrderForEveryThreadCount)
{
    TriangleMesh body = merged(sphere_mesh(Vec3(0, 1, 0), 0.2, 4), sphere_mesh(Vec3(0.15, 1.05, 0), 0.15, 4));
    TriangleMesh cloth = merged(sheet_mesh(0.6, 40, 1.201), sheet_mesh(0.6, 33, 1.17));
    std::vector<ContactPair> reference;
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        MeshCollider collider(still(body));
        const auto pairs = detect(cloth, collider, {});
        if (threads == 1)
            reference = pairs;
        for (const ContactKind kind :
             {ContactKind::kVertexFace, ContactKind::kFaceVertex, ContactKind::kEdgeEdge})
            EXPECT_GT(of_kind(pairs, kind).size(), 50u);
        ASSERT_EQ(pairs.size(), reference.size());
        for (size_t i = 0; i < pairs.size(); ++i)
            ASSERT_TRUE(equal_bits(pairs[i], reference[i])) << i;
        EXPECT_TRUE(
            std::is_sorted(pairs.begin(), pairs.end(), [](const ContactPair& a, const ContactPair& b) {
                return std::tie(a.kind, a.vertex) < std::tie(b.kind, b.vertex);
            }));
    }
}

} // namespace
} // namespace toile::test
