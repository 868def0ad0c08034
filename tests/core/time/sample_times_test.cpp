#include "core/time/sample_times.h"

#include <gtest/gtest.h>

namespace toile::test {

namespace {

const std::vector<double> kTimes{0.1, 0.2, 0.7};

void expect_place(double t, int sample, double part)
{
    const SamplePlace place = place_in(kTimes, t);
    EXPECT_EQ(place.sample, sample) << t;
    EXPECT_NEAR(place.part, part, 1e-15) << t;
}

TEST(SampleTimes, PlaceATimeBetweenTheSamplesAroundIt)
{
    expect_place(0.15, 0, 0.5);
    expect_place(0.325, 1, 0.25);
}

TEST(SampleTimes, HoldTheFirstAndTheLastSample)
{
    expect_place(-3.0, 0, 0.0);
    expect_place(0.7, 2, 0.0);
    expect_place(9.0, 2, 0.0);
    EXPECT_EQ(place_in({5.0}, 4.0).sample, 0);
    EXPECT_EQ(place_in({5.0}, 6.0).part, 0.0);
}

TEST(SampleTimes, OfQuotientsAreThoseOfTheirSamples)
{
    std::vector<double> times;
    for (int k = 0; k < 2000; ++k)
        times.push_back(k / 29.97);
    for (const int k : {1, 7, 1111, 1998})
        for (const double error : {-1e-13, 0.0, 1e-13}) {
            const SamplePlace place = place_in(times, times[size_t(k)] + error);
            EXPECT_EQ(place.sample, k);
            EXPECT_EQ(place.part, 0.0);
        }
}

TEST(SampleTimes, AreIncreasingOrTheFirstThatIsNotIsNamed)
{
    EXPECT_FALSE(first_not_increasing(kTimes));
    EXPECT_FALSE(first_not_increasing({}));
    EXPECT_EQ(first_not_increasing({0.0, 1.0, 1.0}), 2);
    EXPECT_EQ(first_not_increasing({0.0, -1.0, 1.0}), 1);
}

} // namespace

} // namespace toile::test
