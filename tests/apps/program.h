#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

/// Starts toile, sends SIGINT as soon as `file` exists, and waits for its end.
Finished run_and_interrupt(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                           const std::filesystem::path& file);

/// Small scene: a square of 0.4 m above a ball, `frames` samples; more keys may follow.
std::string small_scene(int frames, const std::string& more_keys = "");

} // namespace toile::test
