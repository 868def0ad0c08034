#include <iostream>
#include <memory>

#include "apps/toile/command_line.h"
#include "apps/toile/commands.h"
#include "scenes/format/schema.h"

namespace toile {

Command add_schema(CLI::App& program)
{
    Command command;
    command.options = program.add_subcommand("schema", "Print the JSON Schema of scene files");
    auto tables = std::make_shared<bool>(false);
    command.options->add_flag("--tables", *tables, "Print the keys as Markdown tables instead");
    command.run = [tables] {
        std::cout << (*tables ? scene_key_tables() : scene_schema());
        return int(kExitOk);
    };
    return command;
}

} // namespace toile
