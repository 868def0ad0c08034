#include "research/benchmarks/contact/table.h"

#include <algorithm>

#include "research/benchmarks/text_table.h"

namespace toile::research::contact_stress {

namespace {

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

std::string whole(double value) { return format("%.0f", value); }

const char* word_of(Series series) { return series == Series::Vertices ? "size" : "layers"; }

/// Times of all parts [ms].
Row cells_of(const PartSeconds& parts)
{
    Row cells;
    for (const double seconds : parts)
        cells.push_back(format("%.3f", 1e3 * seconds));
    return cells;
}

/// Names of all parts; CSV columns need another character in place of spaces.
Row part_names(const char* unit, char space)
{
    Row names;
    for (int part = 0; part < kPartCount; ++part) {
        std::string name = name_of(Part(part));
        std::replace(name.begin(), name.end(), ' ', space);
        names.push_back(name + unit);
    }
    return names;
}

void append(Row& row, const Row& more) { row.insert(row.end(), more.begin(), more.end()); }

Row measured(const StressRun& r)
{
    return {std::to_string(r.vertices),
            std::to_string(r.steps),
            std::to_string(r.crossings),
            whole(r.contacts),
            format("%.1f", r.iterations),
            format("%.2f", r.ms_per_step),
            format("%.3f", r.max_strain),
            format("%.3f", r.energy_ratio),
            format("%.3f", r.end_energy),
            yes_or_no(r.is_finite),
            yes_or_no(r.holds)};
}

std::string markdown_of_stress(const std::vector<StressResult>& results)
{
    std::vector<Row> rows;
    for (const StressResult& result : results) {
        Row row{result.trial.name, std::to_string(result.runs.size())};
        append(row, measured(result.worst));
        row.push_back(result.worst.holds ? "" : "seed " + std::to_string(result.worst.seed));
        rows.push_back(row);
    }
    return markdown({"case", "seeds", "vertices", "steps", "crossings", "contacts", "iterations", "ms/step",
                     "max strain", "peak energy", "end energy", "finite", "holds", "first that fails"},
                    rows);
}

Row scaling_header(const Row& parts)
{
    Row header{"case", "vertices", "layers", "contacts", "iterations", "CG", "ms/step"};
    append(header, parts);
    return header;
}

std::vector<Row> scaling_rows(const std::vector<ScalingResult>& results)
{
    std::vector<Row> rows;
    for (const ScalingResult& r : results) {
        Row row{r.trial.name,
                std::to_string(r.vertices),
                std::to_string(r.trial.layers),
                whole(r.contacts),
                format("%.1f", r.iterations),
                format("%.1f", r.linear_iterations),
                format("%.3f", 1e3 * step_seconds(r.parts))};
        append(row, cells_of(r.parts));
        rows.push_back(row);
    }
    return rows;
}

/// Cells of a fit; empty without one: a single point, or no time at all.
Row cells_of(const PowerFit& fit)
{
    if (fit.points < 2)
        return {"", "", ""};
    return {format("%.2f", fit.exponent), format("%.2f", fit.worst), std::to_string(fit.points)};
}

std::vector<Row> exponent_rows(const std::vector<ScalingResult>& results)
{
    std::vector<Row> rows;
    for (const ScalingFit& of : fit(results)) {
        Row row{word_of(of.series), of.what};
        append(row, cells_of(of.by_vertices));
        append(row, cells_of(of.by_contacts));
        if (of.by_vertices.points >= 2 || of.by_contacts.points >= 2)
            rows.push_back(row);
    }
    return rows;
}

std::string markdown_of_dressed(const std::vector<DressedResult>& results)
{
    std::vector<Row> rows;
    for (const DressedResult& r : results) {
        const double step = step_seconds(r.with);
        rows.push_back({r.name, std::to_string(r.vertices), std::to_string(r.frames), whole(r.contacts),
                        format("%.1f", r.iterations), format("%.1f", r.iterations_without),
                        format("%.2f", 1e3 * step), format("%.2f", 1e3 * step_seconds(r.without)),
                        format("%.2f", r.ratio()), format("%.2f", r.detection_fraction()),
                        format("%.2f", seconds_of(r.with, Part::ClothPairs) / step),
                        format("%.2f", seconds_of(r.with, Part::TrajectoryLimiter) / step),
                        format("%.2f", minimisation_seconds(r.with) / step),
                        r.detects_too_long() ? "OVER HALF" : ""});
    }
    return markdown({"scene", "vertices", "frames", "contacts", "iterations", "without", "ms/step", "without",
                     "ratio", "detection", "of it cloth", "bring back", "minimisation", "detection"},
                    rows);
}

} // namespace

std::string csv_of_stress(const std::vector<StressResult>& results)
{
    std::vector<Row> rows;
    for (const StressResult& result : results)
        for (const StressRun& run : result.runs) {
            Row row{result.trial.name, std::to_string(run.seed)};
            append(row, measured(run));
            row.push_back(std::to_string(run.first_crossing));
            rows.push_back(row);
        }
    return csv({"case", "seed", "vertices", "steps", "crossings", "contacts_per_step", "iterations_per_step",
                "ms_per_step", "max_strain", "energy_ratio", "end_energy", "finite", "holds",
                "first_crossing"},
               rows);
}

std::string csv_of_scaling(const std::vector<ScalingResult>& results)
{
    Row header{"case",
               "vertices",
               "layers",
               "contacts_per_step",
               "iterations_per_step",
               "cg_iterations_per_step",
               "ms_per_step"};
    append(header, part_names("_ms", '_'));
    return csv(header, scaling_rows(results));
}

std::string csv_of_exponents(const std::vector<ScalingResult>& results)
{
    return csv({"series", "what", "exponent_by_vertices", "worst_factor_by_vertices", "points_by_vertices",
                "exponent_by_contacts", "worst_factor_by_contacts", "points_by_contacts"},
               exponent_rows(results));
}

std::string csv_of_dressed(const std::vector<DressedResult>& results)
{
    std::vector<Row> rows;
    for (const DressedResult& r : results) {
        Row row{r.name,
                std::to_string(r.vertices),
                std::to_string(r.frames),
                whole(r.contacts),
                format("%.2f", r.iterations),
                format("%.2f", r.iterations_without),
                format("%.3f", 1e3 * step_seconds(r.with)),
                format("%.3f", 1e3 * step_seconds(r.without)),
                format("%.3f", r.ratio()),
                format("%.3f", r.detection_fraction()),
                r.detects_too_long() ? "yes" : "no"};
        append(row, cells_of(r.with));
        append(row, cells_of(r.without));
        rows.push_back(row);
    }
    Row header{"scene",
               "vertices",
               "frames",
               "contacts",
               "iterations_per_step",
               "iterations_without",
               "ms_per_step",
               "ms_per_step_without",
               "ratio",
               "detection_share",
               "detection_over_half"};
    append(header, part_names("_ms", '_'));
    append(header, part_names("_ms_without", '_'));
    return csv(header, rows);
}

std::string markdown_tables(const Results& results)
{
    std::string text;
    const auto section = [&](const char* title, const std::string& table) {
        text += (text.empty() ? "" : "\n") + std::string("### ") + title + "\n\n" + table;
    };
    if (!results.stress.empty())
        section("Stress: worst over seeds, means of contacts, iterations and times",
                markdown_of_stress(results.stress));
    if (!results.scaling.empty()) {
        section("Scaling: means per step, parts in ms",
                markdown(scaling_header(part_names("", ' ')), scaling_rows(results.scaling)));
        const std::vector<Row> exponents = exponent_rows(results.scaling);
        if (!exponents.empty())
            section("Fitted exponents (worst: largest factor between a point and the fit)",
                    markdown({"series", "what", "by vertices", "worst", "points", "by contacts", "worst",
                              "points"},
                             exponents));
    }
    if (!results.dressed.empty())
        section("Dressed: with contact of cloth with itself and without",
                markdown_of_dressed(results.dressed));
    return text;
}

} // namespace toile::research::contact_stress
