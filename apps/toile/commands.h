#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace toile {

/// A subcommand: its options, added to the parser, and what runs once they are parsed.
struct Command {
    CLI::App* options = nullptr;
    std::function<int()> run; ///< returns an ExitCode; throws InvalidInput for bad input
};

// One file each, named after the subcommand.
Command add_simulate(CLI::App& program);
Command add_render(CLI::App& program);
Command add_check(CLI::App& program);
Command add_info(CLI::App& program);
Command add_schema(CLI::App& program);
Command add_bench(CLI::App& program);

} // namespace toile
