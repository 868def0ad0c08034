#pragma once

#include <string>

namespace toile::app {

/// Number of the release, "0.1.0".
std::string version();

/// Two lines that tell one build of a program from another:
///
///   toile 0.1.0 (commit 1a2b3c4, Release)
///   backends: cpu, cuda 13.0 (sm 90, ptx 80)
///
/// A commit with a plus had changes that were not committed when the build was configured.
std::string version_text(const std::string& program);

} // namespace toile::app
