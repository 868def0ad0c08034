#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace toile {

/// What a run of the program left: exit code and both streams.
struct Finished {
    int exit_code = -1;
    std::string output;
    std::string errors;

    /// Lines on stderr that begin with "toile: error: ".
    int error_lines() const;
};

/// Runs toile with these arguments in `folder` and waits.
Finished run_toile(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// Starts toile, sends SIGINT as soon as `file` exists, and waits.
Finished run_and_interrupt(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                           const std::filesystem::path& file);

/// A small scene: a square of 0.4 m above a ball, `frames` samples; more keys may follow.
std::string small_scene(int frames, const std::string& more_keys = "");

} // namespace toile
