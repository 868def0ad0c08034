#pragma once

#include <string>
#include <vector>

namespace toile {

/// Cells of one line of a table. All rows of a table are as long as its header.
using Row = std::vector<std::string>;

/// A number as printf writes it.
std::string format(const char* form, double value);

/// Columns aligned: for terminals and for Markdown.
std::string markdown(const Row& header, const std::vector<Row>& rows);

/// Comma separated. Cells hold no commas.
std::string csv(const Row& header, const std::vector<Row>& rows);

} // namespace toile
