#include <algorithm>

#include <CLI/CLI.hpp>

#include "apps/toile/pattern/commands.h"

namespace toile::app {

Command add_pattern(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("pattern", "Look at sewing patterns, and mesh them");
    command.options->require_subcommand(1);
    const std::vector<Command> actions{add_pattern_show(*command.options),
                                       add_pattern_mesh(*command.options)};
    command.run = [actions] {
        return std::find_if(actions.begin(), actions.end(),
                            [](const Command& action) { return action.options->parsed(); })
            ->run();
    };
    return command;
}

} // namespace toile::app
