#include "research/paper_rule/voxelised_mesh.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <sstream>
#include <string>

#include <Eigen/LU>

#include "core/base/error.h"
#include "research/paper_rule/kuhn_cut.h"

namespace toile::research {

namespace {

/// Tolerance by which a barycentric weight may be negative inside [-]: points on a face belong to both of its
/// simplices.
constexpr double kFaceSlack = 1e-9;

template <int Dim>
constexpr const char* kSimplexName = Dim == 2 ? "triangle" : "tetrahedron";

template <int Dim>
std::string text(const Point<Dim>& point)
{
    std::ostringstream stream;
    stream << "(" << point.transpose().format(Eigen::IOFormat(6, Eigen::DontAlignCols, ", ", ", ")) << ")";
    return stream.str();
}

/// Barycentric weights of the centres of cuts^Dim pieces of a simplex, all of the same volume: those of
/// Kuhn's cut of cubes that are in the simplex cuts >= y_0 >= y_1 >= ... >= 0.
template <int Dim>
std::vector<typename VoxelisedMesh<Dim>::Weights> centers_of_pieces(int cuts)
{
    std::vector<typename VoxelisedMesh<Dim>::Weights> centers;
    VoxelBox<Dim> cubes;
    cubes.last.fill(cuts - 1);
    const auto pieces = kuhn_cut<Dim>();
    cubes.for_each([&](const Voxel<Dim>& cube) {
        for (const auto& corners : pieces) {
            Point<Dim> y;
            for (int axis = 0; axis < Dim; ++axis) {
                const int sum =
                    std::accumulate(corners.begin(), corners.end(), 0,
                                    [axis](int part, const auto& corner) { return part + corner[axis]; });
                y[axis] = (cube[axis] + double(sum) / (Dim + 1)) / cuts;
            }
            if (!std::is_sorted(y.data(), y.data() + Dim, std::greater<>()))
                continue;
            auto& weight = centers.emplace_back();
            for (int corner = 0; corner <= Dim; ++corner)
                weight[corner] = (corner == 0 ? 1.0 : y[corner - 1]) - (corner == Dim ? 0.0 : y[corner]);
        }
    });
    return centers;
}

} // namespace

template <int Dim>
VoxelisedMesh<Dim>::VoxelisedMesh(View<const Point<Dim>> positions, View<const Simplex<Dim>> simplices,
                                  int voxels)
    : positions_(positions.begin(), positions.end()), simplices_(simplices.begin(), simplices.end()),
      volume_(positions.size(), 0.0)
{
    if (voxels < 1)
        throw InvalidInput("paper rule: " + std::to_string(voxels) + " voxels; at least 1 needed");
    read_simplices();
    Box<Dim> bounds;
    for (const Point<Dim>& point : positions_)
        bounds.extend(point);
    grid_ = VoxelGrid<Dim>(bounds, voxels);
    measure_coverage();
    find_voxels_of_vertices();
    sort_into_voxels();
}

template <int Dim>
void VoxelisedMesh<Dim>::read_simplices()
{
    const std::string name = std::string("paper rule: ") + kSimplexName<Dim>;
    if (simplices_.empty())
        throw InvalidInput("paper rule: no " + std::string(kSimplexName<Dim>));
    for (int k = 0; k < vertex_count(); ++k)
        if (!positions_[k].allFinite())
            throw InvalidInput("paper rule: vertex " + std::to_string(k) + " lies at " +
                               text<Dim>(positions_[k]) + "; finite numbers needed");
    const double unit_simplex = 1.0 / (Dim == 2 ? 2.0 : 6.0);
    for (size_t s = 0; s < simplices_.size(); ++s) {
        const Simplex<Dim>& simplex = simplices_[s];
        for (const int vertex : simplex)
            if (vertex < 0 || vertex >= vertex_count())
                throw InvalidInput(name + " " + std::to_string(s) + " names a vertex outside of 0.." +
                                   std::to_string(vertex_count() - 1));
        Eigen::Matrix<double, Dim, Dim> edges;
        for (int a = 0; a < Dim; ++a)
            edges.col(a) = positions_[simplex[a + 1]] - positions_[simplex[0]];
        const double volume = unit_simplex * edges.determinant();
        if (!(volume > 0.0))
            throw InvalidInput(name + " " + std::to_string(s) + " is inside out or flat");
        edges_inv_.push_back(edges.inverse());
        simplex_volume_.push_back(volume);
        for (const int vertex : simplex)
            volume_[vertex] += volume / (Dim + 1);
    }
    for (int k = 0; k < vertex_count(); ++k)
        if (!(volume_[k] > 0.0))
            throw InvalidInput("paper rule: vertex " + std::to_string(k) + " belongs to no " +
                               kSimplexName<Dim>);
}

template <int Dim>
Box<Dim> VoxelisedMesh<Dim>::box_of(const Simplex<Dim>& simplex) const
{
    Box<Dim> box;
    for (const int vertex : simplex)
        box.extend(positions_[vertex]);
    return box;
}

template <int Dim>
void VoxelisedMesh<Dim>::measure_coverage()
{
    is_covered_.assign(grid_.count(), 0);
    Triplets integrals;
    for (size_t s = 0; s < simplices_.size(); ++s) {
        const Simplex<Dim>& simplex = simplices_[s];
        const double voxels_across = box_of(simplex).sizes().cwiseQuotient(grid_.voxel_size).maxCoeff();
        const auto centers = centers_of_pieces<Dim>(std::max(1, int(std::ceil(2.0 * voxels_across))));
        const double piece = simplex_volume_[s] / double(centers.size());
        for (const Weights& weight : centers) {
            Point<Dim> center = Point<Dim>::Zero();
            for (int corner = 0; corner <= Dim; ++corner)
                center += weight[corner] * positions_[simplex[corner]];
            const int voxel = grid_.index(grid_.voxel_of(center));
            is_covered_[voxel] = 1;
            for (int corner = 0; corner <= Dim; ++corner)
                integrals.emplace_back(voxel, simplex[corner], piece * weight[corner]);
        }
    }
    coverage_.resize(grid_.count(), vertex_count());
    coverage_.setFromTriplets(integrals.begin(), integrals.end());
}

template <int Dim>
void VoxelisedMesh<Dim>::find_voxels_of_vertices()
{
    std::vector<double> largest(vertex_count(), 0.0);
    voxel_of_vertex_.resize(vertex_count());
    for (int voxel = 0; voxel < grid_.count(); ++voxel)
        for (SparseMatrix::InnerIterator entry(coverage_, voxel); entry; ++entry)
            if (const int k = int(entry.col()); entry.value() > largest[k]) {
                largest[k] = entry.value();
                voxel_of_vertex_[k] = grid_.at(voxel);
            }
    for (int k = 0; k < vertex_count(); ++k)
        if (const Voxel<Dim> nearest = grid_.voxel_of(positions_[k]); is_covered_[grid_.index(nearest)])
            voxel_of_vertex_[k] = nearest;
}

template <int Dim>
void VoxelisedMesh<Dim>::sort_into_voxels()
{
    simplices_of_voxel_.assign(grid_.count(), {});
    for (size_t s = 0; s < simplices_.size(); ++s) {
        const Box<Dim> box = box_of(simplices_[s]);
        VoxelBox<Dim>{grid_.voxel_of(box.min()), grid_.voxel_of(box.max())}.for_each(
            [&](const Voxel<Dim>& voxel) { simplices_of_voxel_[grid_.index(voxel)].push_back(int(s)); });
    }
}

template <int Dim>
auto VoxelisedMesh<Dim>::locate(const Point<Dim>& point) const -> std::optional<Barycentric>
{
    for (const int s : simplices_of_voxel_[grid_.index(grid_.voxel_of(point))]) {
        Weights weight;
        weight.template tail<Dim>() = edges_inv_[s] * (point - positions_[simplices_[s][0]]);
        weight[0] = 1.0 - weight.template tail<Dim>().sum();
        if (weight.minCoeff() >= -kFaceSlack) {
            weight = weight.cwiseMax(0.0);
            return Barycentric{simplices_[s], weight / weight.sum()};
        }
    }
    return std::nullopt;
}

template class VoxelisedMesh<2>;
template class VoxelisedMesh<3>;

} // namespace toile::research
