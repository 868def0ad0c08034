#pragma once

#include <string>
#include <vector>

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

/// Class of garments at rest by their certificate: "draped" if it holds, else "solver", with the condition
/// that failed and the panel where.
DrapeVerdict verdict_of(const Certificate& certificate, const std::vector<scenes::DrapedGarment>& garments);

/// What `toile drape` says about garments.
struct DrapeReport {
    DrapeVerdict verdict;
    scenes::DrapeResult result;
    std::vector<GarmentMeasures> measures; ///< [garments of the result that have a mesh]
};

/// Report as JSON. docs/reference/commands.md explains the keys.
/// @param patterns  of the garments
std::string to_json(const DrapeReport& report, const std::vector<garment::Pattern>& patterns);

/// Report on input that was refused.
std::string to_json(const DrapeVerdict& verdict);

/// The main numbers in a few lines, without an end of line after the last.
std::string summary_of(const DrapeReport& report);

} // namespace toile::app
