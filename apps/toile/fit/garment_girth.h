#pragma once

#include <optional>
#include <string>
#include <vector>

#include "avatars/landmarks/measure_body.h"
#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::app {

/// Length of a garment around a part of a body, along the line in which the plane of the tape cuts it.
struct GarmentGirth {
    double draped = 0.0; ///< [m] of the line as it lies, with its folds
    double rest = 0.0;   ///< [m] of the same line in the flat panels
};

/// A girth of a body and the garment there.
struct GirthFit {
    avatars::Girth body;                 ///< where it is compared
    double lowered = 0.0;                ///< [m] from where the measurement is taken
    std::optional<GarmentGirth> garment; ///< none: it does not go around that part alone
    std::string not_covered;             ///< why; empty if there is a garment

    /// By which the garment at rest is larger than the body [m]; negative: it has to stretch.
    double ease() const { return garment->rest - body.length; }
};

/// Distance by which the tape of a thigh may be lowered [m].
inline constexpr double kMaxLowered = 0.1;

/// Girths of a garment where a tape measures the body. A garment covers a girth if it surrounds that part of
/// the body without a gap, and no other part; of several layers the one that is shortest at rest counts.
/// Trousers fork below the body: the tapes of thighs are lowered, up to kMaxLowered, to where they have.
/// @param rest    [triangles] corners in the flat panels [m]
/// @param body    with which the garment shares its frame
/// @param girths  of that body
std::vector<GirthFit> fit_girths(const TriangleMesh& garment, const std::vector<FlatTriangle>& rest,
                                 const TriangleMesh& body, const std::vector<avatars::Girth>& girths);

} // namespace toile::app
