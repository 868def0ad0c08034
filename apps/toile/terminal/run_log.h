#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include "apps/toile/terminal/progress.h"

namespace toile::app {

/// Messages of a run: names of files on stdout, all else on stderr. Each message is written in one piece, so
/// that those of several threads do not mix.
class RunLog {
public:
    /// @param quiet  no progress and no success messages
    /// @param scene  prefix of every message on stderr; empty for a single scene
    explicit RunLog(bool quiet, std::string scene = "", Stderr use = Stderr::Exclusive);

    bool quiet() const { return quiet_; }
    const std::string& scene() const { return scene_; }
    Stderr use() const { return use_; }

    /// Prints the name of a written file.
    void file(const std::filesystem::path& file) const;
    /// Prints the result of a run, unless quiet.
    void result(const std::string& text) const;
    /// Prints "toile: TEXT".
    void note(const std::string& text) const;
    /// Prints "toile: error: TEXT" on one line, line breaks replaced.
    void error(std::string text) const;

    Progress progress(const std::string& what, int total) const;

private:
    bool quiet_;
    std::string scene_, prefix_;
    Stderr use_;
};

/// What an exception means to the user; "out of memory ..." where memory or threads are exhausted.
std::string reason_of(const std::exception& error);

/// Runs work(), which returns an exit code, and reports an exception as one line of error and another code.
int run_and_report(const RunLog& log, const std::function<int()>& work);

} // namespace toile::app
