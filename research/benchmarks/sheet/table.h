#pragma once

#include "research/benchmarks/sheet/run.h"

namespace toile::research::sheet {

/// One line per setting, columns aligned: for terminals and for Markdown.
std::string markdown_table(const Sheet& sheet, const std::vector<Result>& results);

/// Results as CSV with a header line.
std::string csv_table(const Sheet& sheet, const std::vector<Result>& results);

} // namespace toile::research::sheet
