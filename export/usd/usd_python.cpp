#include "export/usd/usd_python.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "export/usd/usd_script.h"

namespace toile::exports {

namespace {

/// Far beyond what a shot takes: a program that hangs ends at last.
constexpr ChildBounds kBounds{std::chrono::hours(12), std::size_t{1} << 38};

/// Exit codes of usd_commands.py, and of a program that can't be started.
enum ExitCode { kDone = 6, kMissingModules = 3, kRefused = 4, kNoProgram = 127 };

std::string python()
{
    const char* chosen = std::getenv("TOILE_PYTHON");
    return chosen && *chosen ? chosen : "python3";
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

} // namespace

ExchangeFolder::ExchangeFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "toile-usd-XXXXXX").string();
    if (!::mkdtemp(name.data()))
        throw DeviceError(name + ": can't be created (" + std::strerror(errno) +
                          "); set TMPDIR to a writable folder");
    path_ = name;
}

ExchangeFolder::~ExchangeFolder()
{
    std::error_code missing;
    std::filesystem::remove_all(path_, missing);
}

std::string run_usd_command(const std::filesystem::path& file, const std::vector<std::string>& arguments,
                            const ExchangeFolder& folder)
{
    // As a file, so that Python looks for modules beside it, not in the current folder.
    const std::filesystem::path script = folder.path() / "usd_commands.py";
    write_atomically(script, usd_script());
    std::vector<std::string> command{python(), "-B", script.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ProgramEnd end;
    try {
        end = run_program(command, kBounds);
    } catch (const ChildStopped& stopped) {
        throw DeviceError(file.string() + ": Python with USD " + stopped.what());
    }
    if (end.exit_code == kMissingModules || end.exit_code == kNoProgram)
        throw InvalidInput(file.string() + ": needs Python with USD, and " + python() +
                           (end.exit_code == kNoProgram ? " can't be started" : " has none") +
                           "; pip install usd-core, or name another interpreter in TOILE_PYTHON");
    if (end.exit_code == 0)
        throw InvalidInput(file.string() + ": needs Python with USD, and " + python() +
                           " is no Python; name another interpreter in TOILE_PYTHON");
    if (end.exit_code == kRefused)
        throw InvalidInput(file.string() + ": " + end.output);
    if (end.exit_code != kDone)
        throw DeviceError(file.string() + ": Python with USD ended with exit code " +
                          std::to_string(end.exit_code) +
                          (end.output.empty() ? "" : ": " + first_line(end.output)));
    return end.output;
}

void require_usd_python(const std::filesystem::path& file)
{
    run_usd_command(file, {"version"}, ExchangeFolder());
}

} // namespace toile::exports
