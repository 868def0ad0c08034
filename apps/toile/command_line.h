#pragma once

namespace toile {

/// Exit codes of the program.
enum ExitCode {
    kExitOk = 0,
    kExitFailure = 1,  ///< the run went wrong, or a check found something
    kExitBadInput = 2, ///< nothing was run; one line "toile: error: ..." says why
};

/// Parses the arguments, runs the subcommand and turns exceptions into an exit code and one line on stderr.
int run_command_line(int argc, char** argv);

} // namespace toile
