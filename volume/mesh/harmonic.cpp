#include "volume/mesh/harmonic.h"

#include <Eigen/Dense>
#include <Eigen/IterativeLinearSolvers>

#include "core/linear/sparse_matrix.h"

namespace toile::volume {

namespace {

/// Gradients of the four corners' linear functions: columns [1/m].
Eigen::Matrix<double, 3, 4> corner_gradients(const Tet& tet, View<const Vec3> x)
{
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = x[tet[k + 1]] - x[tet[0]];
    Eigen::Matrix<double, 3, 4> gradients;
    gradients.rightCols<3>() = edges.inverse().transpose();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    return gradients;
}

} // namespace

void extend_harmonically(const TetMesh& mesh, View<const char> is_given, View<Vec3> values)
{
    std::vector<int> row(mesh.positions.size(), -1);
    int rows = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (is_given[v] == 0)
            row[v] = rows++;
    if (rows == 0)
        return;

    Triplets entries;
    Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(rows, 3), free = right;
    for (const Tet& tet : mesh.tets) {
        const Eigen::Matrix<double, 3, 4> gradients = corner_gradients(tet, mesh.positions);
        const Eigen::Matrix4d stiffness = volume_of(tet, mesh.positions) * gradients.transpose() * gradients;
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4 && row[tet[a]] >= 0; ++b)
                if (row[tet[b]] >= 0)
                    entries.emplace_back(row[tet[a]], row[tet[b]], stiffness(a, b));
                else
                    right.row(row[tet[a]]) -= stiffness(a, b) * values[tet[b]].transpose();
    }
    SparseMatrix laplacian(rows, rows);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver(laplacian);
    solver.setTolerance(1e-6);
    free = solver.solve(right);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (row[v] >= 0)
            values[v] = free.row(row[v]).transpose();
}

} // namespace toile::volume
