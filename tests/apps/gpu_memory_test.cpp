#include <iostream>

#include <gtest/gtest.h>

#include "export/point_cache.h"
#include "tests/apps/program.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/core/compute/cuda/taken_memory.h"

/// Scenes on a GPU with little free memory.
namespace toile::test {

using namespace exports;

namespace {

constexpr int kFrames = 3;

/// Five cloths that fall onto each other.
std::string cloths_scene()
{
    std::string cloths;
    for (int i = 0; i < 5; ++i)
        cloths += std::string(i > 0 ? ", " : "") + R"({"name": "c)" + std::to_string(i) +
                  R"(", "rectangle": {"size": [1, 1], "resolution": 0.01}, "translate": [0, )" +
                  std::to_string(0.004 * i) + ", 0]}";
    return R"({"toile": 1, "frames": )" + std::to_string(kFrames) +
           R"(, "solver": {"method": "quadrature"}, "cloths": [)" + cloths +
           R"(], "export": [{"cloth": "c0", "file": "c0.pc2"}]})";
}

class GpuMemoryTest : public test::OnDevice {
protected:
    void SetUp() override
    {
        OnDevice::SetUp();
        folder_.write("cloths.json", cloths_scene());
    }

    /// Runs the scene in a separate process with so much memory free. The run succeeds, or ends with one line
    /// that names the purpose of the missing memory. It never leaves an incomplete cache or an unreadable
    /// partial one.
    Finished run_with(int mebibytes)
    {
        const auto taken = test::take_all_but(std::size_t(mebibytes) << 20, space());
        const std::filesystem::path out = folder_.path() / "out";
        std::filesystem::remove_all(out);
        Finished run = run_on("cuda");
        std::cout << mebibytes << " MiB: " << (run.exit_code == 0 ? "ran\n" : run.errors);
        const std::filesystem::path cache = out / "c0.pc2", partial = out / "c0.partial.pc2";
        EXPECT_EQ(std::filesystem::exists(cache), run.exit_code == 0);
        if (run.exit_code == 0) {
            EXPECT_EQ(read_cache(cache).frame_count(), kFrames);
        } else {
            EXPECT_EQ(run.exit_code, 1);
            EXPECT_EQ(run.error_lines(), 1) << run.errors;
            EXPECT_NE(run.errors.find("out of memory"), std::string::npos) << run.errors;
            EXPECT_EQ(run.output, std::filesystem::exists(partial) ? "out/c0.partial.pc2\n" : "");
        }
        if (std::filesystem::exists(partial)) {
            EXPECT_GE(read_cache(partial).frame_count(), 1);
        }
        return run;
    }

    Finished run_on(const std::string& backend)
    {
        return run_toile({"simulate", "cloths.json", "--backend", backend, "-o", "out", "--quiet",
                          "--no-check", "--report", "run.json"},
                         folder_.path());
    }

private:
    TemporaryFolder folder_;
};

/// Near the minimum that the scene needs, arrays of the scene fail to allocate. Which of them depends on the
/// memory left.
TEST_F(GpuMemoryTest, EndsCleanlyWhenMemoryIsTooSmall)
{
    int enough = 4096, too_little = 0;
    ASSERT_EQ(run_with(enough).exit_code, 0);
    bool names_array = false;
    while (enough - too_little > 16) {
        const int left = (enough + too_little) / 2;
        const Finished run = run_with(left);
        (run.exit_code == 0 ? enough : too_little) = left;
        names_array |= test::contains_in_order(run.errors, "CUDA device 0 (", ") is out of memory: '",
                                               "' asked for ", " MiB, ", " MiB are free");
    }
    EXPECT_GT(too_little, 0);
    EXPECT_TRUE(names_array);
}

TEST_F(GpuMemoryTest, IsCheckedBeforeAutoSelectsTheGpu)
{
    EXPECT_EQ(run_on("auto").errors, "");
    const auto run_with_left = [&](int mebibytes) {
        const auto taken = test::take_all_but(std::size_t(mebibytes) << 20, space());
        const Finished run = run_on("auto");
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        return run.errors;
    };
    const std::string too_little = run_with_left(1024), nothing = run_with_left(50);
    EXPECT_TRUE(test::contains_in_order(too_little, "the backend is cpu: CUDA device 0 (", ") has ",
                                        " MiB left, 51005 vertices may take ", " MiB"))
        << too_little;
    EXPECT_TRUE(test::contains_in_order(nothing, "the backend is cpu: ", "CUDA device 0 (", "out of memory"))
        << nothing;
}

} // namespace
} // namespace toile::test
