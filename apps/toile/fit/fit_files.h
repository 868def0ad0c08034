#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/toile/fit/fit_report.h"
#include "apps/toile/terminal/run_log.h"

namespace toile::app {

/// Files of the fit of garments, in the folder of their drape: fit.json, and for each garment NAME_fit.csv
/// with NAME_MAP.obj and NAME_MAP.png for its maps.
class FitFiles {
public:
    /// @param names  of the garments
    FitFiles(std::filesystem::path folder, std::vector<std::string> names);

    std::vector<std::filesystem::path> all() const;

    /// @param body  that the garments fit
    void write(const std::vector<GarmentFit>& fits, const TriangleMesh& body, const RunLog& log) const;

private:
    std::filesystem::path report() const { return folder_ / "fit.json"; }
    std::filesystem::path table(const std::string& name) const { return folder_ / (name + "_fit.csv"); }
    std::filesystem::path map(const std::string& name, const std::string& map, const char* extension) const
    {
        return folder_ / (name + "_" + map + extension);
    }

    std::filesystem::path folder_;
    std::vector<std::string> names_;
};

} // namespace toile::app
