#pragma once

#include <string>
#include <vector>

namespace toile::research {

/// Cells of one line of a table. All rows have the length of the header.
using Row = std::vector<std::string>;

/// One row per result.
template <typename Result, typename CellsOf>
std::vector<Row> rows_of(const std::vector<Result>& results, const CellsOf& cells_of)
{
    std::vector<Row> rows;
    rows.reserve(results.size());
    for (const Result& result : results)
        rows.push_back(cells_of(result));
    return rows;
}

/// A number formatted by printf.
std::string format(const char* form, double value);

/// Columns aligned: for terminals and for Markdown.
std::string markdown(const Row& header, const std::vector<Row>& rows);

/// A further line of a markdown() table of `header` alone; longer cells push the rest aside.
std::string markdown_row(const Row& header, const Row& row);

/// Comma separated values; cells with commas are quoted.
std::string csv(const Row& header, const std::vector<Row>& rows);

} // namespace toile::research
