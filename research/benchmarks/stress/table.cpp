#include "research/benchmarks/stress/table.h"

#include "research/benchmarks/text_table.h"

namespace toile::research::stress {

namespace {

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
            yes_or_no(r.is_at_rest),
            yes_or_no(r.holds)};
}

const Row kMarkdownHeader{"case",        "steps",      "iterations", "ms/step", "end speed m/s", "max strain",
                          "peak energy", "end energy", "drift m",    "finite",  "rests",         "holds"};
const Row kCsvHeader{"case",       "steps",        "iterations_per_step", "ms_per_step", "end_speed_m_per_s",
                     "max_strain", "energy_ratio", "end_energy",          "drift_m",     "finite",
                     "rests",      "holds"};

Row cells_of_solid(const SolidResult& r)
{
    return {r.name,
            std::to_string(r.steps),
            format("%.1f", r.iterations_per_step),
            format("%.2f", r.ms_per_step),
            std::to_string(r.unfinished),
            std::to_string(r.wrong),
            format("%.1e", r.newton),
            format("%.1e", r.distance),
            format("%.3f", r.energy_gain),
            std::to_string(r.inverted),
            yes_or_no(r.is_finite),
            yes_or_no(r.holds)};
}

const Row kSolidMarkdownHeader{"case",        "steps",        "iterations",  "ms/step",
                               "unfinished",  "wrong claims", "Newton step", "distance",
                               "energy gain", "inverted",     "finite",      "holds"};
const Row kSolidCsvHeader{
    "case",        "steps",    "iterations_per_step", "ms_per_step", "unfinished", "wrong_claims",
    "newton_step", "distance", "energy_gain",         "inverted",    "finite",     "holds"};

} // namespace

std::string markdown_table(const std::vector<Result>& results)
{
    return markdown(kMarkdownHeader, rows_of(results, cells_of));
}

std::string csv_table(const std::vector<Result>& results)
{
    return csv(kCsvHeader, rows_of(results, cells_of));
}

std::string markdown_table(const std::vector<SolidResult>& results)
{
    return markdown(kSolidMarkdownHeader, rows_of(results, cells_of_solid));
}

std::string csv_table(const std::vector<SolidResult>& results)
{
    return csv(kSolidCsvHeader, rows_of(results, cells_of_solid));
}

} // namespace toile::research::stress
