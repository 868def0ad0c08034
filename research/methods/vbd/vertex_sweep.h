#pragma once

#include <vector>

#include "research/methods/baseline_method.h"
#include "research/methods/block_range.h"
#include "research/methods/lane_gather.h"
#include "research/methods/vbd/membrane_corner.h"

namespace toile::research {

/// One triangle around each of eight vertices, rotated so that the vertex is its corner 0.
struct RingTriangle {
    LaneIndices corner1, corner2;
    Mat2Of<Lanes> rest_inv; ///< [1/m] rows: hat gradients of corners 1 and 2; 0 beyond a vertex's triangles
    Lanes area;             ///< [m^2]
};

/// Eight vertices of one colour; the last block of a colour repeats its last vertex.
struct VertexBlock {
    LaneIndices vertex;
    int count = 0; ///< lanes that may write
    Lanes mass;    ///< [kg]
    Lanes bending; ///< [N/m] diagonal of K
    int first_triangle = 0, triangles = 0;
    int first_bend = 0, bends = 0;
};

/// Data read by a sweep besides positions, in reading order.
struct SweepLayout {
    std::vector<BlockRange> colours;
    std::vector<VertexBlock> blocks;
    std::vector<RingTriangle> triangles;
    std::vector<LaneIndices> bend_vertex; ///< off-diagonal entries of K in the rows of eight vertices
    std::vector<Lanes> bend_stiffness;    ///< [N/m]
};

/// Colours the vertices of a cloth, by triangles and by the entries of K, and lays out their terms.
/// @param K  matrix of the bending energy [vertices x vertices] [N/m]
SweepLayout lay_out_sweep(const garment::ClothModel& cloth, const SparseMatrix& K);

/// Newton step of eight vertices on their positions, with all other vertices fixed.
struct DescendVertices {
    const SweepLayout& layout;
    garment::MembraneWeights weights;
    double dt;                       ///< [s]
    View<const Vec3> prediction;     ///< [vertices] [m]
    View<const unsigned char> fixed; ///< [vertices]
    View<Vec3> x;                    ///< [vertices] in and out [m]
    View<double> moved;              ///< [blocks] out: maximum squared displacement [m^2]

    void operator()(int b) const;
};

} // namespace toile::research
