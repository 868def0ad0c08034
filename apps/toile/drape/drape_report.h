#pragma once

#include <optional>
#include <string>

#include "apps/toile/check/certificate.h"
#include "apps/toile/drape/garment_measures.h"
#include "garment/pattern/pattern.h"
#include "scenes/drape/drape.h"

namespace toile::app {

/// How a drape ended, in the words of drape.json.
struct DrapeVerdict {
    std::string word;    ///< class
    std::string message; ///< one line; empty if draped

    bool is_draped() const { return word == "draped"; }
};

/// Class of a result that has no certificate.
DrapeVerdict verdict_of(const scenes::DrapeResult& result);

/// Class of a garment at rest by its certificate: "draped" if it holds, else "solver", with the condition
/// that failed and the panel where.
DrapeVerdict verdict_of(const Certificate& certificate, const ObjMesh& garment);

/// What `toile drape` says about a garment.
struct DrapeReport {
    DrapeVerdict verdict;
    scenes::DrapeResult result;
    std::optional<GarmentMeasures> measures; ///< none without a mesh
};

/// Report as JSON. docs/reference/commands.md explains the keys.
/// @param pattern  that was draped
std::string to_json(const DrapeReport& report, const garment::Pattern& pattern);

/// Report on input that was refused.
std::string to_json(const DrapeVerdict& verdict);

/// The main numbers in a few lines, without an end of line after the last.
std::string summary_of(const DrapeReport& report);

} // namespace toile::app
