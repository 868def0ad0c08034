#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Cloths whose mesh lies in a cache.
namespace toile::test {

using namespace scenes;
using testing::HasSubstr;

namespace {

/// Sheet of 4 x 4 quads, 0.4 m wide, in two groups, with a texture that is as wide as it.
ObjMesh sheet()
{
    constexpr int kCells = 4;
    ObjMesh mesh;
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i) {
            mesh.positions.push_back(Vec3(0.125 * i, 0.5, 0.125 * j));
            mesh.texture_coordinates.push_back(Vec2(0.125 * i, -0.125 * j));
        }
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            const int v = j * (kCells + 1) + i;
            mesh.polygons.push_back({v, v + kCells + 1, v + kCells + 2, v + 1});
            mesh.polygon_uvs.push_back(mesh.polygons.back());
        }
    mesh.groups = {{0, "front"}, {8, "back"}};
    return mesh;
}

class CachedCloth : public FileTest {
protected:
    CachedCloth()
    {
        write_obj(file("sheet.obj"), sheet());
        write_cache("sheet.abc", sheet());
    }

    /// Three samples, of which the first is the mesh.
    void write_cache(const std::string& name, const ObjMesh& mesh) const
    {
        const auto writer = exports::make_cache_writer(file(name), exports::cache_layout(mesh, 3));
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec3> x = mesh.positions;
            for (Vec3& p : x)
                p.y() += k;
            writer->write(k, x);
        }
        writer->finish();
    }

    Scene scene(const std::string& cloth) const
    {
        return parse_scene(R"({"toile": 1, "frames": 4, "cloths": [{"name": "c", )" + cloth + "}]}",
                           file("scene.json"));
    }
    LoadedCloth load(const std::string& cloth) const
    {
        const Scene scene = this->scene(cloth);
        return load_cloth(scene, scene.cloths[0], {}, {});
    }
    std::string complaint(const std::string& cloth) const
    {
        return refusal([&] { load(cloth); });
    }
};

TEST_F(CachedCloth, IsThatOfTheObj)
{
    const std::string keys = R"(, "rest": "uv", "uv_scale": 1, "groups": {"back": {"fabric": "denim"}})";
    const LoadedCloth from_obj = load(R"("file": "sheet.obj")" + keys);
    for (const std::string name : {"sheet.abc", "sheet.abc#/sheet/sheetShape"}) {
        const LoadedCloth loaded = load(std::string("\"file\": \"").append(name).append("\"").append(keys));
        EXPECT_EQ(loaded.state.positions, from_obj.state.positions);
        EXPECT_EQ(loaded.state.triangles, from_obj.state.triangles);
        EXPECT_EQ(loaded.state.panels, from_obj.state.panels);
        EXPECT_EQ(loaded.state.fabric_of_triangle, from_obj.state.fabric_of_triangle);
        EXPECT_EQ(loaded.state.rest.groups, from_obj.state.rest.groups);
        EXPECT_EQ(loaded.rest->edges, from_obj.rest->edges);
    }
}

TEST_F(CachedCloth, PlaysItsOwnCacheOnItsMesh)
{
    World world(scene(R"("file": "sheet.abc")"));
    const exports::CacheLayout layout = exports::cache_layout(world.cloths()[0].file_mesh(), 2);
    const auto writer = exports::make_cache_writer(file("run.abc"), layout);
    writer->write(0, world.cloths()[0].positions);
    static_cast<void>(world.advance_frame());
    writer->write(1, world.cloths()[0].positions);
    writer->finish();
    const exports::PointCache before = exports::read_cache(file("sheet.abc")),
                              after = exports::read_cache(file("run.abc"));
    EXPECT_EQ(after.mesh()->polygons, before.mesh()->polygons);
    EXPECT_EQ(after.mesh()->polygon_uvs, before.mesh()->polygon_uvs);
    EXPECT_EQ(after.frame(0), before.frame(0));
    EXPECT_NE(after.frame(1), before.frame(1));
}

TEST_F(CachedCloth, BeginsASequence)
{
    ObjMesh mesh = sheet();
    write_cache("sheet_####.obj", mesh);
    EXPECT_EQ(load(R"("file": "sheet_####.obj")").state.positions, mesh.positions);
}

TEST_F(CachedCloth, HasTheUnitOfTheScene)
{
    const LoadedCloth loaded = load(R"("file": "sheet.abc", "unit": "cm")");
    EXPECT_NEAR(loaded.state.positions.back().x(), 0.005, 1e-12);
}

TEST_F(CachedCloth, TakesItsRestShapeFromAnArchive)
{
    ObjMesh narrow = sheet();
    for (Vec2& uv : narrow.texture_coordinates)
        uv.x() *= 0.5;
    write_cache("rest.abc", narrow);
    write_obj(file("rest.obj"), narrow);
    const std::string keys = R"("file": "sheet.abc", "rest": "uv", "uv_scale": 1, "rest_file": )";
    EXPECT_EQ(load(keys + R"("rest.abc#/rest/restShape")").state.panels,
              load(keys + R"("rest.obj")").state.panels);
}

TEST_F(CachedCloth, NamesFacesWhereThereAreNoLines)
{
    ObjMesh collapsed = sheet();
    for (const int v : collapsed.polygons[0])
        collapsed.texture_coordinates[size_t(v)] = Vec2::Zero();
    write_cache("collapsed.abc", collapsed);
    EXPECT_THAT(complaint(R"("file": "collapsed.abc", "rest": "uv")"),
                HasSubstr("collapsed.abc (face 0): the face has no area"));
    ObjMesh turned = sheet();
    std::reverse(turned.polygons[2].begin(), turned.polygons[2].end());
    write_cache("turned.abc", turned);
    EXPECT_THAT(complaint(R"("file": "sheet.abc", "rest": "uv", "rest_file": "turned.abc")"),
                HasSubstr("turned.abc (face 2): the face has vertices"));
}

TEST_F(CachedCloth, IsRefusedWithTheRemedy)
{
    temporary_.write("old.abc", "\x89HDF\r\n\x1a\n" + std::string(600, 'x'));
    const std::pair<std::string, std::string> cases[] = {
        {R"("file": "old.abc")", "is an Alembic archive of the old HDF5 kind; convert it"},
        {R"("file": "sheet.pc2")", R"(cloths[0].file: "sheet.pc2" has no faces; name the OBJ)"},
        {R"("file": "sheet.abc#/other")", "has no mesh /other; its meshes are /sheet/sheetShape"},
        {R"("file": "sheet.abc", "rest": "uv", "rest_file": "sheet.mdd")", R"("sheet.mdd" has no faces)"},
        {R"("file": "sheet.stl")",
         R"("sheet.stl" is of an unknown format; use .obj, .ply, .abc, .usda or .usdc)"},
    };
    for (const auto& [cloth, expected] : cases)
        EXPECT_THAT(complaint(cloth), HasSubstr(expected)) << cloth;
}

} // namespace

} // namespace toile::test
