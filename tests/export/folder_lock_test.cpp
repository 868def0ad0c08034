#include "export/folder_lock.h"

#include <csignal>
#include <fstream>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/export/export_fixtures.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

using FolderLockTest = ExportTest;

TEST_F(FolderLockTest, RefusesASecondRunAndNamesTheFirst)
{
    const std::filesystem::path folder = file("new/deep");
    {
        const FolderLock first(folder);
        const std::string message = refusal([&] { const FolderLock second(folder); });
        EXPECT_THAT(message, HasSubstr("another run is writing there, process " + std::to_string(::getpid()) +
                                       " on host "));
        EXPECT_EQ(refusal([&] { FolderLock::require_free(folder); }), message);
    }
    EXPECT_EQ(refusal([&] { FolderLock::require_free(folder); }), "");
    EXPECT_TRUE(std::filesystem::is_empty(folder_)) << "folders that stayed empty are removed";
}

TEST_F(FolderLockTest, KeepsFoldersWithFiles)
{
    {
        const FolderLock lock(file("out"));
        write_bytes(file("out/cache"), "x");
    }
    EXPECT_EQ(bytes_of(file("out/cache")), "x");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("out")), {}), 1);
}

TEST_F(FolderLockTest, TakesOverTheLockOfADeadProcess)
{
    const pid_t child = ::fork();
    if (child == 0) {
        const FolderLock lock(folder_);
        ::raise(SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_THAT(bytes_of(FolderLock::file_in(folder_)), HasSubstr("process " + std::to_string(child)));
    const FolderLock lock(folder_);
    EXPECT_THAT(bytes_of(FolderLock::file_in(folder_)), HasSubstr("process " + std::to_string(::getpid())));
}

/// Four processes take and release the lock as fast as they can; whoever has it creates a file that must not
/// exist yet. Without the comparison of inodes after flock(), a process keeps a file that is removed already.
TEST_F(FolderLockTest, IsHeldByOneProcessAtATime)
{
    constexpr int kRounds = 100;
    std::vector<pid_t> processes;
    for (int p = 0; p < 4; ++p) {
        processes.push_back(::fork());
        if (processes.back() != 0)
            continue;
        for (int held = 0; held < kRounds;)
            try {
                const FolderLock lock(folder_);
                const int token = ::open(file("token").c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
                if (token < 0)
                    ::_exit(1);
                ::close(token);
                ::unlink(file("token").c_str());
                ++held;
            } catch (const InvalidInput&) { // held by another one
            }
        ::_exit(0);
    }
    for (const pid_t process : processes) {
        int status = 0;
        ::waitpid(process, &status, 0);
        EXPECT_EQ(status, 0);
    }
}

} // namespace
} // namespace toile::test
