#include "apps/preview/paint/paint.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "apps/preview/renderer.h"
#include "core/base/error.h"
#include "tests/apps/preview/encoded_image.h"
#include "tests/apps/preview/render_fixtures.h"

namespace toile::test {

namespace {

using avatars::Wrap;
using testing::HasSubstr;

const std::array<Rgba, 4> kFour{kRed, kGreen, kBlue, kYellow};

Vec3 linear(const Rgba& colour)
{
    return Vec3(colour[0], colour[1], colour[2]).unaryExpr([](double byte) {
        return avatars::linear_from_srgb(byte / 255.0);
    });
}

std::string refusal(const Bytes& bytes)
{
    try {
        decode_image(bytes, "body.glb: images[0]");
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

void put(Bytes& bytes, size_t at, std::uint32_t number)
{
    for (size_t k = 0; k < 4; ++k)
        bytes[at + k] = static_cast<unsigned char>(number >> (24 - 8 * k));
}

ImageTexture texture(const std::array<Wrap, 2>& wrap, int side = 1)
{
    return {std::make_shared<DecodedImage>(quarters(kFour, side)), wrap};
}

/// What a texture shows at a place whose colour no neighbour mixes into.
void expect_colour(const ImageTexture& texture, const Vec2& at, const Rgba& colour)
{
    EXPECT_LT((texture.colour(at).head<3>() - linear(colour)).norm(), 1e-12) << at.transpose();
}

/// One material on the square of render_fixtures.h, whose image is upright.
avatars::Appearance on_square(const avatars::SurfaceMaterial& material, const Bytes& image)
{
    avatars::Appearance appearance;
    appearance.triangles = square(Vec3::Zero(), false).triangles;
    appearance.images = {{"skin.png", image}};
    appearance.materials = {material};
    appearance.material = {0, 0};
    appearance.coordinates = {{Vec2(0, 1), Vec2(1, 1), Vec2(1, 0)}, {Vec2(0, 1), Vec2(1, 0), Vec2(0, 0)}};
    return appearance;
}

const avatars::SurfaceMaterial kTextured{.colour = {}, .texture = avatars::Texture{0, {}}};

} // namespace

TEST(DecodeImage, ReadsPngToTheBit)
{
    const DecodedImage image = quarters({kRed, kGreen, Rgba{1, 2, 3, 77}, kYellow}, 3);
    const DecodedImage decoded = decode_image(png_of(image), "");
    EXPECT_EQ(decoded.width, 6);
    EXPECT_EQ(decoded.rgba, image.rgba);
}

TEST(DecodeImage, ReadsJpegWithinItsLoss)
{
    const DecodedImage image = quarters(kFour, 16);
    const DecodedImage decoded = decode_image(jpeg_of(image), "");
    ASSERT_EQ(decoded.rgba.size(), image.rgba.size());
    for (const int at : {8 * 32 + 8, 8 * 32 + 24, 24 * 32 + 8, 24 * 32 + 24})
        for (size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(decoded.rgba[4 * size_t(at) + k], image.rgba[4 * size_t(at) + k], 4);
}

TEST(DecodeImage, RefusesWhatIsBrokenNamingTheImage)
{
    Bytes png = png_of(quarters(kFour, 40)), jpeg = jpeg_of(quarters(kFour, 40));
    EXPECT_THAT(refusal({}), HasSubstr("body.glb: images[0]: is neither PNG nor JPEG"));
    EXPECT_THAT(refusal({'k', 't', 'x', '2', 0, 0, 0, 0}), HasSubstr("neither PNG nor JPEG"));
    for (const Bytes& whole : {png, jpeg}) {
        EXPECT_EQ(refusal(whole), "");
        for (const size_t size : {whole.size() / 10, whole.size() / 2, whole.size() - 30})
            EXPECT_THAT(refusal({whole.begin(), whole.begin() + std::ptrdiff_t(size)}),
                        HasSubstr("body.glb: images[0]: can't be read as "))
                << size;
    }
    png[png.size() / 2] ^= 0xff;
    EXPECT_THAT(refusal(png), HasSubstr("can't be read as PNG"));
}

TEST(DecodeImage, ChecksSizesBeforeItTakesMemory)
{
    Bytes png = png_of(quarters(kFour, 4));
    constexpr size_t kHeader = 12; // of the IHDR chunk: its name, then 13 bytes
    put(png, kHeader + 4, 300'000);
    put(png, kHeader + 8, 300'000);
    put(png, kHeader + 17, std::uint32_t(crc32(0, &png[kHeader], 17)));
    EXPECT_THAT(refusal(png), HasSubstr("it has 300000 x 300000 pixels; at most 67108864"));

    Bytes jpeg = jpeg_of(quarters(kFour, 4));
    const Bytes mark{0xff, 0xc0};
    const auto frame = std::search(jpeg.begin(), jpeg.end(), mark.begin(), mark.end());
    ASSERT_NE(frame, jpeg.end());
    std::fill(frame + 5, frame + 9, 0xf0);
    EXPECT_THAT(refusal(jpeg), HasSubstr("it has 61680 x 61680 pixels"));
}

TEST(ImageTexture, ContinuesByItsWrapModes)
{
    const ImageTexture repeats = texture({Wrap::Repeat, Wrap::Repeat});
    expect_colour(repeats, {0.25, 0.25}, kRed);
    expect_colour(repeats, {0.75, 0.25}, kGreen);
    expect_colour(repeats, {0.25, 0.75}, kBlue);
    expect_colour(repeats, {1.25, -0.75}, kRed);
    expect_colour(repeats, {-0.25, 0.25}, kGreen);
    expect_colour(repeats, {1e6 + 0.75, 0.75}, kYellow);
    const ImageTexture mirrors = texture({Wrap::Mirror, Wrap::Mirror});
    expect_colour(mirrors, {1.25, 0.25}, kGreen);
    expect_colour(mirrors, {-0.25, 0.25}, kRed);
    expect_colour(mirrors, {2.25, 1.25}, kBlue);
    const ImageTexture clamps = texture({Wrap::Clamp, Wrap::Repeat});
    expect_colour(clamps, {7.0, 0.25}, kGreen);
    expect_colour(clamps, {-7.0, 1.75}, kBlue);
    expect_colour(clamps, {std::nan(""), 0.25}, kRed);
}

TEST(ImageTexture, MixesLinearColoursBetweenPixels)
{
    const ImageTexture image = texture({Wrap::Clamp, Wrap::Clamp});
    const Vec3 mean = 0.5 * (linear(kRed) + linear(kGreen));
    EXPECT_LT((image.colour({0.5, 0.25}).head<3>() - mean).norm(), 1e-12);
    const Vec3 all = 0.25 * (linear(kRed) + linear(kGreen) + linear(kBlue) + linear(kYellow));
    EXPECT_LT((image.colour({0.5, 0.5}).head<3>() - all).norm(), 1e-12);
}

TEST(Paint, MultipliesColourImageAndVertices)
{
    avatars::SurfaceMaterial material = kTextured;
    material.colour = Vec3(0.5, 1.0, 0.25);
    avatars::Appearance appearance = on_square(material, png_of(quarters(kFour, 8)));
    appearance.colours.assign(
        2, {Eigen::Vector4d(1, 0.5, 1, 1), Eigen::Vector4d(1, 0.5, 1, 1), Eigen::Vector4d(1, 0.5, 1, 1)});
    const Paint paint(std::move(appearance), Vec3::Zero());
    const Vec3 yellow = linear(kYellow).cwiseProduct(Vec3(0.5, 0.5, 0.25)); // lower right
    EXPECT_LT((paint.colour(0, Vec3(0.2, 0.7, 0.1)).value() - yellow).norm(), 1e-12);
}

TEST(Paint, FallsBackToTheColourOfAMaterialAndThenOfTheBody)
{
    const Vec3 plain(0.1, 0.2, 0.3), own(0.5, 0.4, 0.3);
    avatars::SurfaceMaterial material = kTextured;
    const Vec3 middle = Vec3::Constant(1.0 / 3.0);
    EXPECT_EQ(Paint(on_square(material, {'x'}), plain).colour(0, middle), plain);
    material.colour = own;
    const Paint paint(on_square(material, {'x'}), plain);
    EXPECT_EQ(paint.colour(0, middle), own);
    ASSERT_EQ(paint.appearance().left_out.size(), 1u);
    EXPECT_THAT(paint.appearance().left_out[0], HasSubstr("skin.png: is neither PNG nor JPEG"));
    avatars::Appearance bare = on_square(material, {});
    bare.material = {-1, -1};
    EXPECT_EQ(Paint(std::move(bare), plain).colour(1, middle), plain);
}

TEST(Paint, LetsRaysThroughWhereAlphaIsLow)
{
    avatars::SurfaceMaterial material = kTextured;
    const auto picture = [&](double cutoff) {
        material.cutoff = cutoff;
        RenderScene scene;
        scene.meshes = {square(Vec3::Zero(), false), square(Vec3(0, 0, -1), false)};
        scene.meshes[1].material.front = Vec3(0.0, 0.0, 1.0);
        scene.meshes[0].paint = std::make_shared<Paint>(
            on_square(material, png_of(quarters({kRed, Rgba{230, 30, 20, 40}, kRed, kRed}, 8))),
            Vec3::Zero());
        const Renderer renderer(scene, {.width = 64, .height = 64});
        return renderer.render(
            fit_camera(renderer.points(), {.azimuth_deg = 0.0, .elevation_deg = 0.0}, 1.0));
    };
    const auto is_blue = [](const Image& image, const Vec2& at) {
        return pixel_at(image, at)[2] > pixel_at(image, at)[0];
    };
    const Image cut = picture(0.5), whole = picture(0.0);
    EXPECT_TRUE(is_blue(cut, {0.3, 0.3}));
    EXPECT_FALSE(is_blue(cut, {-0.3, 0.3}));
    EXPECT_FALSE(is_blue(cut, {0.3, -0.3}));
    EXPECT_FALSE(is_blue(whole, {0.3, 0.3}));
}

} // namespace toile::test
