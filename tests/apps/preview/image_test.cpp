#include "apps/preview/image.h"

#include <gmock/gmock.h>
#include <png.h>

#include "tests/apps/preview/render_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace collision;
using namespace preview;

namespace {

using testing::HasSubstr;

using ImageTest = RenderFileTest;

Image gradient(int width, int height)
{
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            image.pixel(x, y)[0] = std::uint8_t(3 * x);
            image.pixel(x, y)[1] = std::uint8_t(5 * y);
            image.pixel(x, y)[2] = std::uint8_t(x ^ y);
        }
    return image;
}

TEST_F(ImageTest, IsReadBackByLibpngWithSizeAndPixels)
{
    const Image image = gradient(37, 21);
    write_png(file("new/a.png"), image);

    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&read, file("new/a.png").c_str())) << read.message;
    EXPECT_EQ(read.width, 37u);
    EXPECT_EQ(read.height, 21u);
    read.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(read));
    ASSERT_TRUE(png_image_finish_read(&read, nullptr, pixels.data(), 0, nullptr)) << read.message;
    EXPECT_EQ(pixels, image.rgb);
}

TEST_F(ImageTest, RefusesAnEmptyPictureAndAnUnwritablePath)
{
    EXPECT_THAT(refusal([&] { write_png(file("a.png"), Image()); }), HasSubstr("0 x 0 pixels"));
    write_png(file("plain"), gradient(2, 2));
    EXPECT_THAT(refusal([&] { write_png(file("plain") / "a.png", gradient(2, 2)); }),
                HasSubstr("choose a writable folder"));
}

TEST(ContactSheet, PutsPicturesInRowsWithAGap)
{
    const std::vector<Image> images = {gradient(30, 20), Image(30, 20), gradient(30, 20)};
    const Image sheet = contact_sheet(images, 2);
    EXPECT_EQ(sheet.width, 68);
    EXPECT_EQ(sheet.height, 48);
    EXPECT_EQ(sheet.pixel(29, 19)[0], 87);      // first picture, last pixel
    EXPECT_EQ(sheet.pixel(30, 0)[0], 250);      // gap
    EXPECT_EQ(sheet.pixel(38, 0)[0], 0);        // second picture, first pixel
    EXPECT_EQ(sheet.pixel(29, 28 + 19)[1], 95); // third picture, below the first
    EXPECT_EQ(sheet.pixel(67, 47)[0], 250);     // no fourth picture
    EXPECT_EQ(contact_sheet(images, 9).width, 3 * 30 + 2 * 8);
}

TEST(ContactSheet, DrawsTheFrameNumber)
{
    const std::vector<Image> images(1, Image(60, 20));
    const Image sheet = contact_sheet(images, 1, std::vector<int>{17});
    std::string rows;
    for (int y = 12; y < 17; ++y) {
        for (int x = 3; x < 10; ++x)
            rows += sheet.pixel(x, y)[0] != 0 ? '#' : '.';
        rows += '\n';
    }
    EXPECT_EQ(rows, ".#..###\n"
                    "##....#\n"
                    ".#...#.\n"
                    ".#...#.\n"
                    "###..#.\n");
}

TEST(ContactSheet, RefusesPicturesThatDoNotFit)
{
    const std::vector<Image> images = {Image(30, 20), Image(31, 20)};
    EXPECT_THAT(refusal([&] { contact_sheet(images, 2); }), HasSubstr("31 x 20"));
    EXPECT_THAT(refusal([&] { contact_sheet({}, 2); }), HasSubstr("0 pictures"));
    const std::vector<Image> equal(2, Image(30, 20));
    EXPECT_THAT(refusal([&] { contact_sheet(equal, 1, std::vector<int>{1}); }), HasSubstr("1 numbers for 2"));
}

} // namespace
} // namespace toile::test
