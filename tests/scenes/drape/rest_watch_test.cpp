#include "scenes/drape/rest_watch.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace scenes;

namespace {

constexpr double kFrame = 1.0 / 30.0; ///< [s]

/// A still vertex and one that moves along x by `step` [m] a frame.
RestWatch watch_of(double step, int frames)
{
    RestWatch watch(kFrame);
    for (int k = 0; k < frames; ++k)
        watch.add(std::vector<Vec3>{Vec3::Zero(), Vec3(step * k, 1.0, 0.0)});
    return watch;
}

TEST(RestWatch, NeedsHalfASecond)
{
    EXPECT_FALSE(watch_of(0.0, 15).is_at_rest());
    EXPECT_TRUE(watch_of(0.0, 16).is_at_rest());
}

TEST(RestWatch, SeesTheFastestVertex)
{
    EXPECT_NEAR(watch_of(0.001, 20).speed(), 0.03, 1e-12);
    EXPECT_FALSE(watch_of(0.001, 20).is_at_rest());
}

TEST(RestWatch, SeesSlowMotionThatGoesOn)
{
    // 6 mm/s are slow, but 3 mm in half a second.
    EXPECT_FALSE(watch_of(0.0002, 20).is_at_rest());
    EXPECT_TRUE(watch_of(0.0001, 20).is_at_rest());
}

TEST(RestWatch, ForgetsWhatIsPast)
{
    RestWatch watch(kFrame);
    for (int k = 0; k < 36; ++k)
        watch.add(std::vector<Vec3>{Vec3(k < 20 ? 0.1 * k : 1.9, 0.0, 0.0)});
    EXPECT_TRUE(watch.is_at_rest());
}

} // namespace

} // namespace toile::test
