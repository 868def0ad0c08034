#pragma once

#include "research/benchmarks/stress/run.h"
#include "research/benchmarks/stress/solid_run.h"

namespace toile::research::stress {

/// One line per case, columns aligned: for terminals and for Markdown.
std::string markdown_table(const std::vector<Result>& results);
std::string markdown_table(const std::vector<SolidResult>& results);

/// Results as CSV with a header line.
std::string csv_table(const std::vector<Result>& results);
std::string csv_table(const std::vector<SolidResult>& results);

} // namespace toile::research::stress
