#include "apps/toile/simulate/scene_queue.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include <gtest/gtest.h>

namespace toile::test {

using namespace app;

namespace {

/// GPUs that run nothing and may fail, with a record of the scenes on them.
class FakeGpus {
public:
    std::map<int, std::size_t> breaks_with;          ///< GPU -> scene at which it is lost
    std::set<std::size_t> bad;                       ///< scenes that fail on every GPU
    std::size_t interrupted_after = std::size_t(-1); ///< number of scenes

    std::map<std::size_t, int> ran_on;           ///< scene -> GPU, failed scenes included
    std::map<std::size_t, std::string> left_out; ///< scene -> reason

    SceneQueue::Calls calls()
    {
        SceneQueue::Calls calls;
        calls.run = [this](std::size_t scene, int device) { return run(scene, device); };
        calls.is_responding = [this](int device) {
            const std::lock_guard lock(mutex_);
            return !lost_.contains(device);
        };
        calls.is_interrupted = [this] {
            const std::lock_guard lock(mutex_);
            return ran_on.size() >= interrupted_after;
        };
        calls.leave_out = [this](std::size_t scene, const std::string& reason) {
            EXPECT_TRUE(left_out.emplace(scene, reason).second) << scene;
        };
        return calls;
    }

private:
    bool run(std::size_t scene, int device)
    {
        {
            const std::lock_guard lock(mutex_);
            EXPECT_TRUE(ran_on.emplace(scene, device).second) << scene;
            EXPECT_FALSE(lost_.contains(device)) << "GPU " << device << " was given scene " << scene;
            const auto broken = breaks_with.find(device);
            if (broken != breaks_with.end() && broken->second == scene)
                lost_.insert(device);
            if (lost_.contains(device) || bad.contains(scene))
                return false;
        }
        // Long enough for the other GPU to take scenes too.
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return true;
    }

    std::mutex mutex_;
    std::set<int> lost_;
};

TEST(SceneQueue, RunsEveryScene)
{
    FakeGpus gpus;
    EXPECT_TRUE(SceneQueue(7, gpus.calls()).run({0, 1}));
    EXPECT_EQ(gpus.ran_on.size(), 7u);
    EXPECT_TRUE(gpus.left_out.empty());
}

TEST(SceneQueue, UsesNoMoreGpusThanScenes)
{
    FakeGpus gpus;
    EXPECT_TRUE(SceneQueue(2, gpus.calls()).run({3, 5, 7}));
    for (const auto& [scene, device] : gpus.ran_on)
        EXPECT_NE(device, 7) << scene;
}

TEST(SceneQueue, KeepsTheGpuAfterASceneFails)
{
    FakeGpus gpus;
    gpus.bad = {0, 2};
    EXPECT_FALSE(SceneQueue(5, gpus.calls()).run({4}));
    EXPECT_EQ(gpus.ran_on.size(), 5u);
    EXPECT_TRUE(gpus.left_out.empty());
}

/// Only the scene at which the GPU is lost fails, on whichever GPU that is.
TEST(SceneQueue, MovesTheScenesOfALostGpuToTheOthers)
{
    for (const int lost : {0, 1})
        for (const std::size_t scene : {0, 1}) {
            FakeGpus gpus;
            gpus.breaks_with[lost] = scene;
            const bool is_good = SceneQueue(8, gpus.calls()).run({0, 1});
            EXPECT_EQ(gpus.ran_on.size(), 8u);
            EXPECT_TRUE(gpus.left_out.empty());
            const bool broke = gpus.ran_on[scene] == lost;
            EXPECT_EQ(is_good, !broke);
            if (broke)
                EXPECT_EQ(
                    std::count_if(gpus.ran_on.begin(), gpus.ran_on.end(),
                                  [&](const auto& run) { return run.second == lost && run.first > scene; }),
                    0);
        }
}

TEST(SceneQueue, NamesEverySceneLeftWithoutAGpu)
{
    FakeGpus gpus;
    gpus.breaks_with[2] = 1;
    EXPECT_FALSE(SceneQueue(5, gpus.calls()).run({2}));
    EXPECT_EQ(gpus.ran_on.size(), 2u);
    ASSERT_EQ(gpus.left_out.size(), 3u);
    for (const std::size_t scene : {2, 3, 4})
        EXPECT_EQ(gpus.left_out[scene], "was not run: GPU 2 no longer answers") << scene;
}

/// Each GPU is lost with its first scene, whichever of the two scenes it takes.
TEST(SceneQueue, EndsWhenAllGpusAreLost)
{
    FakeGpus gpus;
    SceneQueue::Calls calls = gpus.calls();
    calls.run = [run = calls.run](std::size_t scene, int device) {
        run(scene, device);
        return false;
    };
    calls.is_responding = [](int) { return false; };
    EXPECT_FALSE(SceneQueue(6, calls).run({0, 1}));
    EXPECT_EQ(gpus.ran_on.size(), 2u);
    ASSERT_EQ(gpus.left_out.size(), 4u);
    EXPECT_EQ(gpus.left_out.begin()->second, "was not run: GPUs 0, 1 no longer answer");
}

TEST(SceneQueue, NamesTheScenesLeftByAnInterrupt)
{
    FakeGpus gpus;
    gpus.interrupted_after = 2;
    EXPECT_FALSE(SceneQueue(4, gpus.calls()).run({0}));
    ASSERT_EQ(gpus.left_out.size(), 2u);
    EXPECT_EQ(gpus.left_out[3], "interrupted before it was begun");
}

} // namespace
} // namespace toile::test
