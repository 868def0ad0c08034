#include "apps/preview/camera.h"

#include <gmock/gmock.h>

#include "tests/apps/preview/render_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace collision;
using namespace preview;

namespace {

using testing::HasSubstr;

TEST(FitCamera, KeepsEveryPointInViewAndWastesNoSpace)
{
    const std::vector<Vec3> points = corners(Bounds{Vec3(-0.4, 0.0, -2.0), Vec3(0.5, 1.8, 0.3)});
    for (const double azimuth : {0.0, 30.0, 145.0, -90.0})
        for (const double elevation : {0.0, 12.0, 80.0, -20.0})
            for (const double aspect : {0.5, 16.0 / 9.0}) {
                CameraSettings settings;
                settings.azimuth_deg = azimuth;
                settings.elevation_deg = elevation;
                const Camera camera = fit_camera(points, settings, aspect);
                double max_coordinate = 0.0;
                for (const Vec3& point : points) {
                    EXPECT_GT((point - camera.origin).dot(camera.forward), 0.0);
                    max_coordinate = std::max(max_coordinate, camera.project(point).cwiseAbs().maxCoeff());
                }
                EXPECT_NEAR(max_coordinate, 0.92, 1e-9) << azimuth << " " << elevation << " " << aspect;
            }
}

TEST(FitCamera, LooksFromTheRequestedSide)
{
    const std::vector<Vec3> points = corners(Bounds{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
    CameraSettings settings;
    settings.azimuth_deg = 90.0;
    settings.elevation_deg = 0.0;
    const Camera camera = fit_camera(points, settings, 1.0);
    EXPECT_LT((camera.forward - Vec3(-1, 0, 0)).norm(), 1e-12);
    EXPECT_LT((camera.right - Vec3(0, 0, -1)).norm(), 1e-12);
    EXPECT_LT((camera.up - Vec3(0, 1, 0)).norm(), 1e-12);
    EXPECT_GT(camera.origin.x(), 1.0);
}

TEST(FitCamera, EnlargesByTheZoom)
{
    const std::vector<Vec3> points = corners(Bounds{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
    CameraSettings settings;
    const Vec2 plain = fit_camera(points, settings, 1.5).project(points[6]);
    settings.zoom = 2.0;
    EXPECT_LT((fit_camera(points, settings, 1.5).project(points[6]) - 2.0 * plain).norm(), 1e-12);
}

TEST(FitCamera, RefusesInvalidSettings)
{
    const std::vector<Vec3> points = {Vec3::Zero(), Vec3::Ones()};
    const auto message = [&](const CameraSettings& settings) {
        return refusal([&] { fit_camera(points, settings, 1.0); });
    };
    EXPECT_THAT(refusal([] { fit_camera(std::vector<Vec3>{}, {}, 1.0); }), HasSubstr("nothing to show"));
    EXPECT_THAT(message({.fov_deg = 0.0}), HasSubstr("fov"));
    EXPECT_THAT(message({.elevation_deg = 90.0}), HasSubstr("elevation"));
    EXPECT_THAT(message({.zoom = 0.0}), HasSubstr("zoom"));
}

TEST(Camera, ProjectsAPointToThePixelOfItsRay)
{
    const std::vector<Vec3> points = corners(Bounds{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
    const Camera camera = fit_camera(points, {}, 4.0 / 3.0);
    const Vec3 point = camera.origin + 3.7 * camera.direction(0.3, -0.6);
    EXPECT_LT((camera.project(point) - Vec2(0.3, -0.6)).norm(), 1e-12);
}

TEST(Camera, GivesTheWholePictureOrACrop)
{
    Camera camera;
    EXPECT_EQ(camera.picture_coordinates(0.0, 0.0), Vec2(-1.0, 1.0));
    EXPECT_EQ(camera.picture_coordinates(1.0, 1.0), Vec2(1.0, -1.0));
    camera.crop = {.left = 0.5, .top = 0.25, .right = 0.75, .bottom = 1.0};
    EXPECT_EQ(camera.picture_coordinates(0.0, 0.0), Vec2(0.0, 0.5));
    EXPECT_EQ(camera.picture_coordinates(1.0, 1.0), Vec2(0.5, -1.0));
}

TEST(AimedAt, PutsThePointIntoTheMiddleAtTheSameDistance)
{
    const std::vector<Vec3> points = corners(Bounds{Vec3(-1, 0, -1), Vec3(1, 2, 3)});
    const Camera fitted = fit_camera(points, {}, 1.5);
    const Vec3 target(0.3, 0.2, 4.0), before(0.0, 1.0, 1.0);
    const Camera camera = aimed_at(fitted, target, before);
    EXPECT_LT(camera.project(target).norm(), 1e-12);
    EXPECT_NEAR((target - camera.origin).norm(), (before - fitted.origin).dot(fitted.forward), 1e-12);
    EXPECT_EQ(camera.forward, fitted.forward);
}

TEST(Turned, SeesACylinderAlikeFromAllAround)
{
    const Bounds box{Vec3(-0.4, 0.0, -0.2), Vec3(0.5, 1.8, 0.3)};
    const std::vector<Vec3> points = cylinder_around(box);
    for (const Vec3& corner : corners(box))
        EXPECT_LE(std::hypot(corner.x() - box.center().x(), corner.z() - box.center().z()),
                  std::hypot(points[0].x() - box.center().x(), points[0].z() - box.center().z()) + 1e-12);
    const Camera fitted = fit_camera(points, {.azimuth_deg = 20.0}, 1.0);
    const Camera direct = fit_camera(points, {.azimuth_deg = 20.0 + 45.0}, 1.0);
    const Camera camera = turned(fitted, 45.0, box.center());
    EXPECT_LT((camera.origin - direct.origin).norm(), 1e-9);
    EXPECT_LT((camera.forward - direct.forward).norm(), 1e-12);
    EXPECT_LT((camera.up - direct.up).norm(), 1e-12);
}

} // namespace
} // namespace toile::test
