#include "apps/toile/command_line.h"

#include <algorithm>

#include "apps/toile/commands.h"
#include "apps/toile/run_log.h"
#include "core/backend/error.h"

namespace toile {

namespace {

/// A misspelt option would otherwise be reported together with its value and without a remedy.
void require_known_options(int argc, char** argv, const CLI::App& command)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    for (int i = 2; i < argc; ++i) {
        const std::string word(argv[i]);
        const std::string name = word.substr(0, word.find('='));
        if (name.rfind("--", 0) != 0 || name == "--" ||
            std::find(names.begin(), names.end(), name) != names.end())
            continue;
        const std::string near = nearest_word(name, names);
        throw InvalidInput(
            "unknown option " + name + "; " +
            (near.empty() ? "run toile " + command.get_name() + " --help" : "did you mean " + near + "?"));
    }
}

/// A misspelt subcommand would otherwise be an "unexpected argument".
void require_known_words(int argc, char** argv, const std::vector<Command>& commands)
{
    if (argc < 2 || argv[1][0] == '-')
        return;
    std::vector<std::string> names;
    std::string list;
    for (const Command& command : commands) {
        names.push_back(command.options->get_name());
        list += (list.empty() ? "" : ", ") + names.back();
    }
    if (const auto at = std::find(names.begin(), names.end(), argv[1]); at != names.end()) {
        require_known_options(argc, argv, *commands[size_t(at - names.begin())].options);
        return;
    }
    const std::string near = nearest_word(argv[1], names);
    throw InvalidInput(std::string("unknown command \"") + argv[1] + "\"; " +
                       (near.empty() ? "known are " + list : "did you mean \"" + near + "\"?"));
}

int parse_and_run(int argc, char** argv)
{
    CLI::App program("Simulates cloth and garments on animated bodies.", "toile");
    program.set_version_flag("--version", "toile " TOILE_VERSION);
    program.require_subcommand(1);
    const std::vector<Command> commands{add_simulate(program), add_render(program), add_check(program),
                                        add_info(program),     add_schema(program), add_bench(program)};
    require_known_words(argc, argv, commands);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) // --help, --version
            return program.exit(error);
        const std::string command = argc > 1 && argv[1][0] != '-' ? std::string(argv[1]) + " " : "";
        throw InvalidInput(std::string(error.what()) + "; run toile " + command + "--help");
    }
    const auto chosen = std::find_if(commands.begin(), commands.end(),
                                     [](const Command& command) { return command.options->parsed(); });
    return chosen->run();
}

} // namespace

int run_command_line(int argc, char** argv)
{
    return run_and_report(RunLog(false), [&] { return parse_and_run(argc, argv); });
}

} // namespace toile
