#pragma once

#include "benchmarks/stress/run.h"

namespace toile::stress {

/// One line per case, columns aligned: for terminals and for Markdown.
std::string markdown_table(const std::vector<Result>& results);

/// The same numbers with a header line, comma separated.
std::string csv_table(const std::vector<Result>& results);

} // namespace toile::stress
