#pragma once

#include "research/benchmarks/stress/run.h"

namespace toile::research::stress {

/// One line per case, columns aligned: for terminals and for Markdown.
std::string markdown_table(const std::vector<Result>& results);

/// Results as CSV with a header line.
std::string csv_table(const std::vector<Result>& results);

} // namespace toile::research::stress
