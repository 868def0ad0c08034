#include <cfenv>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/stages.h"
#include "core/compute/parallel.h"
#include "core/compute/types.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

/// Runs `work` on an arena of that many threads, even more than the machine has.
template <typename Work>
auto on_threads(int thread_count, const Work& work)
{
    tbb::task_arena arena(thread_count);
    return arena.execute(work);
}

/// Numbers of very different magnitude and both signs, so that every order of summation rounds differently.
std::vector<double> rough_numbers(int count)
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
    std::uniform_int_distribution<int> exponent(-20, 20);
    std::vector<double> numbers(count);
    for (double& number : numbers)
        number = std::ldexp(mantissa(random), exponent(random));
    return numbers;
}

double sum_on_threads(int thread_count, const std::vector<double>& numbers)
{
    return on_threads(thread_count, [&] {
        return parallel_sum(kCpu, int(numbers.size()), 0.0, [&](int i) { return numbers[i]; });
    });
}

uint64_t bits(double value)
{
    uint64_t pattern = 0;
    std::memcpy(&pattern, &value, sizeof value);
    return pattern;
}

/// Limits the bytes per file that this process can write until the end of the scope, like a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t limit) : old_handler_(std::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &old_limit_);
        const rlimit small{limit, old_limit_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    ~FileSizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &old_limit_);
        std::signal(SIGXFSZ, old_handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    void (*old_handler_)(int);
    rlimit old_limit_{};
};

/// Message of the Error that `action` throws; empty if it throws none.
template <typename Error, typename Action>
std::string message_of(const Action& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

} // namespace

TEST(View, BorrowsWithoutCopying)
{
    std::vector<int> numbers{1, 2, 3, 4};
    const View<int> view(numbers);
    view[2] = 30;
    const View<const int> constant = view;
    EXPECT_EQ(numbers[2], 30);
    EXPECT_EQ(constant.data(), numbers.data());
    EXPECT_EQ(constant.size(), 4);
    EXPECT_TRUE(View<int>().empty());
}

TEST(View, CutsOutASubview)
{
    std::vector<int> numbers{1, 2, 3, 4};
    const View<const int> middle = View<const int>(numbers).subview(1, 2);
    EXPECT_EQ(std::vector<int>(middle.begin(), middle.end()), (std::vector<int>{2, 3}));
}

TEST(ParallelFor, VisitsEachItemOnce)
{
    for (const int count : {0, 1, kGrain, kGrain + 1, 100003})
        for (const int thread_count : {1, 2, 8}) {
            std::vector<int> visits(count, 0);
            on_threads(thread_count,
                       [&] { parallel_for(kCpu, "test/visit", count, [&](int i) { ++visits[i]; }); });
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << thread_count << " threads";
        }
}

TEST(ParallelFor, ComputesWithTheFloatingPointSettingsOfItsCaller)
{
    // 1 - 1e-20 is below one only if rounded towards zero.
    const auto below_one = [](int) {
        const volatile double one = 1.0, little = 1e-20;
        return one - little < 1.0 ? 1 : 0;
    };
    on_threads(4, [&] {
        for (const int mode : {FE_TONEAREST, FE_TOWARDZERO, FE_TONEAREST}) {
            std::fesetround(mode);
            std::vector<int> found(100000);
            parallel_for(kCpu, "test", int(found.size()), [&](int i) { found[i] = below_one(i); });
            const int sum = parallel_sum(kCpu, int(found.size()), 0, below_one);
            std::fesetround(FE_TONEAREST);
            const int expected = mode == FE_TOWARDZERO ? int(found.size()) : 0;
            EXPECT_EQ(std::accumulate(found.begin(), found.end(), 0), expected);
            EXPECT_EQ(sum, expected);
        }
    });
}

