#include "core/base/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/cancellation.h"
#include "core/base/error.h"

namespace toile {

namespace {

/// Exit codes of the child, unlike those of a library that ends it; the pipe carries the result or the
/// refusal.
enum Outcome { kDone = 90, kRefused, kOutOfMemory };

/// Exit code of a program that can't be started, as shells have it.
constexpr int kNotStarted = 127;

/// Between two questions whether the work shall go on [ms].
constexpr int kPollInterval = 50;

void require(bool succeeded, const char* call)
{
    if (!succeeded)
        throw DeviceError(std::string("a child process can't be run: ") + call + ": " + std::strerror(errno));
}

void limit_address_space(std::size_t beyond_mapped)
{
    std::size_t mapped_pages = 0;
    std::ifstream("/proc/self/statm") >> mapped_pages;
    struct rlimit limit = {};
    ::getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur =
        std::min<rlim_t>(limit.rlim_cur, mapped_pages * rlim_t(::sysconf(_SC_PAGESIZE)) + beyond_mapped);
    ::setrlimit(RLIMIT_AS, &limit);
}

/// Makes this process one that ends silently. Interrupts are for the parent, which then ends this one.
void confine(const ChildBounds& bounds, pid_t parent)
{
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent)
        ::_exit(kDone); // the parent died before
    ::prctl(PR_SET_DUMPABLE, 0);
    for (int signal = 1; signal < NSIG; ++signal) // handlers of crashes are for the parent too
        ::signal(signal, SIG_DFL);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        ::signal(signal, SIG_IGN);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        ::dup2(nowhere, stream);
    limit_address_space(bounds.memory);
}

void write_all(int pipe, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = ::write(pipe, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR)
            ::abort();
        sent += std::size_t(std::max<ssize_t>(count, 0));
    }
}

[[noreturn]] void do_work(const std::function<std::string()>& work, int pipe) noexcept
{
    Outcome outcome = kDone;
    std::string text;
    try {
        text = work();
    } catch (const InvalidInput& refusal) {
        outcome = kRefused;
        text = refusal.what();
    } catch (const std::bad_alloc&) {
        outcome = kOutOfMemory;
    }
    write_all(pipe, text);
    ::_exit(outcome);
}

std::string name_of(int signal)
{
    const char* abbreviation = ::sigabbrev_np(signal);
    return abbreviation ? "SIG" + std::string(abbreviation) : "signal " + std::to_string(signal);
}

/// A child process and the end of the pipe that it writes to. Ends it if it still runs.
class Child {
public:
    /// @param run  work of the child, by the pipe; it does not return
    Child(const std::function<void(int)>& run, const ChildBounds& bounds)
    {
        // Another child that inherits the writing end would keep this one's pipe open.
        static std::mutex one_at_a_time;
        const std::scoped_lock lock(one_at_a_time);
        std::array<int, 2> pipe{};
        require(::pipe2(pipe.data(), O_CLOEXEC) == 0, "pipe");
        const pid_t parent = ::getpid();
        process_ = ::fork();
        if (process_ == 0) {
            ::close(pipe[0]);
            confine(bounds, parent);
            run(pipe[1]);
            ::abort();
        }
        pipe_ = pipe[0];
        ::close(pipe[1]);
        if (process_ < 0) {
            ::close(pipe_);
            require(false, "fork");
        }
    }
    ~Child()
    {
        ::close(pipe_);
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            ::waitpid(process_, nullptr, 0);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Appends what has come within kPollInterval.
    /// @return false at the end
    bool receive(std::string& text) const
    {
        struct pollfd readable = {pipe_, POLLIN, 0};
        if (::poll(&readable, 1, kPollInterval) <= 0)
            return true;
        std::array<char, 65536> part;
        const ssize_t count = ::read(pipe_, part.data(), part.size());
        if (count < 0)
            return errno == EINTR;
        text.append(part.data(), std::size_t(count));
        return count > 0;
    }

    /// Status as of waitpid().
    int wait()
    {
        int status = 0;
        pid_t ended = 0;
        do
            ended = ::waitpid(process_, &status, 0);
        while (ended < 0 && errno == EINTR);
        process_ = -1;
        require(ended > 0, "waitpid");
        return status;
    }

private:
    pid_t process_ = -1;
    int pipe_ = -1;
};

/// Receives what a child sends, until its end or a bound. @return status as of waitpid()
int receive_all(Child& child, const ChildBounds& bounds, std::string& text)
{
    using std::chrono::steady_clock;
    const auto end = steady_clock::now() + bounds.time;
    while (child.receive(text)) {
        Cancellation::check();
        if (steady_clock::now() > end)
            throw ChildStopped("took more than " + std::to_string(bounds.time.count() / 1000) + " s");
    }
    const int status = child.wait();
    if (WIFSIGNALED(status))
        throw ChildStopped("stopped with " + name_of(WTERMSIG(status)));
    return status;
}

[[noreturn]] void become(char* const* arguments, int pipe)
{
    ::dup2(pipe, STDOUT_FILENO);
    ::execvp(arguments[0], arguments);
    ::_exit(kNotStarted);
}

} // namespace

std::string in_child_process(const std::function<std::string()>& work, const ChildBounds& bounds)
{
    Child child([&](int pipe) { do_work(work, pipe); }, bounds);
    std::string text;
    const int status = receive_all(child, bounds, text);
    if (WEXITSTATUS(status) == kOutOfMemory)
        throw ChildStopped("needs more memory than it may take, at most " +
                           std::to_string(bounds.memory >> 20) + " MB");
    if (WEXITSTATUS(status) == kRefused)
        throw InvalidInput(text);
    if (WEXITSTATUS(status) != kDone)
        throw ChildStopped("ended early with exit code " + std::to_string(WEXITSTATUS(status)));
    return text;
}

ProgramEnd run_program(const std::vector<std::string>& command, const ChildBounds& bounds)
{
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    Child child([&](int pipe) { become(arguments.data(), pipe); }, bounds);
    ProgramEnd end;
    end.exit_code = WEXITSTATUS(receive_all(child, bounds, end.output));
    return end;
}

} // namespace toile
