#include <gmock/gmock.h>
#include <png.h>

#include <algorithm>

#include "apps/preview/image.h"
#include "apps/preview/video.h"
#include "tests/apps/fit/tubes.h"
#include "tests/apps/program.h"

/// toile render: camera, turntable and heat maps.
namespace toile::test {

namespace {

using preview::Image;
using testing::HasSubstr;

constexpr double kBody = 0.15, kSkirt = 0.2; ///< [m] radii

Image read_png(const std::filesystem::path& file)
{
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&read, file.c_str()))
        return {};
    read.format = PNG_FORMAT_RGB;
    Image image(int(read.width), int(read.height));
    png_image_finish_read(&read, nullptr, image.rgb.data(), 0, nullptr);
    return image;
}

Vec3 bytes(const std::uint8_t* pixel) { return {double(pixel[0]), double(pixel[1]), double(pixel[2])}; }

/// Fraction of the pixels that are bluer than red: cloth, not body, floor or paper.
double blue_fraction(const Image& image)
{
    int blue = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            blue += image.pixel(x, y)[2] > image.pixel(x, y)[0] + 40;
    return double(blue) / (image.width * image.height);
}

class RenderCommand : public FileTest {
protected:
    void SetUp() override
    {
        write_obj(file("column.obj"), tube(kBody));
        write_obj(file("skirt.obj"), tube(kSkirt));
        write_obj(file("now.obj"), tube(1.03 * kSkirt));
        temporary_.write("scene.json", scene(R"({"name": "column", "file": "column.obj"})"));
        temporary_.write("bare.json", scene(""));
    }

    static std::string scene(const std::string& avatar)
    {
        return R"({"toile": 1, "frames": 1, "avatars": [)" + avatar + R"(],
                   "cloths": [{"name": "skirt", "file": "skirt.obj", "fabric": "cotton", "color": [0, 0.1, 0.9]}],
                   "render": {"width": 96, "height": 64, "samples": 1, "azimuth_deg": 0, "elevation_deg": 0}})";
    }

    Finished render(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), {"render", "now.obj", "--quiet"});
        return run_toile(arguments, folder_);
    }

    Image picture(std::vector<std::string> arguments, const std::string& name = "a.png") const
    {
        arguments.insert(arguments.begin(), {"--scene", "scene.json", "-o", name});
        const Finished finished = render(arguments);
        EXPECT_EQ(finished.exit_code, 0) << finished.errors;
        return read_png(file(name));
    }

    void expect_refusal(const std::vector<std::string>& arguments, const std::string& says) const
    {
        const auto before = temporary_.snapshot();
        const Finished finished = render(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.errors;
        EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
        EXPECT_THAT(finished.errors, HasSubstr(says));
        EXPECT_EQ(temporary_.snapshot(), before);
    }
};

TEST_F(RenderCommand, TakesThePartOfACropAtFullResolution)
{
    const Image whole = picture({"--width", "384", "--height", "256"});
    const Image part = picture({"--crop", "0.25,0.25,0.5,0.5"});
    ASSERT_EQ(part.width, 96);
    ASSERT_EQ(part.height, 64);
    // The same pixels of a picture that is four times as large, but for the random paths.
    double difference = 0.0;
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            difference += (bytes(part.pixel(x, y)) - bytes(whole.pixel(96 + x, 64 + y))).cwiseAbs().sum();
    EXPECT_LT(difference / (3 * 96 * 64), 6.0);

    const Image strip = picture({"--crop", "0,0.5,1,1"});
    EXPECT_EQ(strip.width, 96);
    EXPECT_EQ(strip.height, 32);
}

TEST_F(RenderCommand, LooksAtAPointOrACloth)
{
    const double all = blue_fraction(picture({}));
    EXPECT_NEAR(blue_fraction(picture({"--zoom", "0.5"})), all / 4.0, 0.1 * all);
    // Above the skirt there is nothing of it in the middle.
    const Image above = picture({"--target", "0,1.5,0"});
    EXPECT_LT(blue_fraction(above), 0.75 * all);
    EXPECT_GT(blue_fraction(picture({"--target", "0,0.5,0"})), 0.9 * all);
    write_obj(file("column.obj"), together(tube(kBody), moved(tube(kBody), Vec3(0.0, 3.0, 0.0))));
    EXPECT_LT(blue_fraction(picture({})), 0.2 * all);
    EXPECT_NEAR(blue_fraction(picture({"--target", "skirt"})), all, 0.1 * all);
}

