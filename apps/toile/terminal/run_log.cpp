#include "apps/toile/terminal/run_log.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <new>
#include <utility>

#include "apps/toile/terminal/command_line.h"
#include "core/base/error.h"

namespace toile::app {

namespace {

/// Writes a line by one locked call, so that lines of several threads do not mix.
void write_line(std::ostream& stream, const std::string& text) { stream << text + "\n" << std::flush; }

} // namespace

RunLog::RunLog(bool quiet, std::string scene, Stderr use)
    : quiet_(quiet), scene_(std::move(scene)), prefix_(scene_.empty() ? "" : scene_ + ": "), use_(use)
{
}

void RunLog::file(const std::filesystem::path& file) const { write_line(std::cout, file.string()); }

void RunLog::result(const std::string& text) const
{
    if (!quiet_)
        write_line(std::cerr, prefix_ + text);
}

void RunLog::note(const std::string& text) const { write_line(std::cerr, "toile: " + prefix_ + text); }

void RunLog::error(std::string text) const
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    write_line(std::cerr, "toile: error: " + prefix_ + text);
}

Progress RunLog::progress(const std::string& what, int total) const
{
    return {prefix_ + what, total, quiet_, use_};
}

std::string reason_of(const std::exception& error)
{
    std::string what = error.what();
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
        return "out of memory; use a coarser resolution or fewer cloths";
    if (what.ends_with(std::strerror(EAGAIN))) // from threads of the standard library and of TBB
        return "out of memory or threads (" + what + "); raise ulimit -v or -u, or use fewer --threads";
    return what;
}

int run_and_report(const RunLog& log, const std::function<int()>& work)
{
    try {
        return work();
    } catch (const Cancelled&) {
        log.error("interrupted; nothing was written");
    } catch (const InvalidInput& error) {
        log.error(error.what());
        return kExitBadInput;
    } catch (const std::filesystem::filesystem_error& error) {
        log.error(error.path1().string() + ": " + error.code().message() + "; check the path");
        return kExitBadInput;
    } catch (const std::exception& error) {
        log.error(reason_of(error));
    }
    return kExitFailure;
}

} // namespace toile::app
