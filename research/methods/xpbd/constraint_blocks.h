#pragma once

#include <vector>

#include "garment/energy/membrane_kernels.h"
#include "research/methods/baseline_method.h"
#include "research/methods/block_range.h"
#include "research/methods/lane_gather.h"

namespace toile::research {

/// Eight triangles without common vertices; the last block of a colour repeats its last triangle.
struct StrainBlock {
    LaneIndices corner[3];
    int count = 0;          ///< lanes that may write
    Mat2Of<Lanes> rest_inv; ///< [1/m] rows: hat gradients of corners 1 and 2
    Lanes area;             ///< [m^2]
};

/// Eight curvature stencils without common vertices.
struct CurvatureBlock {
    int count = 0;
    int first_vertex = 0, vertices = 0; ///< stencil entries
    Lanes stiffness[3];                 ///< [N m^3] rows uu, uv, vv
};

/// One vertex in each of eight curvature stencils; weights are 0 beyond the end of a stencil.
struct CurvatureEntry {
    LaneIndices vertex;
    Lanes weight[3]; ///< [1/m^2] in the rows uu, uv, vv
};

/// Coloured constraints of a cloth: no two of one colour share a vertex.
struct ConstraintLayout {
    std::vector<BlockRange> strain_colours, curvature_colours;
    std::vector<StrainBlock> strains;
    std::vector<CurvatureBlock> curvatures;
    std::vector<CurvatureEntry> entries;
};

ConstraintLayout lay_out_constraints(const garment::ClothModel& cloth);

/// Projects the strains of eight triangles: warp, weft, principal stretches (strain_constraints.h).
struct ProjectStrains {
    View<const StrainBlock> blocks;
    garment::MembraneWeights weights;
    double h;                          ///< [s] substep
    View<const double> inverse_masses; ///< [vertices] [1/kg], 0 for fixed vertices
    View<Vec3> x;                      ///< [vertices] [m]

    void operator()(int b) const;
};

/// Projects the curvatures of eight stencils (curvature_constraints.h).
struct ProjectCurvatures {
    View<const CurvatureBlock> blocks;
    View<const CurvatureEntry> entries;
    double h;
    View<const double> inverse_masses;
    View<Vec3> x;

    void operator()(int b) const;
};

} // namespace toile::research
