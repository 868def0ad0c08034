#pragma once

#include "apps/toile/terminal/commands.h"

namespace toile::app {

// Subcommands of `toile pattern`, one source file each.
Command add_pattern_show(CLI::App& parser);
Command add_pattern_mesh(CLI::App& parser);

} // namespace toile::app
