#include "research/benchmarks/text_table.h"

#include <algorithm>
#include <cstdio>

namespace toile::research {

namespace {

std::string markdown_line(const Row& row, const std::vector<size_t>& widths, char fill)
{
    std::string line = "|";
    for (size_t i = 0; i < row.size(); ++i)
        line += fill + row[i] + std::string(widths[i] - row[i].size(), fill) + fill + "|";
    return line + "\n";
}

/// Cells with commas are quoted [RFC 4180].
std::string csv_line(const Row& row)
{
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
        const bool is_quoted = row[i].find(',') != std::string::npos;
        line += (i > 0 ? "," : "") + (is_quoted ? '"' + row[i] + '"' : row[i]);
    }
    return line + "\n";
}

} // namespace

std::string format(const char* form, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, form, value);
    return text;
}

std::string markdown(const Row& header, const std::vector<Row>& rows)
{
    std::vector<size_t> widths;
    for (const std::string& cell : header)
        widths.push_back(cell.size());
    for (const Row& row : rows)
        for (size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());

    std::string table = markdown_line(header, widths, ' ');
    table += markdown_line(Row(widths.size()), widths, '-');
    for (const Row& row : rows)
        table += markdown_line(row, widths, ' ');
    return table;
}

std::string markdown_row(const Row& header, const Row& row)
{
    std::vector<size_t> widths;
    for (size_t i = 0; i < row.size(); ++i)
        widths.push_back(std::max(header[i].size(), row[i].size()));
    return markdown_line(row, widths, ' ');
}

std::string csv(const Row& header, const std::vector<Row>& rows)
{
    std::string table = csv_line(header);
    for (const Row& row : rows)
        table += csv_line(row);
    return table;
}

} // namespace toile::research
