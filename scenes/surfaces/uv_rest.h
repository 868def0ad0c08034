#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Rest shape of a cloth from its texture coordinates.
struct UvRest {
    std::vector<FlatTriangle> triangles; ///< [triangles] corners in their panels, u right and v up [m]
    double uv_scale = 0.0;               ///< [m] per texture unit, before the cloth's scale
    double fitting_scale = 0.0;          ///< likewise, that makes areas at rest and of the mesh equal
    /// Length in the mesh over that at rest [-]: the smaller principal stretch that 5 % of the triangles do
    /// not exceed, and the larger one that 95 % do not.
    double stretch_p5 = 1.0, stretch_p95 = 1.0;
};

/// @param mesh  the cloth with its unit and scale applied, and a texture that require_flat_texture() accepts
/// @throws InvalidInput for a scale that makes coordinates out of range
UvRest uv_rest(const scene::Cloth& settings, const ObjMesh& mesh);

/// Sentence that tells the factor: "uv_scale": 0.0123 makes the areas at rest and of the mesh equal.
std::string scale_note(const UvRest& rest);

/// Sentence about triangles whose lengths at rest and in the mesh differ by more than a garment stretches;
/// empty if there are few.
std::string mismatch_warning(const UvRest& rest);

} // namespace toile::scenes
