#include "benchmarks/stress/table.h"

#include <algorithm>
#include <cstdio>

namespace toile::stress {

namespace {

using Row = std::vector<std::string>;

std::string format(const char* form, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, form, value);
    return text;
}

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

Row cells_of(const Result& r)
{
    return {r.name,
            std::to_string(r.steps),
            format("%.1f", r.iterations_per_step),
            format("%.2f", r.ms_per_step),
            format("%.1e", r.final_speed),
            format("%.3f", r.max_strain),
            format("%.3f", r.energy_ratio),
            format("%.3f", r.end_energy),
            r.drift > 0.0 ? format("%.1e", r.drift) : "",
            yes_or_no(r.is_finite),
            yes_or_no(r.rests),
            yes_or_no(r.holds)};
}

const Row kMarkdownHeader{"case",        "steps",      "iterations", "ms/step", "end speed m/s", "max strain",
                          "peak energy", "end energy", "drift m",    "finite",  "rests",         "holds"};
const Row kCsvHeader{"case",       "steps",        "iterations_per_step", "ms_per_step", "end_speed_m_per_s",
                     "max_strain", "energy_ratio", "end_energy",          "drift_m",     "finite",
                     "rests",      "holds"};

std::string markdown_line(const Row& row, const std::vector<size_t>& widths, char fill)
{
    std::string line = "|";
    for (size_t i = 0; i < row.size(); ++i)
        line += fill + row[i] + std::string(widths[i] - row[i].size(), fill) + fill + "|";
    return line + "\n";
}

std::string csv_line(const Row& row)
{
    std::string line;
    for (const std::string& cell : row)
        line += (line.empty() ? "" : ",") + cell;
    return line + "\n";
}

} // namespace

std::string markdown_table(const std::vector<Result>& results)
{
    std::vector<Row> rows{kMarkdownHeader};
    for (const Result& result : results)
        rows.push_back(cells_of(result));
    std::vector<size_t> widths(kMarkdownHeader.size());
    for (const Row& row : rows)
        for (size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());

    std::string table = markdown_line(rows[0], widths, ' ');
    table += markdown_line(Row(widths.size()), widths, '-');
    for (size_t i = 1; i < rows.size(); ++i)
        table += markdown_line(rows[i], widths, ' ');
    return table;
}

std::string csv_table(const std::vector<Result>& results)
{
    std::string table = csv_line(kCsvHeader);
    for (const Result& result : results)
        table += csv_line(cells_of(result));
    return table;
}

} // namespace toile::stress
