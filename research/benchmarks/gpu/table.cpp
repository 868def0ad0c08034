#include "research/benchmarks/gpu/table.h"

#include "research/benchmarks/text_table.h"

namespace toile::research::gpu {

namespace {

std::vector<Row> rows_of(const Report& report)
{
    std::vector<Row> rows;
    for (const Apply& a : report.applies)
        rows.push_back({std::to_string(a.vertices), format("%.0f", a.gathers), format("%.1f", a.table_mb),
                        format("%.1f", a.moments_us), format("%.1f", a.gather_us), format("%.1f", a.solve_us),
                        format("%.0f", 1e3 * a.table_mb / a.gather_us), format("%.0f", a.cpu_us),
                        format("%.1f", a.cpu_us / a.solve_us), format("%.1e", a.difference),
                        format("%.1f", a.build_s)});
    return rows;
}

std::vector<Row> step_rows_of(const Report& report)
{
    std::vector<Row> rows;
    for (const Step& s : report.steps)
        rows.push_back({std::to_string(s.cloths), std::to_string(s.vertices), format("%.0f", s.iterations),
                        format("%.2f", s.device_ms), format("%.1f", 1e3 * s.device_ms / s.iterations),
                        format("%.1f", s.cpu_ms), format("%.1f", s.cpu_ms / s.device_ms),
                        format("%.1e", s.difference), format("%.1e", s.bytes_difference)});
    return rows;
}

} // namespace

std::string markdown_tables(const Report& report)
{
    return report.device.name + ", copies " + format("%.0f", report.copy_gbs) + " GB/s, " +
           format("%.0f", report.small_copy_gbs) + " GB/s inside the L2 cache\n\n" +
           markdown({"vertices", "gathers", "table MB", "moments us", "sums us", "solve us", "sums GB/s",
                     "CPU us", "CPU / GPU", "difference", "tables s"},
                    rows_of(report)) +
           "\nBuilding the tables\n\n" + markdown_of(report.builds) + "\nSteps without contact\n\n" +
           markdown({"cloths", "vertices of each", "iterations", "step ms", "iteration us", "CPU ms",
                     "CPU / GPU", "difference m", "with bytes m"},
                    step_rows_of(report)) +
           "\n" + markdown_of(report.searches) + "\n" + markdown_of(report.colliders) + "\nScenes\n\n" +
           markdown_of(report.scenes) + "\nBaselines\n\n" + solvers::markdown_table(report.baselines) +
           "\nGlobal solvers of baselines\n\n" + markdown_of(report.rules);
}

std::string csv_of_steps(const Report& report)
{
    return csv({"cloths", "vertices", "iterations", "step_ms", "iteration_us", "cpu_ms", "cpu_over_gpu",
                "difference_m", "bytes_difference_m"},
               step_rows_of(report));
}

std::string csv_of_applies(const Report& report)
{
    return csv({"vertices", "gathers", "table_mb", "moments_us", "sums_us", "solve_us", "sums_gbs", "cpu_us",
                "cpu_over_gpu", "difference", "tables_s"},
               rows_of(report));
}

} // namespace toile::research::gpu
