#pragma once

#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Folds of a garment: those of its panels, and those along its seams.
struct GarmentFolds {
    std::vector<garment::PanelFold> panels;
    std::vector<double> seam_angle_deg; ///< [seams] 0: the seam is flat

    explicit GarmentFolds(const garment::Pattern& pattern);

    /// The folds as lines of a surface. Folds of seams run where both sides are welded; their outside is that
    /// of the seam's side `a`.
    /// @param mesh    of the pattern
    /// @param partly  the mesh with some of its seams welded
    std::vector<scene::Fold> on(const garment::PatternMesh& mesh, const garment::SewnMesh& partly) const;
};

} // namespace toile::scenes
