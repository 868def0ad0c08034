#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/SVD>

#include "core/mesh/obj.h"
#include "garment/pattern/mesh/gathers.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/garment/pattern/panels.h"
#include "tests/support/temporary_folder.h"

/// Gathered cloth in motion, without gravity.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kBand = 0.3, kSkirt = 0.6; // [m] widths of the sides of a seam
constexpr double kBandHeight = 0.06, kSkirtHeight = 0.16;

/// A skirt sewn to a band that is half as wide.
struct GatheredSkirt {
    Pattern pattern;
    PatternMesh mesh;
    SewnMesh sewn;

    GatheredSkirt()
    {
        pattern.source = "skirt";
        pattern.panels = {rectangle("band", kBand, kBandHeight), rectangle("skirt", kSkirt, kSkirtHeight)};
        pattern.seams = {seam(forward(0, 0), backward(1, 2))};
        mesh = mesh_pattern(pattern, {0.02, {}, {}});
        sewn = sewn_mesh(mesh);
    }

    /// The skirt as wide as the band, in waves of 5 cm that begin below the seam. [welded vertices] [m]
    std::vector<Vec3> squeezed() const
    {
        std::vector<Vec3> x(size_t(sewn.vertex_count));
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Vec2& q = mesh.uv[size_t(v)];
            const bool is_skirt = mesh.panel_of_vertex(v) == 1;
            const double below = is_skirt ? kSkirtHeight - q.y() : 0.0;
            const double across = q.x() * (is_skirt ? kBand / kSkirt : 1.0);
            x[size_t(sewn.welded_of[size_t(v)])] =
                Vec3(across, is_skirt ? -below : q.y(),
                     0.1 * below * std::sin(2.0 * std::numbers::pi * across / 0.05));
        }
        return x;
    }

    /// The squeezed surface with a texture for each corner.
    ObjMesh with_texture(const std::vector<FlatTriangle>& texture) const
    {
        ObjMesh obj;
        obj.positions = squeezed();
        for (size_t t = 0; t < texture.size(); ++t) {
            const auto first = int(obj.texture_coordinates.size());
            obj.texture_coordinates.insert(obj.texture_coordinates.end(), texture[t].begin(),
                                           texture[t].end());
            const Triangle& corner = sewn.triangles[t];
            obj.polygons.push_back({corner[0], corner[1], corner[2]});
            obj.polygon_uvs.push_back({first, first + 1, first + 2});
        }
        return obj;
    }

    std::vector<FlatTriangle> flat() const
    {
        std::vector<FlatTriangle> triangles;
        for (const Triangle& t : mesh.triangles)
            triangles.push_back({mesh.uv[size_t(t[0])], mesh.uv[size_t(t[1])], mesh.uv[size_t(t[2])]});
        return triangles;
    }
};

/// Principal strains that 95 % of the triangles keep to: the largest stretch, and the largest compression.
/// [-]
std::array<double, 2> strain_of(const std::vector<FlatTriangle>& rest, const scenes::ClothState& cloth)
{
    std::vector<double> stretch, compression;
    for (size_t t = 0; t < rest.size(); ++t) {
        const auto x = [&](int k) { return cloth.positions[size_t(cloth.triangles[t][k])]; };
        Mat2 D;
        D << rest[t][1] - rest[t][0], rest[t][2] - rest[t][0];
        Eigen::Matrix<double, 3, 2> E;
        E << x(1) - x(0), x(2) - x(0);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(E * D.inverse()));
        stretch.push_back(svd.singularValues()[0] - 1.0);
        compression.push_back(1.0 - svd.singularValues()[1]);
    }
    const auto quantile = [](std::vector<double>& values) {
        std::sort(values.begin(), values.end());
        return values[values.size() * 95 / 100];
    };
    return {quantile(stretch), quantile(compression)};
}

} // namespace

/// Cloth buckles into the rest shape of a gather. As it is cut, the first row stays compressed.
TEST(GatheredCloth, HasLittleStrainAtRest)
{
    const GatheredSkirt skirt;
    ASSERT_FALSE(skirt.sewn.is_turned[0] || skirt.sewn.is_turned[1]);
    const TemporaryFolder folder;
    write_obj(folder.path() / "cut.obj", skirt.with_texture(skirt.flat()));
    const std::vector<FlatTriangle> gathered = gathered_rest(skirt.pattern, skirt.mesh);
    write_obj(folder.path() / "gathered.obj", skirt.with_texture(gathered));
    const auto strain = [&](const std::string& keys, const std::vector<FlatTriangle>& rest) {
        scenes::World world(scenes::parse_scene(
            R"({"toile": 1, "frames": 30, "gravity": [0, 0, 0], "cloths": [{"name": "c", "file": "cut.obj",
            "rest": "uv", "uv_scale": 1)" +
                keys + R"(}], "attachments": [{"cloth": "c", "select": {"box": {"lower": [-1, 0.0599, -1],
                "upper": [1, 1, 1]}}}]})",
            folder.path() / "scene.json"));
        world.settle();
        while (world.frame() + 1 < world.frame_count())
            EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
        return strain_of(rest, world.cloths()[0]);
    };
    const auto [stretch, compression] = strain(R"(, "rest_file": "gathered.obj")", gathered);
    EXPECT_LT(stretch, 0.015);
    EXPECT_LT(compression, 0.01);
    const auto [cut_stretch, cut_compression] = strain("", skirt.flat());
    EXPECT_GT(cut_stretch, 0.05);
    EXPECT_GT(cut_compression, 0.08);
}

} // namespace toile::test
