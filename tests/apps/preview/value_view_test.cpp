#include "apps/preview/value_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "apps/preview/colour_bar.h"
#include "apps/preview/lettering.h"
#include "tests/apps/preview/render_fixtures.h"

namespace toile::test {

namespace {

/// The pixel of a colour.
Vec3 bytes(const Vec3& colour)
{
    return Vec3(std::round(255.0 * colour.x()), std::round(255.0 * colour.y()),
                std::round(255.0 * colour.z()));
}

Vec3 bytes(const std::uint8_t* pixel) { return Vec3(pixel[0], pixel[1], pixel[2]); }

/// Luminance of sRGB [ITU-R BT.709].
double luminance(const Vec3& colour)
{
    const auto linear = [](double c) {
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

TriangleMesh facing_square()
{
    const RenderMesh mesh = square(Vec3::Zero(), false);
    return {mesh.positions, mesh.triangles};
}

Camera camera_in_front(const TriangleMesh& mesh)
{
    CameraSettings settings;
    settings.azimuth_deg = settings.elevation_deg = 0.0;
    return fit_camera(mesh.positions, settings, 1.0);
}

TEST(ColourScale, HasThePublishedColoursAtItsEndsAndBeyond)
{
    const ColourScale viridis{ColourMap::Viridis, -1.0, 3.0}, turbo{ColourMap::Turbo, -1.0, 3.0};
    for (const double low : {-5.0, -1.0}) {
        EXPECT_EQ(bytes(viridis.colour(low)), Vec3(0x44, 0x01, 0x54));
        EXPECT_EQ(bytes(turbo.colour(low)), Vec3(0x30, 0x12, 0x3b));
    }
    for (const double high : {3.0, 1e9}) {
        EXPECT_EQ(bytes(viridis.colour(high)), Vec3(0xfd, 0xe7, 0x25));
        EXPECT_EQ(bytes(turbo.colour(high)), Vec3(0x7a, 0x04, 0x02));
    }
    // matplotlib's viridis(0.5) and turbo(0.5).
    EXPECT_LT((viridis.colour(1.0) - Vec3(0.1281, 0.5651, 0.5509)).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_LT((turbo.colour(1.0) - Vec3(0.6436, 0.9900, 0.2336)).cwiseAbs().maxCoeff(), 0.02);
}

TEST(ColourScale, GetsLighterAlongViridis)
{
    const ColourScale viridis;
    for (int k = 0; k < 100; ++k)
        EXPECT_LT(luminance(viridis.colour(0.01 * k)), luminance(viridis.colour(0.01 * (k + 1)))) << k;
}

TEST(ValueView, ShowsTheColoursOfTheValuesThatFaceTheCamera)
{
    const TriangleMesh mesh = facing_square();
    const ValueView view(mesh, {}, camera_in_front(mesh), 64, 64);
    const ColourScale scale{ColourMap::Turbo, 0.0, 2.0};
    for (const double value : {0.0, 2.0}) {
        const Image image = view.picture(std::vector<double>(4, value), scale);
        const Vec3 middle = bytes(image.pixel(32, 32));
        EXPECT_LE((middle - bytes(scale.colour(value))).cwiseAbs().maxCoeff(), 1.0) << middle.transpose();
        EXPECT_EQ(bytes(image.pixel(0, 0)), Vec3(250, 250, 250)) << "background";
    }
    // Corners are at x = -1, 1, 1, -1: low values at the left.
    const Image ramp = view.picture(std::vector<double>{0.0, 2.0, 2.0, 0.0}, scale);
    EXPECT_LE((bytes(ramp.pixel(32, 32)) - bytes(scale.colour(1.0))).cwiseAbs().maxCoeff(), 8.0);
    EXPECT_GT(bytes(ramp.pixel(56, 32)).x(), bytes(ramp.pixel(56, 32)).z()) << "red at the right";
    EXPECT_LT(bytes(ramp.pixel(14, 32)).x(), bytes(ramp.pixel(14, 32)).z()) << "blue at the left";
}

TEST(ValueView, IsHiddenByWhatStandsInFront)
{
    const TriangleMesh mesh = facing_square();
    TriangleMesh before = mesh;
    for (Vec3& x : before.positions)
        x += Vec3(0.0, 0.0, 0.1);
    const Image image = ValueView(mesh, before, camera_in_front(mesh), 32, 32)
                            .picture(std::vector<double>(4, 1.0), {ColourMap::Turbo, 0.0, 1.0});
    const Vec3 middle = bytes(image.pixel(16, 16));
    EXPECT_LT(middle.maxCoeff() - middle.minCoeff(), 10.0) << "grey";
}

TEST(ColourBar, HasTheEndsOfTheScaleAtTopAndBottom)
{
    Image picture(60, 200);
    const Legend legend{"gap (mm)", {ColourMap::Viridis, 0.0, 0.05}, 1000.0};
    const std::array<Image, 2> pictures{picture, picture};
    const std::array<std::string, 2> captions{"front", "back"};
    Image image = with_colour_bar(pictures, captions, legend);
    EXPECT_GT(image.width, 2 * 60);
    EXPECT_GT(image.height, 200);
    std::vector<Vec3> column;
    for (int y = 0; y < image.height; ++y)
        column.push_back(bytes(image.pixel(128 + 20, y)));
    const auto is = [](const Vec3& colour) { return [colour](const Vec3& x) { return x == bytes(colour); }; };
    const auto top = std::find_if(column.begin(), column.end(), is(legend.scale.colour(0.05)));
    const auto bottom = std::find_if(column.begin(), column.end(), is(legend.scale.colour(0.0)));
    ASSERT_NE(top, column.end());
    ASSERT_NE(bottom, column.end());
    EXPECT_GT(bottom - top, 150) << "high values are above";
}

TEST(Lettering, HasADifferentShapeForEachLetterAndStaysInThePicture)
{
    const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-+%/<>()";
    std::set<std::string> shapes;
    for (const char letter : letters) {
        Image image(kLetterWidth, kLetterHeight);
        draw_text(image, 0, 0, 1, std::string(1, letter));
        shapes.insert(std::string(image.rgb.begin(), image.rgb.end()));
    }
    EXPECT_EQ(shapes.size(), letters.size());
    Image minus(kLetterWidth, kLetterHeight);
    draw_text(minus, 0, 0, 1, "-");
    for (int y = 0; y < kLetterHeight; ++y)
        EXPECT_EQ(minus.pixel(1, y)[0] != 0, y == (kLetterHeight - kBelowLine) / 2);
    Image small(5, 5), same(5, 5);
    draw_text(small, -100, -3, 4, "8");
    draw_text(small, 5, 5, 4, "8");
    EXPECT_EQ(small.rgb, same.rgb);
}

} // namespace
} // namespace toile::test
