#include "apps/toile/drape/drape_progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace toile::test {

using namespace app;

namespace {

/// What is told of a stage that is in its second sample when it has lasted long enough for a line.
std::string told(const scenes::DrapeProgress& first, const scenes::DrapeProgress& second)
{
    ::testing::internal::CaptureStderr();
    {
        SetupProgress progress(false);
        DrapeProgressLine line(progress);
        line.update(first);
        line.update_world("step 3, iteration 41", 0.4); // of a sample that takes no time
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        line.update(second);
    }
    return ::testing::internal::GetCapturedStderr();
}

TEST(DrapeProgressLine, TellsTheTimeLeftOfStagesWithADuration)
{
    EXPECT_EQ(told({"press", 0.1, 0.5, 1.0}, {"press", 0.2, 0.5, 2.0}),
              "press: 0.20 s of 0.50 s simulated, 3 s left\n");
}

TEST(DrapeProgressLine, TellsNoTimeLeftOfStagesWithoutAnEnd)
{
    EXPECT_EQ(told({"sew", 0.1, 0.0, 1.0}, {"sew", 0.2, 0.0, 2.0}), "sew: 0.20 s simulated\n");
}

TEST(DrapeProgressLine, TellsTheWorldThatLoads)
{
    ::testing::internal::CaptureStderr();
    {
        SetupProgress progress(false);
        DrapeProgressLine line(progress);
        line.update({"sew", 0.0, 0.0, 0.0});
        line.update_world("loading", 0.0);
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        line.update_world("loading", 1.0);
    }
    const std::string text = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(text.rfind("sew: loading: 100 %, done in ", 0), 0u) << text;
}

} // namespace
} // namespace toile::test
