#pragma once

#include <string>
#include <vector>

#include "garment/pattern/pattern.h"
#include "garment/pattern/seam_measure.h"

namespace toile::app {

/// What `toile pattern show` says about an edge.
struct EdgeFacts {
    double length = 0.0; ///< [m]
    const char* curve = "straight";
    std::string label;
    std::vector<int> seams; ///< that sew it or parts of it
};

struct PanelFacts {
    double area = 0.0;       ///< [m^2]
    Eigen::AlignedBox2d box; ///< about it, in its plane [m]
    std::vector<EdgeFacts> edges;
};

struct SeamFacts {
    garment::SeamMeasure measure;
    bool one_sided = false; ///< makes the sewn surface one-sided
    std::string mend;       ///< change of the file that joins its other ends; empty: none needed

    bool twisted() const { return !mend.empty(); }
};

/// A pattern and its measures, in the order of its panels, edges and seams.
struct PatternReport {
    garment::Pattern pattern;
    std::vector<PanelFacts> panels;
    std::vector<SeamFacts> seams;

    double area() const; ///< [m^2] of all panels
};

PatternReport report_on(garment::Pattern pattern);

/// Refuses an output that would replace a file of the pattern, or could not be written.
/// @param role  named in errors: "the drawing"
void require_safe_output(const std::filesystem::path& file, const std::string& role,
                         const garment::Pattern& pattern);

/// A line per panel, edge and seam.
std::string to_text(const PatternReport& report);

/// The same as JSON.
std::string to_json(const PatternReport& report);

/// Why a seam is twisted and what mends it, in one line: seam 3: ...
std::string twist_text(const PatternReport& report, int seam);

/// Sides of a seam in the words of a garment file: band.0 to front.2 + back.2.
std::string sides_text(const garment::Pattern& pattern, const garment::Seam& seam);

/// Panel and edge as garment files name them: front.3[0.2:0.6].
std::string name_in_garment_file(const garment::Pattern& pattern, const garment::EdgePart& part);

} // namespace toile::app
