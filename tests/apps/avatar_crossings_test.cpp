#include "apps/toile/check/avatar_crossings.h"

#include <gtest/gtest.h>

#include "core/mesh/obj.h"
#include "core/mesh/weld.h"
#include "scenes/format/read_scene.h"
#include "scenes/meshes/shape_mesh.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace app;
using namespace collision;
using namespace scenes;

namespace {

/// Crossings of a body with a triangle of 2 cm around each of `centers` [m].
AvatarCrossings crossings_at(const TriangleMesh& body, const std::vector<Vec3>& centers)
{
    const TemporaryFolder folder;
    write_obj(folder.path() / "body.obj", body);
    folder.write("scene.json", R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "disc": {}}],
                                   "avatars": [{"name": "b", "file": "body.obj"}]})");
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;
    for (const Vec3& center : centers) {
        const int first = int(x.size());
        triangles.push_back(Triangle(first, first + 1, first + 2));
        x.insert(x.end(), {center + Vec3(-0.01, 0.001, 0), center + Vec3(0.01, 0.001, 0.001),
                           center + Vec3(0.0003, -0.01, 0)});
    }
    return find_avatar_crossings(ScenePenetration(read_scene(folder.path() / "scene.json")), triangles, x);
}

void add_box(TriangleMesh& body, const Vec3& half_size, const Vec3& center)
{
    // Every face of the box has vertices of its own.
    const TriangleMesh box = shape_mesh(BoxShape{half_size}, 0.0);
    const int first = body.vertex_count();
    for (const Vec3& p : box.positions)
        body.positions.push_back(center + p);
    for (const Triangle& t : box.triangles)
        body.triangles.push_back(t + Triangle::Constant(first));
}

const Vec3 kOpenWall(-0.5, 0.13, 0.11);

TEST(AvatarCrossings, CountsCrossingsAtDoubledVerticesAsClean)
{
    TriangleMesh body;
    add_box(body, Vec3::Constant(0.5), Vec3::Zero());
    ASSERT_EQ(body.vertex_count(), 24);
    const AvatarCrossings found = crossings_at(body, {Vec3(0, 0, 0), kOpenWall, Vec3(2, 0, 0)});
    ASSERT_EQ(found.clean.size(), 1u);
    EXPECT_EQ(found.clean[0].body, 0);
    EXPECT_EQ(found.clean[0].crossing.a, 1);
    EXPECT_NEAR(found.clean[0].crossing.point.x(), -0.5, 1e-12);
    EXPECT_EQ(found.pinched.size(), 0);
}

TEST(AvatarCrossings, CountsSelfIntersectingTrianglesSeparately)
{
    // A needle through a wall: the wall's two triangles have their corners and centres in the open.
    TriangleMesh body;
    add_box(body, Vec3::Constant(0.5), Vec3::Zero());
    add_box(body, Vec3(0.2, 0.01, 0.01), Vec3(0.5, 0.031, 0.02));
    const AvatarCrossings found = crossings_at(body, {Vec3(0.5, 0.31, 0.29), kOpenWall});
    EXPECT_EQ(found.clean.size(), 1u);
    EXPECT_EQ(found.pinched.size(), 1);
}

TEST(AvatarCrossings, CountsBuriedTrianglesSeparately)
{
    // A small box within a large one crosses nothing.
    TriangleMesh body;
    add_box(body, Vec3::Constant(0.5), Vec3::Zero());
    add_box(body, Vec3::Constant(0.1), Vec3(0.2, 0.2, 0.2));
    const AvatarCrossings found = crossings_at(weld(body, 0.0).mesh, {Vec3(0.1, 0.23, 0.21), kOpenWall});
    EXPECT_EQ(found.clean.size(), 1u);
    EXPECT_EQ(found.pinched.size(), 1);
}

TEST(AvatarCrossings, OmitsTheFacesOfExcludedBones)
{
    // The column's tip begins at y = 0.5, where a lid closes the base.
    const std::string file = std::string(TOILE_SOURCE_DIR) + "/tests/avatars/bending_column.gltf";
    const auto crossings = [&](const std::string& bones, const Vec3& center) {
        const Scene scene = parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "disc": {}}],
            "avatars": [{"name": "b", "file": ")" +
                                            file + R"(", "exclude_bones": )" + bones + "}]}",
                                        "column.json");
        const std::vector<Vec3> x{center + Vec3(-0.01, 0.01, 0.0), center + Vec3(0.01, 0.01, 0.001),
                                  center + Vec3(0.0003, -0.01, 0.0)};
        return find_avatar_crossings(ScenePenetration(scene), std::vector<Triangle>{Triangle(0, 1, 2)}, x)
            .clean.size();
    };
    const Vec3 tip(0.1, 0.8, 0.02), base(0.1, 0.2, 0.03), lid(0.02, 0.5, 0.03);
    EXPECT_EQ(crossings("[]", tip), 1u);
    EXPECT_EQ(crossings("[\"tip\"]", tip), 0u);
    EXPECT_EQ(crossings("[\"tip\"]", base), 1u);
    EXPECT_EQ(crossings("[]", lid), 0u);
    EXPECT_EQ(crossings("[\"tip\"]", lid), 1u);
}

} // namespace
} // namespace toile::test
