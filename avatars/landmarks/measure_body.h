#pragma once

#include <string>
#include <vector>

#include "avatars/landmarks/upright_body.h"

namespace toile::avatars {

/// One measurement of a body, by the key that GarmentCode gives it.
struct Measurement {
    std::string key;
    double value = 0.0; ///< [m], or degrees for angles
    bool is_angle = false;
    std::string meaning; ///< how it was taken, in one line
};

/// Keys of GarmentCode that measure_body() leaves out: their points are marked by hand.
std::vector<std::string> unmeasured_keys();

/// Takes the measurements of GarmentCode's body files from slices. Girths are as a tape has them, the length
/// of the convex hull of a slice; lengths over the body are those of hulls of upright slices.
///
/// The bust is at its foremost points, the underbust where the trunk widens to it, the waist at the smallest
/// girth, the hips at the largest near the hindmost point of the seat.
std::vector<Measurement> measure_body(const UprightBody& body);

/// A girth of a body, and where its tape lies.
struct Girth {
    std::string key;     ///< of the measurement
    std::string side;    ///< "left", "right"; empty: around the trunk
    double length = 0.0; ///< [m] of the tape
    SectionPlane plane;  ///< of the slice, in the frame of the mesh that find_upright_body() was given
    SectionLoop skin;    ///< in that plane, around the part that is measured
};

/// Girths among the measurements: bust, underbust, waist, hips, and those of both thighs and wrists, if they
/// were found.
std::vector<Girth> measure_girths(const UprightBody& body);

} // namespace toile::avatars
