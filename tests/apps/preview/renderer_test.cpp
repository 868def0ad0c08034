#include "apps/preview/renderer.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include "tests/apps/preview/render_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace preview;

namespace {

using testing::HasSubstr;

constexpr RenderSettings kSmall{.width = 160, .height = 120, .samples = 8};

Camera camera_for(const RenderScene& scene, double azimuth_deg, double elevation_deg)
{
    std::vector<Vec3> points;
    for (const RenderMesh& mesh : scene.meshes)
        points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
    const CameraSettings settings{.azimuth_deg = azimuth_deg, .elevation_deg = elevation_deg};
    return fit_camera(points, settings, double(kSmall.width) / kSmall.height);
}

TEST(Renderer, DrawsTheExactSilhouetteOfASphere)
{
    const RenderScene scene{.meshes = {unit_sphere(256)}, .ground_height = {}};
    const Camera camera = camera_for(scene, 20.0, 10.0);
    const Image image = Renderer(scene, kSmall).render(camera);
    const Image empty = Renderer(RenderScene{}, kSmall).render(camera);

    // A ray meets the unit sphere when its distance from the centre is below 1.
    const double half_pixel = camera.tan_half_fov / kSmall.height * camera.origin.norm();
    int inside = 0, outside = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec3 direction =
                camera.direction(2.0 * (x + 0.5) / image.width - 1.0, 1.0 - 2.0 * (y + 0.5) / image.height);
            const double distance = (camera.origin - camera.origin.dot(direction) * direction).norm();
            const bool is_background =
                std::equal(image.pixel(x, y), image.pixel(x, y) + 3, empty.pixel(x, y));
            if (distance < 1.0 - 2.0 * half_pixel) {
                EXPECT_FALSE(is_background) << x << " " << y;
                ++inside;
            } else if (distance > 1.0 + 2.0 * half_pixel) {
                EXPECT_TRUE(is_background) << x << " " << y;
                ++outside;
            }
        }
    EXPECT_GT(inside, 5000);
    EXPECT_GT(outside, 5000);
}

TEST(Renderer, DarkensTheFloorWhereTheSunIsHidden)
{
    const RenderScene scene{.meshes = {square(Vec3(0, 1, 0), true)}, .ground_height = 0.0};
    CameraSettings settings{.elevation_deg = 12.0, .zoom = 0.4};
    const Camera camera = fit_camera(scene.meshes[0].positions, settings, 4.0 / 3.0);
    const Image image = Renderer(scene, kSmall).render(camera);

    const Vec3 to_sun = Lighting(camera).to_sun;
    const Vec3 shadow = Vec3(0, 1, 0) - to_sun / to_sun.y();
    const Vec3 open = Vec3(0, 0, 0) + 2.5 * Vec3(to_sun.x(), 0, to_sun.z()).normalized();
    EXPECT_LT(brightness(pixel_at(image, camera.project(shadow))),
              0.8 * brightness(pixel_at(image, camera.project(open))));
}

/// A sheet that is folded onto itself looks as two sheets do, whether they share the vertices of the fold.
TEST(Renderer, ShadesASharpFoldAsTwoFacets)
{
    RenderMesh folded, apart;
    folded.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0),       Vec3(1, 1, 0),
                        Vec3(-1, 1, 0),  Vec3(-0.9, -1, -0.2), Vec3(-0.9, 1, -0.2)};
    folded.triangles = {Triangle(0, 1, 2), Triangle(0, 2, 3), Triangle(2, 1, 4), Triangle(2, 4, 5)};
    apart = folded;
    apart.positions.insert(apart.positions.end(), {folded.positions[1], folded.positions[2]});
    apart.triangles = {Triangle(0, 1, 2), Triangle(0, 2, 3), Triangle(7, 6, 4), Triangle(7, 4, 5)};
    const RenderScene one{.meshes = {folded}, .ground_height = {}},
        two{.meshes = {apart}, .ground_height = {}};
    const Camera camera = camera_for(one, 20.0, 10.0);
    const Image joined = Renderer(one, kSmall).render(camera),
                separate = Renderer(two, kSmall).render(camera);
    int difference = 0, most = 0;
    for (int y = 0; y < joined.height; ++y)
        for (int x = 0; x < joined.width; ++x) {
            const int change = std::abs(brightness(joined.pixel(x, y)) - brightness(separate.pixel(x, y)));
            difference += change;
            most = std::max(most, change);
        }
    EXPECT_LT(most, 60);
    EXPECT_LT(difference, 3 * joined.width * joined.height);
}

