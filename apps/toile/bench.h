#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile {

/// What the command line says about a benchmark.
struct BenchOptions {
    std::string name;
    std::filesystem::path output;              ///< folder for tables; empty: only standard output
    std::string only;                          ///< run cases whose name contains this; empty: all
    std::string mesh;                          ///< of solvers: "NAME" or "NAME:VERTICES"; empty: all
    std::vector<std::filesystem::path> scenes; ///< for stages; empty: its own
    std::string solver;                        ///< for stress: solver.method; empty: the default
    std::optional<int> frames;                 ///< of each scene, instead of its own
    int repeats = 3;                           ///< runs of everything that is timed; the fastest counts
    int threads = 0;                           ///< for contact; 0: all of the machine's
    bool times_only = false;                   ///< sheet without its references and errors
    bool quick = false;
    bool quiet = false;
};

// One file each, named bench_NAME.cpp. They return an ExitCode and throw InvalidInput for bad options.
int bench_contact(const BenchOptions& options);
int bench_gpu(const BenchOptions& options);
int bench_sheet(const BenchOptions& options);
int bench_solvers(const BenchOptions& options);
int bench_stages(const BenchOptions& options);
int bench_stress(const BenchOptions& options);

} // namespace toile
