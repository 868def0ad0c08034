#pragma once

#include <string>
#include <vector>

namespace toile::research {

/// Cells of one line of a table. All rows have the length of the header.
using Row = std::vector<std::string>;

/// A number formatted by printf.
std::string format(const char* form, double value);

/// Columns aligned: for terminals and for Markdown.
std::string markdown(const Row& header, const std::vector<Row>& rows);

/// Comma separated values. Cells contain no commas.
std::string csv(const Row& header, const std::vector<Row>& rows);

} // namespace toile::research