TEST(Renderer, ShowsEachSideInItsColor)
{
    RenderMesh sheet = square(Vec3::Zero(), false);
    sheet.material.front = Vec3(0.6, 0.05, 0.05);
    sheet.material.back = Vec3(0.05, 0.6, 0.05);
    const RenderScene scene{.meshes = {sheet}, .ground_height = {}};
    const Renderer renderer(scene, kSmall);
    const Image front = renderer.render(camera_for(scene, 0.0, 0.0));
    const Image back = renderer.render(camera_for(scene, 180.0, 0.0));
    const std::uint8_t* seen = pixel_at(front, Vec2(0, 0));
    EXPECT_GT(seen[0], 2 * seen[1]);
    seen = pixel_at(back, Vec2(0, 0));
    EXPECT_GT(seen[1], 2 * seen[0]);
}

TEST(Renderer, LaysThePrintAlongItsCoordinates)
{
    RenderMesh sheet = square(Vec3::Zero(), false);
    sheet.material.front = Vec3(0.6, 0.05, 0.05);
    sheet.material.print_front = Vec3(0.05, 0.05, 0.6);
    sheet.material.print_size = 0.5;
    const std::vector<Vec2> rest = {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)};
    sheet.corner_coordinates = corner_coordinates(sheet.triangles, rest);

    const auto is_blue = [&](Print print, const Vec3& point) {
        sheet.material.print = print;
        const RenderScene scene{.meshes = {sheet}, .ground_height = {}};
        const Camera camera = camera_for(scene, 0.0, 0.0);
        const Image image = Renderer(scene, kSmall).render(camera);
        const std::uint8_t* pixel = pixel_at(image, camera.project(point));
        return pixel[2] > pixel[0];
    };
    EXPECT_FALSE(is_blue(Print::Plain, Vec3(0.75, 0.25, 0)));
    EXPECT_TRUE(is_blue(Print::Checker, Vec3(0.75, 0.25, 0)));
    EXPECT_FALSE(is_blue(Print::Checker, Vec3(0.75, 0.75, 0)));
    EXPECT_TRUE(is_blue(Print::Checker, Vec3(-0.25, 0.25, 0)));
    EXPECT_TRUE(is_blue(Print::Stripes, Vec3(0.75, 0.75, 0)));
    EXPECT_FALSE(is_blue(Print::Stripes, Vec3(0.25, -0.25, 0)));
}

TEST(Renderer, LetsTheSunShineThroughThinCloth)
{
    RenderMesh sheet = square(Vec3::Zero(), true); // seen from below, lit from above
    const auto seen = [&](double translucency) {
        sheet.material.translucency = translucency;
        const RenderScene scene{.meshes = {sheet}, .ground_height = {}};
        return brightness(
            pixel_at(Renderer(scene, kSmall).render(camera_for(scene, 0.0, -40.0)), Vec2(0, 0)));
    };
    EXPECT_GT(seen(0.3), seen(0.0) + 30);
}

TEST(Renderer, BrightensTheEdgeOfClothByItsSheen)
{
    RenderMesh ball = unit_sphere(96);
    const auto seen = [&](double sheen, double x) {
        ball.material = {};
        ball.material.front = Vec3(0.1, 0.1, 0.3);
        ball.material.sheen = sheen;
        const RenderScene scene{.meshes = {ball}, .ground_height = {}};
        const Camera camera = camera_for(scene, 0.0, 0.0);
        return brightness(pixel_at(Renderer(scene, kSmall).render(camera),
                                   camera.project(Vec3(x, 0, std::sqrt(1 - x * x)))));
    };
    EXPECT_GT(seen(0.5, -0.88), seen(0.0, -0.88) + 30);
    EXPECT_NEAR(seen(0.5, 0.0), seen(0.0, 0.0), 3);
}

