#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::test {

/// End of a run that was killed at a system call.
enum class KillResult {
    Killed,      ///< before the call took effect
    Ended,       ///< the run makes fewer calls
    Unsupported, ///< this machine lets no process trace another
};

/// Runs toile in `folder` and kills it (SIGKILL) where it enters the n-th system call, from 0, by which it
/// creates, writes, renames or removes a file.
KillResult kill_at(int n, const std::vector<std::string>& arguments, const std::filesystem::path& folder);

} // namespace toile::test
