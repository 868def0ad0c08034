#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/temporary_folder.h"

namespace toile::test {

/// Result of a run of the program: exit code and both streams.
struct Finished {
    int exit_code = -1;
    std::string output;
    std::string errors;

    /// Number of lines on stderr that begin with "toile: error: ".
    int error_lines() const;
};

/// Runs a program with these arguments in `folder` and waits for its end.
Finished run_program(const char* program, const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder);

/// Runs toile with these arguments in `folder` and waits for its end.
Finished run_toile(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Runs a script of the shell in `folder`, in which "$TOILE" is the program, and waits for its end.
Finished run_shell(const std::string& script, const std::filesystem::path& folder);

/// A run of toile beside the test; killed at the end of its scope.
class Running {
public:
    Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    pid_t process() const { return process_; }
    /// Waits until the file exists, 20 s at most.
    static void wait_for_file(const std::filesystem::path& file);
    /// Sends a signal and waits for the end.
    Finished end(int signal);

private:
    TemporaryFolder streams_;
    pid_t process_;
};

/// Starts toile, sends SIGINT as soon as `file` exists, and waits for its end.
Finished run_and_interrupt(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                           const std::filesystem::path& file);

/// Small scene: a square of 0.4 m above a ball, `frames` samples; more keys may follow.
std::string small_scene(int frames, const std::string& more_keys = "");

} // namespace toile::test