TEST_F(RenderCommand, DrawsPlanesThatAreNotItsFloor)
{
    const auto blue = [&](const std::string& placed) {
        temporary_.write("scene.json",
                         scene(R"({"name": "floor", "plane": {}, "color": [0, 0.1, 0.9])" + placed + "}"));
        return blue_fraction(picture({"--elevation", "30"}));
    };
    const double skirt = blue("");
    EXPECT_LT(skirt, 0.5);
    EXPECT_GT(blue(R"(, "translate": [0, 0.02, 0])"), skirt + 0.3) << "above it";
    EXPECT_GT(blue(R"(, "rotate_deg": [2, 0, 0])"), skirt + 0.1) << "askew";
}

TEST_F(RenderCommand, GoesAroundAFrame)
{
    const Image sheet = picture({"--turntable", "4", "--sheet", "2"});
    EXPECT_EQ(sheet.width, 2 * 96 + 8);
    EXPECT_EQ(sheet.height, 2 * 64 + 8);
    picture({"--turntable", "3"}, "around");
    for (const char* name : {"frame_0000.png", "frame_0001.png", "frame_0002.png"})
        EXPECT_TRUE(std::filesystem::exists(file("around") / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(file("around") / "frame_0003.png"));
    if (preview::is_on_path("ffmpeg")) {
        picture({"--turntable", "--width", "16", "--height", "16"}, "around.mp4");
        EXPECT_GT(std::filesystem::file_size(file("around.mp4")), 1000u);
    }
}

/// Cloth that is stretched by 3 % everywhere.
TEST_F(RenderCommand, DrawsTheStrainWithItsLegend)
{
    const Image low = picture({"--map", "strain", "--map-range", "3,6"});
    const Image high = picture({"--map", "strain", "--map-range", "0,3"});
    EXPECT_GT(high.width, 96 + 50);
    EXPECT_GT(high.height, 64 + 20);
    const Vec3 cold = bytes(low.pixel(48, 74)), hot = bytes(high.pixel(48, 74));
    EXPECT_LT((cold / cold.maxCoeff() - Vec3(0x30, 0x12, 0x3b) / 0x3b).norm(), 0.1) << cold.transpose();
    EXPECT_LT((hot / hot.maxCoeff() - Vec3(0x7a, 0x04, 0x02) / 0x7a).norm(), 0.1) << hot.transpose();
    EXPECT_EQ(picture({"--map", "strain"}).rgb, picture({"--map", "strain", "--map-range", "0,4"}).rgb)
        << "of all pictures: a little more than 3 %";
    for (const char* map : {"tension", "gap", "pressure"})
        EXPECT_EQ(picture({"--map", map}).width, high.width) << map;
    const Image sheet = picture({"--map", "gap", "--turntable", "2", "--sheet", "2"});
    EXPECT_EQ(sheet.width, high.width + 96 + 8) << "one legend";
}

TEST_F(RenderCommand, RefusesImpossibleViews)
{
    for (const auto& [option, value, says] : std::vector<std::array<std::string, 3>>{
             {"--elevation", "90", "--elevation: 90 is out of range; give a number from -89 to 89"},
             {"--azimuth", "nan", "--azimuth: nan"},
             {"--zoom", "0", "--zoom: 0"},
             {"--target", "skrit", "did you mean \"skirt\"?"},
             {"--target", "1e9,0,0", "up to 100 km"},
             {"--target", "1,2", "there are skirt, column"},
             {"--crop", "0,0,1", "is not four numbers"},
             {"--crop", "0.5,0,0.5,1", "X0 < X1"},
             {"--crop", "0,0,1,1.5", "is no part of the picture"},
             {"--turntable", "1", "from 2 to 3600"},
             {"--turntable", "8", "--turntable makes 8; add --sheet"},
             {"--map", "heat", "give strain, tension, gap or pressure"},
             {"--map-range", "0,1", "needs --map"}})
        expect_refusal({"--scene", "scene.json", "-o", "a.png", option, value}, says);
    expect_refusal({"--scene", "scene.json", "-o", "a.png", "--map", "gap", "--map-range", "2,1"},
                   "the smaller one first");
}

TEST_F(RenderCommand, RefusesMapsWithoutWhatTheyMeasure)
{
    expect_refusal({"-o", "a.png", "--map", "strain"}, "give --scene with the scene");
    expect_refusal({"--scene", "bare.json", "-o", "a.png", "--map", "gap"}, "has no avatar with a skin");
    EXPECT_EQ(render({"--scene", "bare.json", "-o", "b.png", "--map", "strain"}).exit_code, 0);
}

TEST_F(RenderCommand, ReadsCachesInAnotherUnitAndAxis)
{
    TriangleMesh other = tube(1.03 * kSkirt);
    for (Vec3& x : other.positions)
        x = 100.0 * Vec3(x.x(), -x.z(), x.y());
    write_obj(file("other.obj"), other);
    const std::vector<std::string> size{"--width", "96", "--height", "64", "--samples", "4", "--quiet"};
    const auto blue = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), size.begin(), size.end());
        arguments.insert(arguments.end(), {"-o", "p.png"});
        const Finished drawn = run_toile(arguments, folder_);
        EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
        return read_png(file("p.png")).rgb;
    };
    const std::vector<std::string> told{"--from-unit", "cm", "--from-up", "z"};
    for (const bool has_scene : {true, false}) {
        std::vector<std::string> first{"now.obj"}, second{"other.obj"};
        second.insert(second.end(), told.begin(), told.end());
        if (has_scene)
            for (auto* arguments : {&first, &second})
                arguments->insert(arguments->end(), {"--scene", "scene.json"});
        const auto expected = blue(first), found = blue(second);
        ASSERT_EQ(expected.size(), found.size());
        int different = 0;
        for (size_t k = 0; k < found.size(); ++k)
            different += std::abs(int(expected[k]) - int(found[k])) > 40;
        EXPECT_LT(different, int(found.size()) / 50) << has_scene;
    }
}

