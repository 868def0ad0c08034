#pragma once

#include <functional>

// NOLINTNEXTLINE(readability-identifier-naming): the library's
namespace CLI {
class App;
} // namespace CLI

namespace toile::scenes {
class BaselineMethods;
} // namespace toile::scenes

namespace toile::app {

/// A subcommand: its options, added to the parser, and the function to run after parsing.
struct Command {
    CLI::App* options = nullptr;
    std::function<int()> run; ///< returns an ExitCode; throws InvalidInput for bad input
};

// One source file each, named after the subcommand.

/// @param baselines  methods that scenes may select, borrowed; null: none
Command add_simulate(CLI::App& parser, const scenes::BaselineMethods* baselines);
Command add_render(CLI::App& parser);
Command add_convert(CLI::App& parser);
Command add_check(CLI::App& parser);
Command add_drape(CLI::App& parser);
Command add_fit(CLI::App& parser);
Command add_info(CLI::App& parser);
Command add_measure(CLI::App& parser);
Command add_mesh(CLI::App& parser);
Command add_pattern(CLI::App& parser);
Command add_schema(CLI::App& parser);

} // namespace toile::app
