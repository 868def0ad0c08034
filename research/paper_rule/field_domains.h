#pragma once

#include "research/paper_rule/voxelised_mesh.h"

namespace toile::research {

/// Nested domains of one vertex; the far field is the rest of the mesh.
template <int Dim>
struct FieldDomains {
    VoxelBox<Dim> near, middle; ///< near lies in middle, the vertex lies in near
};

/// Settings of the growth of boxes in field_domains().
struct DomainSettings {
    double near_influence = 0.7;   ///< [-] fraction of the total influence in the near box
    double middle_influence = 0.9; ///< [-] fraction in the middle box

    /// True follows Alg. 1 as printed: line 13 leaves the loop over + and - after the first side that could
    /// grow. A box then grows to + until it is blocked, and its vertex ends up at one side of it. False takes
    /// the `foreach` at its word and tries both sides. Neither contracts.
    bool only_first_side = false;
};

/// Near and middle field of `vertex` [multilevel quadrature for PD, Alg. 1, sec. 5.4]. The voxel of the
/// vertex grows by slices that the mesh covers everywhere, along the axis with the widest cross-section that
/// is not blocked. It ends when the box holds the wanted fraction of I = integral of |u|, interpolated
/// linearly on the simplices.
///
/// The boxes hold at least their fraction (by less than one slice more), or, if the border of the mesh stops
/// them, as much as they can. Near is a stage of the growth of middle, so that the two are nested; the paper
/// does not say how it finds its near box.
/// @param u  [vertices] the kernel row u(i) [-]
template <int Dim>
FieldDomains<Dim> field_domains(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                                const DomainSettings& settings);

} // namespace toile::research
