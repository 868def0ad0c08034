#include "research/benchmarks/stages/table.h"

#include "research/benchmarks/text_table.h"

namespace toile::research::stages {

namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

std::vector<Row> scene_rows(const std::vector<Result>& results)
{
    std::vector<Row> rows;
    rows.reserve(results.size());
    for (const Result& r : results)
        rows.push_back({r.name, std::to_string(r.vertices), std::to_string(r.frames),
                        format("%.1f", r.ms_per_frame), format("%.1f", r.median_ms),
                        format("%.1f", r.slowest_ms), format("%.1f", r.user_ms), format("%.1f", r.iterations),
                        format("%.0f", r.contacts), format("%.2f", r.load_s),
                        format("%.0f", double(r.peak_memory) / kMebibyte)});
    return rows;
}

std::vector<Row> stage_rows(const std::vector<Result>& results)
{
    std::vector<Row> rows;
    for (const Result& r : results)
        for (const Stage& stage : r.stages)
            rows.push_back({r.name, stage.name, format("%.1f", stage.calls), format("%.2f", stage.ms),
                            format("%.3f", stage.fraction)});
    return rows;
}

} // namespace

std::string markdown_tables(const std::vector<Result>& results)
{
    return markdown({"scene", "vertices", "frames", "ms/frame", "median", "slowest", "user ms", "iterations",
                     "contacts", "load s", "peak MiB"},
                    scene_rows(results)) +
           "\n" + markdown({"scene", "stage", "calls/frame", "ms/frame", "share"}, stage_rows(results));
}

std::string csv_of_scenes(const std::vector<Result>& results)
{
    return csv({"scene", "vertices", "frames", "ms_per_frame", "median_ms", "slowest_ms", "user_ms_per_frame",
                "iterations_per_frame", "contacts_per_frame", "load_s", "peak_memory_mib"},
               scene_rows(results));
}

std::string csv_of_stages(const std::vector<Result>& results)
{
    return csv({"scene", "stage", "calls_per_frame", "ms_per_frame", "share"}, stage_rows(results));
}

} // namespace toile::research::stages