TEST(ParallelSum, HasTheSameBitsForEveryThreadCount)
{
    const std::vector<double> numbers = rough_numbers(100003);
    const uint64_t expected = bits(sum_on_threads(1, numbers));
    for (const int thread_count : {2, 8})
        for (int repeat = 0; repeat < 20; ++repeat)
            ASSERT_EQ(bits(sum_on_threads(thread_count, numbers)), expected) << thread_count << " threads";
}

TEST(ParallelSum, EqualsTheLongDoubleSumWithinRounding)
{
    for (const int count : {0, 1, 2047, 2048, 2049, 100003}) {
        const std::vector<double> numbers = rough_numbers(count);
        long double sum = 0.0L;
        long double magnitude = 0.0L;
        for (const double number : numbers) {
            sum += number;
            magnitude += std::fabs(number);
        }
        // Rounding bound of a sum: sequential additions (one block, then the blocks) times half an ulp each.
        const double row = 2048.0 + count / 2048.0 + 1.0;
        const double bound = row * 0x1p-53 * double(magnitude);
        EXPECT_NEAR(sum_on_threads(2, numbers), double(sum), bound) << count << " numbers";
    }
}

TEST(ParallelSum, SumsVectors)
{
    const Vec3 sum =
        parallel_sum(kCpu, 5000, Vec3(Vec3::Zero()), [](int i) { return Vec3(1.0, double(i), -double(i)); });
    EXPECT_EQ(sum, Vec3(5000.0, 12497500.0, -12497500.0));
}

TEST(Stages, CountsCallsOfParallelForAndScopes)
{
    Stages stages;
    {
        const Stages::Activate activate(stages);
        for (int repeat = 0; repeat < 3; ++repeat)
            parallel_for(kCpu, "test/kernel", 1000, [](int) {});
        const StageScope scope("test/scope");
    }
    EXPECT_EQ(stages.calls("test/kernel"), 3);
    EXPECT_EQ(stages.calls("test/scope"), 1);
    EXPECT_EQ(stages.calls("test/never"), 0);
    EXPECT_EQ(stages.seconds("test/never"), 0.0);
    EXPECT_EQ(stages.entries().size(), 2u);
    stages.clear();
    EXPECT_EQ(stages.calls("test/kernel"), 0);
}

