#include "scenes/drape/garment_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "garment/energy/membrane.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/pattern/panels.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

constexpr double kWidth = 0.3, kHeight = 0.2; // [m]
const garment::Membrane::Settings kWoven{600.0, 200.0, 40.0};

/// A panel whose loop runs counter-clockwise, or clockwise as those of backs.
garment::Pattern panel(double grain_deg, bool clockwise)
{
    garment::Pattern pattern;
    pattern.source = "panel";
    pattern.panels = {clockwise ? polygon("p", {{0.0, 0.0}, {0.0, kHeight}, {kWidth, kHeight}, {kWidth, 0.0}})
                                : rectangle("p", kWidth, kHeight)};
    pattern.panels[0].grain_deg = grain_deg;
    return pattern;
}

Vec2 warp(double grain_deg)
{
    const double angle = grain_deg * std::numbers::pi / 180.0;
    return {-std::sin(angle), std::cos(angle)};
}

class GarmentMeshTest : public ::testing::Test {
protected:
    /// Elastic energy [J] of a panel deformed in its plane, as a scene loads it from its files.
    double energy(const garment::Pattern& pattern, const Mat2& F)
    {
        const GarmentMesh mesh(pattern, 0.05);
        std::vector<Vec3> x;
        for (const Vec2& p : mesh.panels.uv)
            x.emplace_back((F * p).x(), (F * p).y(), 0.0);
        const GarmentSurface surface = mesh.surface(weld(mesh.sewn, x));
        EXPECT_EQ(surface.mesh.texture_coordinates, mesh.panels.uv);
        write_obj(folder_.path() / "p.obj", surface.mesh);
        std::string rest_file;
        if (!surface.rest.empty()) {
            write_obj(folder_.path() / "p_rest.obj", surface.rest_mesh());
            rest_file = R"(, "rest_file": "p_rest.obj")";
        }
        const Scene scene = parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "p", "file": "p.obj",
            "rest": "uv", "uv_scale": 1)" + rest_file +
                                            "}]}",
                                        folder_.path() / "scene.json");
        const LoadedCloth loaded = load_cloth(scene, scene.cloths[0], {}, {});
        garment::Membrane membrane(loaded.rest, kWoven, "p");
        return value_of(membrane, loaded.state.positions);
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(GarmentMeshTest, StretchesByTheModuliAlongTheGrain)
{
    constexpr double kStretch = 0.02;
    for (const bool clockwise : {false, true})
        for (const double grain : {0.0, 30.0, 90.0, -50.0}) {
            const garment::Pattern pattern = panel(grain, clockwise);
            const Vec2 u = warp(grain), v(u.y(), -u.x());
            const double per_modulus = 0.5 * kStretch * kStretch * kWidth * kHeight; // [m^2]
            EXPECT_NEAR(energy(pattern, Mat2::Identity()), 0.0, 1e-14);
            EXPECT_NEAR(energy(pattern, Mat2::Identity() + kStretch * u * u.transpose()),
                        kWoven.warp * per_modulus, 1e-6 * kWoven.warp * per_modulus)
                << grain;
            EXPECT_NEAR(energy(pattern, Mat2::Identity() + kStretch * v * v.transpose()),
                        kWoven.weft * per_modulus, 1e-6 * kWoven.weft * per_modulus)
                << grain;
        }
}

TEST_F(GarmentMeshTest, HasNoRestShapeOfItsOwnWithoutGrain)
{
    EXPECT_TRUE(GarmentMesh(panel(0.0, false), 0.05).rest.empty());
    EXPECT_FALSE(GarmentMesh(panel(1.0, false), 0.05).rest.empty());
}

} // namespace toile::test
