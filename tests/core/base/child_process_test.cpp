#include "core/base/child_process.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <unistd.h>

#include "core/base/cancellation.h"
#include "core/base/error.h"

namespace toile::test {

namespace {

using namespace std::chrono_literals;

constexpr ChildBounds kBounds{20s, std::size_t(256) << 20};

/// The address sanitizer has locks that fork() leaves held, and ends the process itself where memory is
/// short.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasAddressSanitizer = true;
#else
constexpr bool kHasAddressSanitizer = false;
#endif

/// How the work ends its child process, as messages say it.
std::string stop_of(const std::function<std::string()>& work, const ChildBounds& bounds = kBounds)
{
    try {
        return "returned " + in_child_process(work, bounds);
    } catch (const ChildStopped& stop) {
        return stop.what();
    }
}

std::string loop_for_ever()
{
    for (;;)
        ::pause();
}

} // namespace

TEST(ChildProcess, ReturnsWhatTheWorkReturns)
{
    EXPECT_EQ(in_child_process([] { return std::string(); }, kBounds), "");
    std::string large(3'000'000, '\0'); // more than a pipe holds
    EXPECT_EQ(in_child_process([&] { return large; }, kBounds), large);
}

TEST(ChildProcess, TellsAnExitOfALibraryFromAResult)
{
    for (const int code : {0, 1, 3})
        EXPECT_EQ(stop_of([&]() -> std::string { ::_exit(code); }),
                  "ended early with exit code " + std::to_string(code));
}

/// A child that another thread starts meanwhile keeps no pipe of this one open.
TEST(ChildProcess, EndsBesideALongerOne)
{
    if (kHasAddressSanitizer)
        GTEST_SKIP();
    std::atomic<bool> goes_on = true;
    std::thread others([&] {
        while (goes_on)
            stop_of(loop_for_ever, {20ms, kBounds.memory});
    });
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 30; ++i)
        EXPECT_EQ(in_child_process([] { return std::string("done"); }, kBounds), "done");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 15s);
    goes_on = false;
    others.join();
}

TEST(ChildProcess, PassesARefusalOn)
{
    const auto refuse = []() -> std::string { throw InvalidInput("file.fbx: no"); };
    try {
        in_child_process(refuse, kBounds);
        ADD_FAILURE();
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(), "file.fbx: no");
    }
}

TEST(ChildProcess, NamesTheSignalThatEndsIt)
{
    EXPECT_EQ(stop_of([]() -> std::string { std::abort(); }), "stopped with SIGABRT");
    EXPECT_EQ(stop_of([] { return std::raise(SIGSEGV) == 0 ? "survived" : ""; }), "stopped with SIGSEGV");
    EXPECT_EQ(stop_of([]() -> std::string { throw std::logic_error("unexpected"); }), "stopped with SIGABRT");
}

TEST(ChildProcess, EndsAtItsBounds)
{
    EXPECT_EQ(stop_of(loop_for_ever, {1s, kBounds.memory}), "took more than 1 s");
    if (kHasAddressSanitizer)
        GTEST_SKIP();
    EXPECT_EQ(stop_of([] { return std::string(std::size_t(512) << 20, ' '); }),
              "needs more memory than it may take, at most 256 MB");
}

/// Messages of asserts would come before the one line of an error; handlers of crashes are the program's own.
TEST(ChildProcess, EndsSilently)
{
    const auto previous = std::signal(SIGABRT, [](int) { ::_exit(0); });
    testing::internal::CaptureStderr();
    const std::string stop = stop_of([]() -> std::string {
        std::fputs("assertion failed\n", stderr);
        std::abort();
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    std::signal(SIGABRT, previous);
    EXPECT_EQ(stop, "stopped with SIGABRT");
}

TEST(ChildProcess, IsEndedWhenItsCallerIsCancelled)
{
    const std::function<bool()> goes_on = [] { return false; };
    const Cancellation::Scope scope(goes_on);
    EXPECT_THROW(in_child_process(loop_for_ever, kBounds), Cancelled);
}

TEST(ChildProcess, RunsBesideThreadsThatAllocate)
{
    if (kHasAddressSanitizer)
        GTEST_SKIP();
    std::atomic<bool> ended = false;
    std::vector<std::thread> threads;
    threads.reserve(4);
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            while (!ended)
                std::vector<std::string>(100, std::string(1000, 'x')).clear();
        });
    for (int i = 0; i < 50; ++i)
        EXPECT_EQ(in_child_process([] { return std::string(100'000, 'y'); }, kBounds).size(), 100'000u);
    ended = true;
    for (std::thread& thread : threads)
        thread.join();
}

TEST(ChildProcess, RunsAProgramAndTellsHowItEnded)
{
    const ProgramEnd said = toile::run_program({"sh", "-c", "echo \"$0 $1\"; exit 7", "a b", "c"}, kBounds);
    EXPECT_EQ(said.exit_code, 7);
    EXPECT_EQ(said.output, "a b c\n");
    EXPECT_EQ(toile::run_program({"/nowhere/program"}, kBounds).exit_code, 127);
    EXPECT_EQ(toile::run_program({"sh", "-c", "cat; echo lost >&2"}, kBounds).output, "")
        << "it has no input";
}

TEST(ChildProcess, EndsAProgramThatTakesTooLongOrIsStopped)
{
    const auto stop_of_program = [](const std::vector<std::string>& command, const ChildBounds& bounds) {
        try {
            return "ended with " + std::to_string(toile::run_program(command, bounds).exit_code);
        } catch (const ChildStopped& stop) {
            return std::string(stop.what());
        }
    };
    EXPECT_EQ(stop_of_program({"sleep", "60"}, {1s, kBounds.memory}), "took more than 1 s");
    EXPECT_EQ(stop_of_program({"sh", "-c", "kill -KILL $$"}, kBounds), "stopped with SIGKILL");
    const std::function<bool()> stops = [] { return false; };
    const Cancellation::Scope cancellation(stops);
    EXPECT_THROW(toile::run_program({"sleep", "60"}, kBounds), Cancelled);
}

} // namespace toile::test
