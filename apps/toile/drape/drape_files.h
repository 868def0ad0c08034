#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/toile/check/certificate.h"
#include "apps/toile/drape/continuation.h"
#include "apps/toile/drape/drape_report.h"
#include "apps/toile/fit/fit_files.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/run_log.h"
#include "export/folder_lock.h"
#include "garment/pattern/pattern.h"
#include "scenes/drape/drape.h"

namespace toile::app {

/// Files of one drape.
class DrapeFiles {
public:
    /// @param garments  one or more
    /// @param folder    of the results; empty: out/NAME
    DrapeFiles(const std::vector<std::filesystem::path>& garments, std::filesystem::path folder);

    /// [garments] letters, digits, _ and -; no two are equal
    const std::vector<std::string>& names() const { return names_; }
    std::string name() const; ///< of all
    std::filesystem::path stages() const { return folder_ / "stages"; }

    std::filesystem::path scene() const { return folder_ / "scene.json"; }
    std::filesystem::path simulated() const { return folder_ / "simulated"; } ///< not written by a drape

    /// Refuses results that would replace what is read, or could not be written.
    /// @param avatar  file of the body; empty: the mannequin
    /// @throws InvalidInput naming both files
    void require_safe(const std::vector<garment::Pattern>& patterns, const std::filesystem::path& avatar,
                      const ClipOptions& clip) const;

    /// Keeps other runs out of the folder while it lives. @throws as FolderLock
    exports::FolderLock lock(const RunLog& log) const;

    /// Writes a report on refused input if the folder can be written to, unless that would replace another
    /// file than such a report. Other results stay as they are.
    void write_refusal(const DrapeVerdict& verdict) const;

    /// Writes the meshes, and, for garments at rest, the scene that simulates them on. Removes all other
    /// results of an earlier drape.
    void write_garment(const Continuation& continuation, const scenes::DrapeResult& result,
                       const RunLog& log) const;

    /// Certifies and writes what write_garment() has written, at rest in the first pose of the body, as
    /// `toile check` does.
    /// @return none if interrupted; nothing was written then
    std::optional<Certificate> write_certificate(const RunLog& log, const InterruptGuard& interrupt) const;

    void write_report(const DrapeReport& report, const std::vector<garment::Pattern>& patterns,
                      const RunLog& log) const;

    /// Measures how the garments at rest fit the body, and writes it (FitFiles).
    void write_fit(const scenes::DrapeResult& result, const std::vector<garment::Pattern>& patterns,
                   const scenes::DrapeSettings& settings, const RunLog& log) const;

    /// Writes a picture of the meshes on the body, from the front at an angle of 30 degrees.
    void write_picture(const scenes::DrapeSettings& settings, const RunLog& log) const;

private:
    std::filesystem::path mesh(const std::string& garment) const { return folder_ / (garment + ".obj"); }
    std::filesystem::path rest_mesh(const std::string& garment) const
    {
        return folder_ / (garment + "_rest.obj");
    }
    std::filesystem::path report() const { return folder_ / "drape.json"; }
    std::filesystem::path certificate() const { return folder_ / "certificate.json"; }
    std::filesystem::path picture() const { return folder_ / (name() + ".png"); }
    std::vector<std::filesystem::path> results() const;
    FitFiles fit() const { return {folder_, names_}; }
    std::string scene_text(const Continuation& continuation, const scenes::DrapeResult& result) const;

    std::vector<std::string> names_;
    std::filesystem::path folder_;
};

} // namespace toile::app
