#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::research {

/// Options of a benchmark; main.cpp lists which benchmark has which.
struct BenchOptions {
    std::filesystem::path output;              ///< folder for tables; empty: only standard output
    std::string only;                          ///< run cases whose name contains this text; empty: all
    std::string mesh;                          ///< "NAME" or "NAME:VERTICES"; empty: all
    std::vector<std::filesystem::path> scenes; ///< empty: the benchmark's own
    std::string solver;                        ///< solver.method; empty: the default
    std::string backend = "cpu";               ///< "cpu" or "cuda"
    std::optional<int> frames;                 ///< of each scene, instead of the scene's number
    int repeats = 3;                           ///< runs of everything that is timed; the minimum counts
    int threads = 0;                           ///< 0: all threads of the machine
    bool times_only = false;                   ///< no references and errors
    bool quick = false;
    bool quiet = false;
};

// One source file each, named after the benchmark. They return an ExitCode and throw InvalidInput for bad
// options.
int bench_accuracy(const BenchOptions& options);
int bench_contact(const BenchOptions& options);
int bench_error_time(const BenchOptions& options);
int bench_figures(const BenchOptions& options);
int bench_gpu(const BenchOptions& options);
int bench_paper(const BenchOptions& options);
int bench_scaling(const BenchOptions& options);
int bench_sheet(const BenchOptions& options);
int bench_solvers(const BenchOptions& options);
int bench_stages(const BenchOptions& options);
int bench_stress(const BenchOptions& options);

} // namespace toile::research
