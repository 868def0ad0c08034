#include "volume/energy/harmonic.h"

#include <Eigen/Dense>
#include <Eigen/IterativeLinearSolvers>

#include "core/linear/sparse_matrix.h"
#include "volume/energy/rest_tets.h"

namespace toile::volume {

namespace {

/// Residual relative to the right side [-].
constexpr double kTolerance = 1e-6;

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
    Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(rows, 3);
    for (const Tet& tet : mesh.tets) {
        const Eigen::Matrix<double, 4, 3> hats = hat_gradients(edges_of(tet, mesh.positions).inverse());
        const Eigen::Matrix4d stiffness = volume_of(tet, mesh.positions) * hats * hats.transpose();
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
    solver.setTolerance(kTolerance);
    const Eigen::MatrixX3d solution = solver.solve(right);
    TOILE_ASSERT(solver.info() == Eigen::Success);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (row[v] >= 0)
            values[v] = solution.row(row[v]).transpose();
}

} // namespace toile::volume