TEST(Stages, TimeOfTheOuterStageIncludesTheInner)
{
    Stages stages;
    const Stages::Activate activate(stages);
    {
        const StageScope outer("test/outer");
        const StageScope inner("test/inner");
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_GE(stages.seconds("test/inner"), 0.005);
    EXPECT_GE(stages.seconds("test/outer"), stages.seconds("test/inner"));
}

TEST(Stages, SelfTimesAddUpToTheOutermostStage)
{
    Stages stages;
    const Stages::Activate activate(stages);
    const auto wait = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
    {
        const StageScope outer("test/outer");
        {
            const StageScope middle("test/middle");
            const StageScope inner("test/inner");
            wait(4);
        }
        const StageScope inner("test/inner");
        wait(2);
    }
    double self_total = 0.0;
    for (const auto& [name, entry] : stages.entries())
        self_total += entry.self_seconds;
    EXPECT_NEAR(self_total, stages.seconds("test/outer"), 1e-9);
    EXPECT_EQ(stages.entries().at("test/inner").self_seconds, stages.seconds("test/inner"));
    EXPECT_LT(stages.entries().at("test/middle").self_seconds, 0.5 * stages.seconds("test/middle"));
    EXPECT_LT(stages.entries().at("test/outer").self_seconds, 0.5 * stages.seconds("test/outer"));
}

TEST(Stages, RecordNothingWithoutActivation)
{
    Stages stages;
    {
        const StageScope scope("test/scope");
    }
    EXPECT_EQ(Stages::active(), nullptr);
    EXPECT_TRUE(stages.entries().empty());
}

TEST(Stages, ActivationEndsWithItsScopeAndRestoresTheOuterOne)
{
    Stages outer;
    Stages inner;
    {
        const Stages::Activate activate_outer(outer);
        {
            const Stages::Activate activate_inner(inner);
            const StageScope scope("test/scope");
        }
        EXPECT_EQ(Stages::active(), &outer);
        const StageScope scope("test/scope");
    }
    EXPECT_EQ(Stages::active(), nullptr);
    EXPECT_EQ(inner.calls("test/scope"), 1);
    EXPECT_EQ(outer.calls("test/scope"), 1);
}

TEST(Stages, OfTwoThreadsAreIndependent)
{
    Stages mine;
    const Stages::Activate activate(mine);
    auto other_calls = std::async(std::launch::async, [] {
        EXPECT_EQ(Stages::active(), nullptr);
        Stages stages;
        const Stages::Activate activate_other(stages);
        parallel_for(kCpu, "test/other", 10, [](int) {});
        return stages.calls("test/other");
    });
    EXPECT_EQ(other_calls.get(), 1);
    EXPECT_TRUE(mine.entries().empty());
}

TEST(NearestWord, FindsTheMisspelledKey)
{
    const std::vector<std::string> keys{"friction", "thickness", "frames"};
    EXPECT_EQ(nearest_word("fricton", keys), "friction");     // a letter missing
    EXPECT_EQ(nearest_word("thicknesss", keys), "thickness"); // one too many
    EXPECT_EQ(nearest_word("frbmes", keys), "frames");        // one replaced
    EXPECT_EQ(nearest_word("frames", keys), "frames");
}

TEST(NearestWord, IsEmptyWhenNoneIsNearerThanHalfTheWord)
{
    EXPECT_EQ(nearest_word("abcd", {"abxy"}), "abxy");
    EXPECT_EQ(nearest_word("abcd", {"axyz"}), "");
    EXPECT_EQ(nearest_word("gravity", {}), "");
}

TEST(NearestWord, PrefersTheFirstOfEquallyNear) { EXPECT_EQ(nearest_word("warp", {"wasp", "ware"}), "wasp"); }

TEST(WriteAtomically, CreatesFoldersAndReplacesTheOldContent)
{
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "a/b/mesh.obj";
    write_atomically(file, "old and longer");
    write_atomically(file, std::string_view("new\0", 4));
    EXPECT_EQ(bytes_of(file), std::string("new\0", 4));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()),
                            std::filesystem::directory_iterator()),
              1);
}

TEST(WriteAtomically, LeavesTheOldFileWhenTheDiskIsFull)
{
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "cache.pc2";
    write_atomically(file, "old");
    std::string message;
    {
        const FileSizeLimit limit(4096);
        message = message_of<DeviceError>([&] { write_atomically(file, std::string(100000, 'x')); });
    }
    EXPECT_EQ(message, file.string() + ": writing broke off (File too large)");
    EXPECT_EQ(bytes_of(file), "old");
    EXPECT_EQ(folder.snapshot().size(), 1u);
}

TEST(WriteAtomically, RefusesANameThatAFolderHas)
{
    const TemporaryFolder folder;
    const std::filesystem::path taken = folder.path() / "taken";
    std::filesystem::create_directories(taken);
    const std::string message = message_of<InvalidInput>([&] { write_atomically(taken, "text"); });
    EXPECT_EQ(message, taken.string() + ": can't be replaced (Is a directory); choose another name");
    EXPECT_TRUE(std::filesystem::is_directory(taken));
    EXPECT_EQ(folder.snapshot().size(), 1u);
}

TEST(WriteAtomically, RefusesAFolderThatCannotBeCreated)
{
    const TemporaryFolder folder;
    write_atomically(folder.path() / "file", "old");
    const std::filesystem::path file = folder.path() / "file/below.obj";
    const std::string message = message_of<InvalidInput>([&] { write_atomically(file, "text"); });
    EXPECT_EQ(message,
              file.string() + ": its folder can't be created (Not a directory); choose a writable folder");
    EXPECT_EQ(bytes_of(folder.path() / "file"), "old");
}

} // namespace toile::test
