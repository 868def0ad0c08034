#include "export/folder_lock.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

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

/// Without waiting for them, one run in three was refused.
TEST_F(FolderLockTest, IsNotRefusedForTheProbesOfOthers)
{
    const FolderLock makes_the_file(folder_ / "other");
    write_bytes(FolderLock::file_in(folder_), "");
    const pid_t prober = ::fork();
    if (prober == 0)
        while (true)
            try {
                FolderLock::require_free(folder_);
            } catch (const InvalidInput&) { // locked by the parent
            }
    for (int k = 0; k < 300; ++k)
        EXPECT_EQ(refusal([&] { const FolderLock lock(folder_); }), "");
    ::kill(prober, SIGKILL);
    ::waitpid(prober, nullptr, 0);
}

/// Makes flock() fail in this process, as it does on file systems without locks.
bool forbid_locks(int error)
{
    struct sock_filter code[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_flock, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | uint32_t(error)),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    const struct sock_fprog program = {std::size(code), code};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST_F(FolderLockTest, WarnsOnFileSystemsWithoutLocks)
{
    constexpr int kNoFilters = 77;
    for (const int error : {ENOLCK, ENOSYS, EOPNOTSUPP}) {
        const pid_t child = ::fork();
        if (child == 0) {
            if (!forbid_locks(error))
                ::_exit(kNoFilters);
            std::string warning;
            {
                const FolderLock lock(file("out"), [&](const std::string& text) { warning += text; });
                FolderLock::require_free(file("out"));
            }
            const bool says = warning.find("would not be noticed") != std::string::npos;
            ::_exit(says && !std::filesystem::exists(file("out")) ? 0 : 1);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(WIFEXITED(status));
        if (WEXITSTATUS(status) == kNoFilters)
            GTEST_SKIP() << "system calls can't be made to fail here";
        EXPECT_EQ(WEXITSTATUS(status), 0) << std::strerror(error);
    }
}

} // namespace
} // namespace toile::test