TEST(Renderer, GivesTheSameBitsForAnyThreadCount)
{
    RenderMesh ball = unit_sphere(64);
    ball.material = cloth_material(Vec3(0.5, 0.1, 0.1));
    const RenderScene scene{.meshes = {ball, square(Vec3(0.3, 1.2, 0.2), true)}, .ground_height = -1.0};
    const auto picture = [&](size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return Renderer(scene, kSmall).render(camera_for(scene, 30.0, 12.0));
    };
    EXPECT_EQ(picture(1).rgb, picture(2).rgb);
}

/// Root mean square of the differences of two pictures [8-bit steps].
double difference(const Image& a, const Image& b)
{
    double sum = 0.0;
    for (size_t i = 0; i < a.rgb.size(); ++i)
        sum += (a.rgb[i] - b.rgb[i]) * (a.rgb[i] - b.rgb[i]);
    return std::sqrt(sum / double(a.rgb.size()));
}

TEST(Renderer, RemovesNoiseAndKeepsSilhouettesSharp)
{
    const RenderScene scene{.meshes = {square(Vec3(0.0, 2.5, 0.0), true)}, .ground_height = -1.0};
    const Camera camera = fit_camera(corners(Bounds{Vec3(-1.0, -1.0, -1.0), Vec3(4.0, 2.5, 1.0)}),
                                     {.elevation_deg = 30.0}, 4.0 / 3.0);
    const auto picture = [&](int samples, bool removes_noise) {
        RenderSettings settings = kSmall;
        settings.samples = samples;
        settings.removes_noise = removes_noise;
        return Renderer(scene, settings).render(camera);
    };
    const Image converged = picture(256, false), noisy = picture(16, false), smooth = picture(16, true);
    EXPECT_LT(difference(smooth, converged), 0.8 * difference(noisy, converged));
    int blurred = 0;
    for (size_t i = 0; i < smooth.rgb.size(); ++i)
        blurred += std::abs(smooth.rgb[i] - converged.rgb[i]) > 30;
    EXPECT_LT(blurred, 60);
    EXPECT_LT(difference(picture(256, true), converged), 0.3) << "nothing to remove";
}

TEST(Renderer, FollowsAMeshToItsNextFrame)
{
    RenderScene scene{.meshes = {unit_sphere(64)}, .ground_height = -1.0};
    const Camera camera = camera_for(scene, 30.0, 12.0);
    Renderer moving(scene, kSmall);
    const Image before = moving.render(camera);
    for (Vec3& point : scene.meshes[0].positions)
        point = Vec3(0.8 * point.x() + 0.1, 0.9 * point.y() - 0.1, point.z());
    moving.update(0, scene.meshes[0].positions);

    // A refitted tree may decide a tie on a shared edge the other way than a new one: a step of 8 bits.
    const Image moved = moving.render(camera), built = Renderer(scene, kSmall).render(camera);
    int largest = 0, changed = 0;
    for (size_t i = 0; i < moved.rgb.size(); ++i) {
        largest = std::max(largest, std::abs(moved.rgb[i] - built.rgb[i]));
        changed += moved.rgb[i] != before.rgb[i];
    }
    EXPECT_LE(largest, 2);
    EXPECT_GT(changed, 1000);
}

TEST(Renderer, RefusesInvalidScenes)
{
    const auto message = [](const RenderMesh& mesh, const RenderSettings& settings = kSmall) {
        return refusal([&] { Renderer(RenderScene{.meshes = {mesh}, .ground_height = {}}, settings); });
    };
    RenderMesh mesh = square(Vec3::Zero(), true);
    EXPECT_THAT(message(mesh, {.width = 0}), HasSubstr("0 x 720 pixels"));
    mesh.material.print = Print::Checker;
    EXPECT_THAT(message(mesh), HasSubstr("corner_coordinates"));
    mesh.material.print = Print::Plain;
    mesh.triangles.push_back(Triangle(0, 1, 4));
    EXPECT_THAT(message(mesh), HasSubstr("out of range of its 4 vertices"));

    Renderer renderer(RenderScene{.meshes = {square(Vec3::Zero(), true)}, .ground_height = {}}, kSmall);
    EXPECT_THAT(refusal([&] { renderer.update(0, std::vector<Vec3>(3)); }), HasSubstr("the frame 3"));
}

} // namespace
} // namespace toile::test
