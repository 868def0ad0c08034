#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "scenes/format/schema/schema.h"
#include "scenes/garment_format/garment_schema.h"

namespace toile::app {

Command add_schema(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("schema", "Print the JSON Schema of scene or garment files");
    auto tables = std::make_shared<bool>(false);
    auto garment = std::make_shared<bool>(false);
    command.options->add_flag("--tables", *tables, "Print the keys as Markdown tables instead");
    command.options->add_flag("--garment", *garment, "Of garment files; otherwise of scene files");
    command.run = [tables, garment] {
        if (*garment)
            std::cout << (*tables ? garment_format::garment_key_tables() : garment_format::garment_schema());
        else
            std::cout << (*tables ? scenes::scene_key_tables() : scenes::scene_schema());
        return int(kExitOk);
    };
    return command;
}

} // namespace toile::app
