#pragma once

#include <string>
#include <vector>

#include "apps/toile/terminal/commands.h"

namespace toile::app {

/// Exit codes of the programs.
enum ExitCode {
    kExitOk = 0,
    kExitFailure = 1,  ///< the run failed, or a check found something
    kExitBadInput = 2, ///< nothing was run; one line "toile: error: ..." gives the reason
};

/// Name, help and subcommands of a program.
struct Program {
    std::string name;
    std::string summary; ///< first line of its help
    std::vector<Command> (*add_commands)(CLI::App& parser) = nullptr;
};

/// Parses the arguments, runs the subcommand and turns exceptions, and results that standard output did not
/// take, into an exit code and one line on stderr.
int run_command_line(int argc, char** argv, const Program& program);

} // namespace toile::app
