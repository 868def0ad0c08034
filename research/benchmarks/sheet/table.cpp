#include "research/benchmarks/sheet/table.h"

#include "research/benchmarks/text_table.h"

namespace toile::research::sheet {

namespace {

/// Adds the names of the error columns: one per time of comparison.
void add_error_columns(Row& header, const Sheet& sheet, const char* form)
{
    for (const int step : sheet.compared)
        header.push_back(format(form, step * kStep));
}

std::vector<Row> rows_of(const Sheet& sheet, const std::vector<Result>& results)
{
    std::vector<Row> rows;
    for (const Result& r : results) {
        Row row{r.setting.name,
                format("%.1f", r.iterations_per_step),
                format("%.2f", r.mean_ms),
                format("%.2f", r.median_ms),
                format("%.2f", r.user_ms),
                format("%.0f", r.first_ms),
                format("%.3f", r.max_strain)};
        for (size_t k = 0; k < sheet.compared.size(); ++k)
            row.push_back(k < r.errors.size() ? format("%.2g", r.errors[k]) : "");
        rows.push_back(row);
    }
    return rows;
}

} // namespace

std::string markdown_table(const Sheet& sheet, const std::vector<Result>& results)
{
    Row header{"setting", "iterations", "ms/step", "median", "user ms", "first step ms", "max strain"};
    add_error_columns(header, sheet, "error %.2g s");
    return markdown(header, rows_of(sheet, results));
}

std::string csv_table(const Sheet& sheet, const std::vector<Result>& results)
{
    Row header{"setting",          "iterations_per_step", "ms_per_step", "median_ms_per_step",
               "user_ms_per_step", "first_step_ms",       "max_strain"};
    add_error_columns(header, sheet, "error_at_%.2g_s_in_edges");
    return csv(header, rows_of(sheet, results));
}

} // namespace toile::research::sheet
