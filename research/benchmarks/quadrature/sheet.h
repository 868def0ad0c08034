#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"
#include "research/paper_rule/voxelised_mesh.h"

/// A flat sheet with the matrix of Projective Dynamics, to measure quadrature rules.
namespace toile::research {

struct Sheet {
    std::vector<Vec2> uv;            ///< [vertices] in the unit square [m]
    std::vector<Triangle> triangles; ///< counter-clockwise
    std::vector<double> area;        ///< [vertices] lumped [m^2]

    int vertex_count() const { return int(uv.size()); }
};

/// side x side vertices on the unit square, cells cut in two; inner vertices moved by up to `jitter` cells
/// with a fixed seed.
Sheet unit_sheet(int side, double jitter = 0.0);

/// M / dt^2 + k L on the sheet: density 0.2 kg/m^2, dt 1/120 s, L the cotangent Laplacian.
/// @param k      membrane stiffness [N/m]
/// @param fixed  [vertices] 1 if row and column are the identity's; empty for none
SparseMatrix sheet_matrix(const Sheet& sheet, double k, const std::vector<unsigned char>& fixed = {});

/// u(i) = G(:, i) / G_ii with G = H^-1. [vertices] [-]
std::vector<double> kernel_row(const SparseMatrix& H, int vertex);

/// M / dt^2 q for a smooth field q: a right-hand side by inertia. [vertices] [N]
std::vector<Vec3> smooth_load(const Sheet& sheet);

} // namespace toile::research
