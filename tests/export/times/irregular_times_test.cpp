#include <cstring>

#include <gmock/gmock.h>

#include "export/times/resampled_cache.h"
#include "export/usd/usd_python.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::HasSubstr;

/// Samples that libraries of the formats wrote: samples/make_samples.py says what is in them.
std::filesystem::path sample(const std::string& name)
{
    return std::filesystem::path(TOILE_SOURCE_DIR) / "tests/export" / name;
}

const std::filesystem::path kArchive = sample("alembic/samples/irregular.abc");

class IrregularTimes : public ExportTest {
protected:
    /// An MDD of three frames at these times.
    std::filesystem::path mdd_at(const std::vector<float>& times) const
    {
        const auto writer = make_cache_writer(file("skirt.mdd"), cache_layout(quad_mesh(), 3));
        write_frames(*writer, 0, 3, 7);
        writer->finish();
        std::string bytes = bytes_of(file("skirt.mdd"));
        for (size_t k = 0; k < 3; ++k)
            for (size_t byte = 0; byte < 4; ++byte) {
                std::uint32_t bits = 0;
                std::memcpy(&bits, &times[k], sizeof bits);
                bytes[8 + 4 * k + byte] = char(bits >> (24 - 8 * byte));
            }
        write_bytes(file("skirt.mdd"), bytes);
        return file("skirt.mdd");
    }
};

/// Heights at 0.1, 0.2, 0.7 and 1.7 s are 1 to 4; places at 0, 0.4 and 1 s are 0, 4 and 5.
TEST_F(IrregularTimes, OfPointsAndOfTransformsAreEachTheirOwnInAlembic)
{
    const PointCache cache = read_cache(kArchive.string() + "#/mover/square");
    const std::vector<double> times{0.0, 0.1, 0.2, 0.4, 0.7, 1.0, 1.7};
    EXPECT_EQ(cache.times(), times);
    EXPECT_FALSE(cache.fps());
    ASSERT_EQ(cache.frame_count(), 7);
    const double places[] = {0.0, 1.0, 2.0, 4.0, 4.5, 5.0, 5.0};
    const double heights[] = {1.0, 1.0, 2.0, 2.4, 3.0, 3.3, 4.0};
    for (int k = 0; k < 7; ++k)
        EXPECT_LT((cache.frame(k)[2] - Vec3(1.0 + places[k], heights[k], 0.0)).norm(), 1e-12) << k;
}

TEST_F(IrregularTimes, RepeatWithTheCycleOfAnArchive)
{
    const PointCache cache = read_cache(kArchive.string() + "#/shutter");
    ASSERT_EQ(cache.times().size(), 4u);
    for (int k = 0; k < 4; ++k) {
        const int frame = k / 2;
        EXPECT_NEAR(cache.times()[size_t(k)], (frame + 0.25 * (k % 2)) / 24.0, 1e-15);
        EXPECT_EQ(cache.frame(k)[2], Vec3(1, k + 1, 0));
    }
}

TEST_F(IrregularTimes, ThatDecreaseAreRefusedInAlembic)
{
    std::string bytes = bytes_of(kArchive);
    const double second = 0.2, earlier = 0.05;
    const size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&second), sizeof second));
    ASSERT_NE(at, std::string::npos);
    std::memcpy(&bytes[at], &earlier, sizeof earlier);
    write_bytes(file("bad.abc"), bytes);
    EXPECT_THAT(
        refusal([&] { read_cache(file("bad.abc").string() + "#/mover/square"); }),
        HasSubstr("bad.abc: /mover/square: sample 1 is at 0.05 s and the one before at 0.1 s; times must "
                  "increase; export it again"));
}

TEST_F(IrregularTimes, OfUsdAreThoseOfTheSamples)
{
    const std::string missing = refusal([] { require_usd_python("USD"); });
    if (!missing.empty())
        GTEST_SKIP() << missing;
    const PointCache cache = read_cache(sample("usd/samples/irregular.usda"));
    EXPECT_FALSE(cache.fps());
    const double codes[] = {2.4, 4.8137, 16.8, 40.8};
    ASSERT_EQ(cache.times().size(), 4u);
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(cache.times()[size_t(k)], codes[k] / 24.0, 1e-15);
        EXPECT_EQ(cache.frame(k)[2], Vec3(1, k + 1, 0));
    }
}

/// At code 13 the square has turned by half of 360 degrees, over 24.0137 codes, less a bit.
TEST_F(IrregularTimes, OfUsdHaveTheFramesWhereATransformTurns)
{
    const std::string missing = refusal([] { require_usd_python("USD"); });
    if (!missing.empty())
        GTEST_SKIP() << missing;
    const PointCache cache = read_cache(sample("usd/samples/turning.usda"));
    ASSERT_EQ(cache.frame_count(), 26);
    EXPECT_NEAR(cache.times()[12], 13.0 / 24.0, 1e-15);
    EXPECT_NEAR(cache.times()[25], 25.0137 / 24.0, 1e-15);
    const double turned = 12.0 / 24.0137 * 2.0 * 3.14159265358979;
    EXPECT_LT((cache.frame(12)[1] - Vec3(std::cos(turned), std::sin(turned), 0.0)).norm(), 1e-6);
}

TEST_F(IrregularTimes, OfMddAreThoseInItsHeader)
{
    const PointCache cache = read_cache(mdd_at({0.5f, 0.625f, 2.5f}));
    EXPECT_EQ(cache.times(), (std::vector<double>{0.5, 0.625, 2.5}));
    EXPECT_FALSE(cache.fps());
    EXPECT_TRUE(read_cache(mdd_at({0.5f, 0.625f, 0.75f})).times().empty()) << "regular ones have a rate";
}

TEST_F(IrregularTimes, AreResampledAtWholeFrames)
{
    const PointCache cache = resampled(read_cache(mdd_at({0.5f, 0.625f, 2.45f})), 10.0, "skirt.mdd");
    EXPECT_EQ(cache.start_frame(), 5.0);
    ASSERT_EQ(cache.frame_count(), 21) << "frames 5 to 25";
    EXPECT_EQ(*cache.fps(), 10.0);
    EXPECT_TRUE(cache.times().empty());
    const auto x = [&](int frame) { return cache.frame(frame)[0].x(); }; // 0.5 at sample 0, 1 more a sample
    EXPECT_EQ(x(0), 0.5);
    EXPECT_NEAR(x(1), 0.5 + 0.8, 1e-6);
    EXPECT_NEAR(x(2), 1.5 + 0.075 / 1.825, 1e-6);
    EXPECT_EQ(x(20), 2.5) << "held";
}

TEST_F(IrregularTimes, AreNotResampledWhereTheyDecreaseOrNeverEnd)
{
    EXPECT_THAT(refusal([&] {
                    resampled(read_cache(mdd_at({0.0f, 0.0f, 0.0f})), 24.0, "skirt.mdd");
                }),
                HasSubstr("skirt.mdd: sample 1 is at 0 s and the one before at 0 s; times must increase"));
    EXPECT_THAT(refusal([&] {
                    resampled(read_cache(mdd_at({0.0f, 1.0f, 1e8f})), 24.0, "skirt.mdd");
                }),
                HasSubstr("skirt.mdd: lasts 2.4e+09"));
}

} // namespace

} // namespace toile::test
