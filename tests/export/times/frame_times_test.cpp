#include "export/times/frame_times.h"

#include <cmath>

#include <gtest/gtest.h>

namespace toile::exports {

namespace {

/// Times as doubles, or rounded to single precision.
std::vector<double> times_of(const FrameTimes& from, int samples, bool is_single)
{
    std::vector<double> times;
    for (int k = 0; k < samples; ++k) {
        const double time = (from.start_frame + double(k) / from.subframes) / from.fps;
        const float rounded = float(time);
        times.push_back(is_single ? double(rounded) : time);
    }
    return times;
}

TEST(FrameTimes, AreTheRateAndFrameThatWereWritten)
{
    for (const double fps : {24.0, 25.0, 30.0, 60.0, 24000.0 / 1001.0, 30000.0 / 1001.0, 120.0})
        for (const double start : {0.0, 1.0, 1001.0, 86401.0, -10.0})
            for (const int subframes : {1, 3, 4})
                for (const int samples : {2, 24, 121, 1000}) {
                    const FrameTimes written{fps, subframes, start};
                    const auto read = frame_times(times_of(written, samples, false), 0.0, fps);
                    ASSERT_TRUE(read.has_value());
                    EXPECT_EQ(read->fps, fps);
                    EXPECT_EQ(read->subframes, subframes);
                    EXPECT_EQ(read->start_frame, start);
                }
}

TEST(FrameTimes, AreTheSameFromSinglePrecision)
{
    for (const double fps : {24.0, 25.0, 30.0, 24000.0 / 1001.0})
        for (const double start : {0.0, 1.0, 1001.0})
            for (const int samples : {24, 121, 1000}) {
                const std::vector<double> times = times_of({fps, 1, start}, samples, true);
                const auto read = frame_times(times, times.back() * 0x1p-24, std::nullopt);
                ASSERT_TRUE(read.has_value());
                EXPECT_EQ(read->fps, fps) << start << " " << samples;
                EXPECT_EQ(read->start_frame, start) << fps << " " << samples;
            }
}

TEST(FrameTimes, KeepUnusualOnes)
{
    const auto read = frame_times(times_of({12.34, 1, 5.5}, 10, false), 0.0, std::nullopt);
    EXPECT_NEAR(read->fps, 12.34, 1e-9);
    EXPECT_NEAR(read->start_frame, 5.5, 1e-9);
}

TEST(FrameTimes, HaveNoRateIfTheyAreIrregular)
{
    EXPECT_FALSE(frame_times({0.0, 0.9, 1.0}, 0.0, std::nullopt).has_value());
    EXPECT_FALSE(frame_times({1.0, 1.0}, 0.0, std::nullopt).has_value());
    EXPECT_FALSE(frame_times({0.0, NAN, 2.0}, 0.0, std::nullopt).has_value());
}

} // namespace
} // namespace toile::exports
