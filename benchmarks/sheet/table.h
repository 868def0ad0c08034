#pragma once

#include "benchmarks/sheet/run.h"

namespace toile::sheet {

/// One line per setting, columns aligned: for terminals and for Markdown.
std::string markdown_table(const Sheet& sheet, const std::vector<Result>& results);

/// The same numbers with a header line, comma separated.
std::string csv_table(const Sheet& sheet, const std::vector<Result>& results);

} // namespace toile::sheet
