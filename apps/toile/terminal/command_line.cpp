#include "apps/toile/terminal/command_line.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/run_log.h"
#include "apps/toile/terminal/standard_streams.h"
#include "apps/toile/terminal/version.h"
#include "core/base/error.h"

namespace toile::app {

namespace {

/// Rejects unknown options from the `first` word on. CLI11 would report a misspelt one together with its
/// value and without a remedy.
/// @param words  that call the command: toile pattern show
void require_known_options(int argc, char** argv, int first, const CLI::App& command,
                           const std::string& words)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    for (int i = first; i < argc; ++i) {
        const std::string word(argv[i]);
        const std::string name = word.substr(0, word.find('='));
        if (name.rfind("--", 0) != 0 || name == "--" ||
            std::find(names.begin(), names.end(), name) != names.end())
            continue;
        const std::string near = nearest_word(name, names);
        throw InvalidInput("unknown option " + name + "; " +
                           (near.empty() ? "run " + words + " --help" : "did you mean " + near + "?"));
    }
}

/// Rejects unknown subcommands of `parser` in word `at`, which CLI11 would report as an "unexpected
/// argument", and what does not belong to known ones.
void require_known_words(int argc, char** argv, int at, const CLI::App& parser, const std::string& words)
{
    const std::vector<const CLI::App*> commands =
        parser.get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty()) {
        require_known_options(argc, argv, at, parser, words);
        return;
    }
    if (argc <= at || argv[at][0] == '-')
        return;
    std::vector<std::string> names;
    std::string list;
    for (const CLI::App* command : commands) {
        if (command->get_name() == argv[at]) {
            require_known_words(argc, argv, at + 1, *command, words + " " + command->get_name());
            return;
        }
        names.push_back(command->get_name());
        list += (list.empty() ? "" : ", ") + names.back();
    }
    const std::string near = nearest_word(argv[at], names);
    throw InvalidInput(std::string("unknown command \"") + argv[at] + "\"; " +
                       (near.empty() ? "known are " + list : "did you mean \"" + near + "\"?"));
}

int parse_and_run(int argc, char** argv, const Program& program)
{
    CLI::App parser(program.summary, program.name);
    parser.set_version_flag("--version", version_text(program.name));
    parser.require_subcommand(1);
    const std::vector<Command> commands = program.add_commands(parser);
    require_known_words(argc, argv, 1, parser, program.name);
    try {
        parser.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) // --help, --version
            return parser.exit(error);
        const std::string command = argc > 1 && argv[1][0] != '-' ? std::string(argv[1]) + " " : "";
        const bool is_word = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
        throw InvalidInput(std::string(error.what()) + (is_word ? ", which takes a number" : "") + "; run " +
                           program.name + " " + command + "--help");
    }
    const auto chosen = std::find_if(commands.begin(), commands.end(),
                                     [](const Command& command) { return command.options->parsed(); });
    return chosen->run();
}

} // namespace

int run_command_line(int argc, char** argv, const Program& program)
{
    secure_standard_streams();
    const RunLog log(false);
    const int code = run_and_report(log, [&] { return parse_and_run(argc, argv, program); });
    if (flush_standard_output())
        return code;
    log.error("standard output can't be written: its disk is full or its reader has ended");
    return code == kExitOk ? int(kExitFailure) : code;
}

} // namespace toile::app