/// Seconds 0 to 1.7 are 52 frames at 30 a second, the rate of a cache that has none, and 35 at the
/// scene's 20.
TEST_F(RenderCommand, ShowsACacheOfIrregularTimesAtARate)
{
    const std::string archive = TOILE_SOURCE_DIR "/tests/export/alembic/samples/irregular.abc#/mover/square";
    const auto draw = [&](const std::string& folder, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render",    archive,   "-o",     folder,     "--frames",
                                           "0:-1:17",   "--width", "16",     "--height", "16",
                                           "--samples", "1",       "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished drawn = run_toile(arguments, folder_);
        EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
    };
    draw("alone", {});
    EXPECT_TRUE(std::filesystem::exists(file("alone/frame_0051.png")));
    temporary_.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    temporary_.write("square.json", R"({"toile": 1, "frames": 35, "fps": 20, "cloths": [
        {"name": "square", "file": "square.obj"}],
        "export": [{"file": "irregular.abc", "subframes": 4}]})");
    draw("with_scene", {"--scene", "square.json"});
    EXPECT_TRUE(std::filesystem::exists(file("with_scene/frame_0034.png")));
}

/// The number may be left out, so what follows may be the cache.
TEST_F(RenderCommand, TakesACacheBehindTurntable)
{
    const std::vector<std::string> small{"--width", "16", "--height", "16", "--samples", "1", "--quiet"};
    const auto around = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), small.begin(), small.end());
        return run_toile(arguments, folder_);
    };
    EXPECT_EQ(around({"--turntable", "now.obj", "-o", "a"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(file("a/frame_0095.png")));
    EXPECT_EQ(around({"--turntable", "3", "now.obj", "-o", "b"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(file("b/frame_0002.png")));
    EXPECT_FALSE(std::filesystem::exists(file("b/frame_0003.png")));
    EXPECT_EQ(around({"now.obj", "-o", "c", "--turntable"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(file("c/frame_0095.png")));
    const Finished nothing = around({"--turntable", "3"});
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_THAT(nothing.errors, HasSubstr("inputs"));
}

} // namespace
} // namespace toile::test
