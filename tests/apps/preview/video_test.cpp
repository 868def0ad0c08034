#include "apps/preview/video.h"

#include <cstdlib>

#include <gmock/gmock.h>

#include "tests/apps/preview/render_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace preview;

namespace {

using testing::HasSubstr;

using VideoTest = RenderFileTest;

Image shade(int width, int height, int value)
{
    Image image(width, height);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t(value));
    return image;
}

/// Number of frames in an MP4's sample size box: type, version, common size, count (big endian).
int frame_count_of(const std::string& mp4)
{
    const size_t at = mp4.find("stsz") + 12;
    return int(std::uint8_t(mp4[at + 2]) << 8 | std::uint8_t(mp4[at + 3]));
}

TEST_F(VideoTest, EncodesEveryPictureWithTheIndexInFront)
{
    if (!is_on_path("ffmpeg"))
        GTEST_SKIP() << "SKIPPED: ffmpeg is not on PATH";
    VideoWriter video(file("a.mp4"), 65, 48, 12.0);
    for (int frame = 0; frame < 7; ++frame)
        video.write(shade(65, 48, 30 * frame));
    EXPECT_FALSE(std::filesystem::exists(file("a.mp4"))) << "not before it is complete";
    video.finish();

    const std::string bytes = bytes_of(file("a.mp4"));
    EXPECT_EQ(bytes.substr(4, 4), "ftyp");
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
    EXPECT_NE(bytes.find("avc1"), std::string::npos);
    EXPECT_EQ(frame_count_of(bytes), 7);
    EXPECT_FALSE(std::filesystem::exists(file("a.partial.mp4")));
}

TEST_F(VideoTest, RefusesPicturesOfAnotherSizeAndNamesThatAreNoVideo)
{
    if (!is_on_path("ffmpeg"))
        GTEST_SKIP() << "SKIPPED: ffmpeg is not on PATH";
    EXPECT_THAT(refusal([&] { VideoWriter(file("a.avi"), 64, 48, 12.0); }), HasSubstr("name it .mp4"));
    EXPECT_THAT(refusal([&] { VideoWriter(file("a.mp4"), 64, 48, 0.0); }), HasSubstr("make no video"));
    VideoWriter video(file("a.mp4"), 64, 48, 12.0);
    EXPECT_THAT(refusal([&] { video.write(shade(32, 48, 0)); }), HasSubstr("32 x 48"));
}

TEST_F(VideoTest, NamesTheRemedyWithoutFfmpeg)
{
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder_.c_str(), 1);
    const std::string message = refusal([&] { VideoWriter(file("a.mp4"), 64, 48, 12.0); });
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_THAT(message, HasSubstr("install it"));
}

} // namespace
} // namespace toile::test
