#include "tests/apps/kill_points.h"

#include <csignal>

#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace toile::test {

namespace {

bool changes_a_file(const __ptrace_syscall_info& call)
{
    const auto* const a = call.entry.args;
    switch (call.entry.nr) {
    case SYS_openat:
        return (a[2] & O_CREAT) != 0;
    case SYS_write:
        return a[0] > STDERR_FILENO;
    case SYS_pwrite64:
    case SYS_ftruncate:
    case SYS_renameat:
    case SYS_renameat2:
    case SYS_unlinkat:
    case SYS_mkdirat:
#ifdef SYS_rename // newer machines have the calls with "at" alone
    case SYS_rename:
    case SYS_unlink:
    case SYS_rmdir:
    case SYS_mkdir:
#endif
        return true;
    default:
        return false;
    }
}

/// Forks a child that waits to be traced and then starts the program; its output is dropped.
pid_t start_traced(const std::vector<std::string>& arguments, const std::filesystem::path& folder)
{
    const pid_t process = ::fork();
    if (process != 0)
        return process;
    const int null = ::open("/dev/null", O_RDWR);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    std::vector<char*> words{const_cast<char*>(TOILE_PROGRAM)};
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    ::raise(SIGSTOP);
    if (::chdir(folder.c_str()) == 0)
        ::execv(words[0], words.data());
    ::_exit(127);
}

bool enters_a_change(pid_t thread)
{
    __ptrace_syscall_info call{};
    const bool is_known = ::ptrace(PTRACE_GET_SYSCALL_INFO, thread, sizeof call, &call) > 0;
    return is_known && call.op == PTRACE_SYSCALL_INFO_ENTRY && changes_a_file(call);
}

} // namespace

KillResult kill_at(int n, const std::vector<std::string>& arguments, const std::filesystem::path& folder)
{
    const pid_t process = start_traced(arguments, folder);
    int status = 0;
    ::waitpid(process, &status, WUNTRACED);
    constexpr long kOptions = PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_EXITKILL;
    if (::ptrace(PTRACE_SEIZE, process, 0, kOptions) != 0) {
        ::kill(process, SIGKILL);
        ::waitpid(process, &status, 0);
        return KillResult::Unsupported;
    }
    ::kill(process, SIGCONT);

    // Let every thread run to its next system call; count those that change a file.
    int count = 0;
    bool is_killed = false;
    for (pid_t thread; (thread = ::waitpid(-1, &status, __WALL)) > 0;) {
        if (!WIFSTOPPED(status)) {
            if (thread == process)
                return is_killed ? KillResult::Killed : KillResult::Ended;
            continue;
        }
        const int stop = WSTOPSIG(status);
        if (stop == (SIGTRAP | 0x80) && !is_killed && enters_a_change(thread) && count++ == n) {
            is_killed = true;
            ::kill(process, SIGKILL);
            continue;
        }
        const bool is_signal = status >> 16 == 0 && stop != (SIGTRAP | 0x80) && stop != SIGTRAP;
        ::ptrace(PTRACE_SYSCALL, thread, 0, is_signal ? stop : 0);
    }
    return KillResult::Ended;
}

} // namespace toile::test
