#pragma once

#include <filesystem>
#include <string>

namespace toile {

/// What the command line says about a benchmark.
struct BenchOptions {
    std::string name;
    std::filesystem::path output; ///< folder for tables; empty: only standard output
    std::string only;             ///< run cases whose name contains this; empty: all
    bool quick = false;
    bool quiet = false;
};

// One file each, named bench_NAME.cpp. They return an ExitCode and throw InvalidInput for bad options.
int bench_stress(const BenchOptions& options);

} // namespace toile
