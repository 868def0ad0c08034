#pragma once

#include "quadrature2d/paper/uv_surface.h"

namespace toile {

/// The nested domains of one vertex; the far field is the rest of the surface.
struct FieldDomains {
    PixelBox near, middle; ///< near lies in middle, the vertex lies in near
};

/// How field_domains() grows its boxes.
struct DomainSettings {
    double near_influence = 0.7;   ///< [-] of the total influence that the near box holds
    double middle_influence = 0.9; ///< [-] the same for the middle box

    /// Alg. 1, line 13 leaves the loop over + and - after the first side that could grow: a box then grows to
    /// + until it is blocked, and its vertex ends up at one side of it. We take the `foreach` at its word and
    /// try both sides; true is the algorithm as printed. Neither contracts.
    bool only_first_side = false;
};

/// Near and middle field of `vertex`: the pixel of the vertex grows, always along the axis with the wider
/// cross-section, by slices that the surface covers everywhere, until it holds the wanted share of
/// I = integral of |u|, interpolated linearly on the triangles.   [multilevel quadrature for PD, Alg. 1,
/// sec. 5.4]
///
/// The boxes hold at least their share (by less than one slice more), or, where the border of the surface
/// stops them, as much as they can. Near is a stage of the growth of middle, so that the two are nested; the
/// paper does not say how it finds its near box.
/// @param u  [vertices] the kernel row u(i) [-]
FieldDomains field_domains(const UvSurface& surface, int vertex, View<const double> u,
                           const DomainSettings& settings);

} // namespace toile
