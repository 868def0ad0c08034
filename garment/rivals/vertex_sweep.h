#pragma once

#include <vector>

#include "garment/rivals/block_range.h"
#include "garment/rivals/lane_gather.h"
#include "garment/rivals/membrane_corner.h"
#include "garment/rivals/rival.h"

namespace toile {

/// One triangle around each of eight vertices, turned so that the vertex is its corner 0.
struct RingTriangle {
    LaneIndices corner1, corner2;
    Mat2Of<Lanes> rest_inv; ///< [1/m] rows: hat gradients of corners 1 and 2; 0 where a vertex has no more
    Lanes area;             ///< [m^2]
};

/// Eight vertices of one colour; the last of a colour repeats its last vertex.
struct VertexBlock {
    LaneIndices vertex;
    int count = 0; ///< lanes that may write
    Lanes mass;    ///< [kg]
    Lanes bending; ///< [N/m] diagonal of K
    int first_triangle = 0, triangles = 0;
    int first_bend = 0, bends = 0;
};

/// Everything a sweep reads besides positions, in the order in which it reads it.
struct SweepLayout {
    std::vector<BlockRange> colours;
    std::vector<VertexBlock> blocks;
    std::vector<RingTriangle> triangles;
    std::vector<LaneIndices> bend_vertex; ///< off-diagonal entries of K in the rows of eight vertices
    std::vector<Lanes> bend_stiffness;    ///< [N/m]
};

/// Colours the vertices of a cloth, by triangles and by the entries of K, and lays out their terms.
/// @param K  matrix of the bending energy [vertices x vertices] [N/m]
SweepLayout lay_out_sweep(const ClothModel& cloth, const SparseMatrix& K);

/// Newton step of eight vertices on their own positions, all others held.
struct DescendVertices {
    const SweepLayout& layout;
    MembraneWeights weights;
    double dt;                       ///< [s]
    View<const Vec3> prediction;     ///< [vertices] [m]
    View<const unsigned char> fixed; ///< [vertices]
    View<Vec3> x;                    ///< [vertices] in and out [m]
    View<double> moved;              ///< [blocks] out: largest squared move [m^2]

    void operator()(int b) const;
};

} // namespace toile
