#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "apps/toile/progress.h"

namespace toile {

/// What a run says: names of files on stdout, all else on stderr, each message in one piece, so that those of
/// several threads are not torn.
class RunLog {
public:
    /// @param quiet  no progress, and no word of what went well
    /// @param scene  begins every message on stderr; empty where a single scene runs
    explicit RunLog(bool quiet, std::string scene = "", Stderr use = Stderr::Own);

    bool quiet() const { return quiet_; }
    const std::string& scene() const { return scene_; }
    Stderr use() const { return use_; }

    /// A file that was written.
    void file(const std::filesystem::path& file) const;
    /// What a run came to, unless quiet.
    void result(const std::string& text) const;
    /// "toile: TEXT"
    void note(const std::string& text) const;
    /// "toile: error: TEXT", on one line whatever the text holds.
    void error(std::string text) const;

    Progress progress(const std::string& what, int total) const;

private:
    bool quiet_;
    std::string scene_, prefix_;
    Stderr use_;
};

/// Runs work(), which returns an exit code, and turns what it throws into one line of error and another.
int run_and_report(const RunLog& log, const std::function<int()>& work);

} // namespace toile
