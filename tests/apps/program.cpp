#include "tests/apps/program.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace toile::test {

namespace {

/// Forks and starts the program; both streams go to files.
pid_t start(const char* program, const std::vector<std::string>& arguments,
            const std::filesystem::path& folder, const std::filesystem::path& streams)
{
    const pid_t process = ::fork();
    if (process != 0)
        return process;
    const auto redirect = [&](const char* name, int descriptor) {
        const int file = ::open((streams / name).c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
        ::dup2(file, descriptor);
    };
    redirect("output", STDOUT_FILENO);
    redirect("errors", STDERR_FILENO);
    std::vector<char*> words{const_cast<char*>(program)};
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0)
        ::execv(program, words.data());
    ::_exit(127);
}

Finished wait_for(pid_t process, const std::filesystem::path& streams)
{
    int status = 0;
    ::waitpid(process, &status, 0);
    Finished finished;
    finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    finished.output = bytes_of(streams / "output");
    finished.errors = bytes_of(streams / "errors");
    return finished;
}

} // namespace

int Finished::error_lines() const
{
    int count = 0;
    std::istringstream lines(errors);
    for (std::string line; std::getline(lines, line);)
        count += line.rfind("toile: error: ", 0) == 0 ? 1 : 0;
    return count;
}

Finished run_program(const char* program, const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder)
{
    const TemporaryFolder streams;
    return wait_for(start(program, arguments, folder, streams.path()), streams.path());
}

Finished run_toile(const std::vector<std::string>& arguments, const std::filesystem::path& folder)
{
    return run_program(TOILE_PROGRAM, arguments, folder);
}

Finished run_shell(const std::string& script, const std::filesystem::path& folder)
{
    return run_program("/bin/sh", {"-c", "TOILE=" TOILE_PROGRAM "\n" + script}, folder);
}

Running::Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder)
    : process_(start(TOILE_PROGRAM, arguments, folder, streams_.path()))
{
}

Running::~Running()
{
    if (process_ > 0)
        end(SIGKILL);
}

void Running::wait_for_file(const std::filesystem::path& file)
{
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!std::filesystem::exists(file) && std::chrono::steady_clock::now() < give_up)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

Finished Running::end(int signal)
{
    ::kill(process_, signal);
    return wait_for(std::exchange(process_, 0), streams_.path());
}

Finished run_and_interrupt(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                           const std::filesystem::path& file)
{
    Running run(arguments, folder);
    Running::wait_for_file(file);
    return run.end(SIGINT);
}

std::string small_scene(int frames, const std::string& more_keys)
{
    return R"({"toile": 1, "frames": )" + std::to_string(frames) + R"(,
        "avatars": [{"name": "ball", "sphere": {"radius": 0.2}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.4], "resolution": 0.05},
                    "translate": [0, 0.25, 0]}],
        "render": {"width": 64, "height": 48, "samples": 1, "ground": -0.2})" +
           (more_keys.empty() ? "" : ", " + more_keys) + "}";
}

} // namespace toile::test
