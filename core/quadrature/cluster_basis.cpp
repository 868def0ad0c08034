#include "core/quadrature/cluster_basis.h"

namespace toile {

namespace {

constexpr int kRank = ClusterBasis::kRank;

/// Columns shorter than this [-] of their length before orthogonalisation are rounding: fewer than kRank
/// nodes, or nodes on a line.
constexpr double kDependent = 1e-6;

/// Modified Gram-Schmidt; dependent columns become zero.
template <typename Matrix>
void orthonormalise(Matrix& columns)
{
    for (int k = 0; k < columns.cols(); ++k) {
        const double length = columns.col(k).norm();
        for (int pass = 0; pass < 2; ++pass)
            for (int j = 0; j < k; ++j)
                columns.col(k) -= columns.col(j).dot(columns.col(k)) * columns.col(j);
        const double rest = columns.col(k).norm();
        if (rest > kDependent * length)
            columns.col(k) /= rest;
        else
            columns.col(k).setZero();
    }
}

/// Moments of 1 and of the six coordinates relative to a cluster's centre.
using LinearMoments = Eigen::Matrix<double, kRank, 7>;

/// Moments of the functions 1 and the two coordinates along `of`'s axes, seen from a cluster with other
/// moments and centre.
ClusterBasis::Transfer moments_of_coordinates(const LinearMoments& moments, const Place& center,
                                              const ClusterTree::Cluster& of)
{
    ClusterBasis::Transfer result;
    result.col(0) = moments.col(0);
    for (int k = 0; k < 2; ++k)
        result.col(1 + k) =
            moments.rightCols<6>() * of.axes.col(k) + of.axes.col(k).dot(center - of.center) * moments.col(0);
    return result;
}

/// The same seen from another centre.
LinearMoments shifted(const LinearMoments& moments, const Place& from, const Place& to)
{
    LinearMoments result = moments;
    result.rightCols<6>() += moments.col(0) * (from - to).transpose();
    return result;
}

} // namespace

ClusterBasis::ClusterBasis(const ClusterTree& tree, View<const Place> places)
    : tree_(tree), leaf_(tree.leaf_count(), LeafFunctions::Zero()),
      to_parent_(tree.cluster_count(), Transfer::Zero())
{
    std::vector<LinearMoments> moments(tree.cluster_count(), LinearMoments::Zero());
    for (int id = 0; id < tree.leaf_count(); ++id) {
        const ClusterTree::Cluster& cluster = tree.cluster(id);
        Eigen::Matrix<double, ClusterTree::kLeaf, 7> linear =
            Eigen::Matrix<double, ClusterTree::kLeaf, 7>::Zero();
        for (int i = 0; i < ClusterTree::kLeaf; ++i)
            if (const int v = tree.nodes()[id * ClusterTree::kLeaf + i]; v >= 0)
                linear.row(i) << 1.0, (places[v] - cluster.center).transpose();
        leaf_[id].col(0) = linear.col(0);
        leaf_[id].rightCols<2>() = linear.rightCols<6>() * cluster.axes;
        orthonormalise(leaf_[id]);
        moments[id] = leaf_[id].transpose() * linear;
    }

    for (int level = 1; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c) {
            const int id = tree.first_of_level(level) + c;
            const ClusterTree::Cluster& cluster = tree.cluster(id);
            Eigen::Matrix<double, 2 * kRank, kRank> functions =
                Eigen::Matrix<double, 2 * kRank, kRank>::Zero();
            for (int which = 0; which < 2; ++which)
                if (const int child = tree.child(level, c, which); child >= 0)
                    functions.middleRows<kRank>(which * kRank) =
                        moments_of_coordinates(moments[child], tree.cluster(child).center, cluster);
            orthonormalise(functions);
            for (int which = 0; which < 2; ++which)
                if (const int child = tree.child(level, c, which); child >= 0) {
                    to_parent_[child] = functions.middleRows<kRank>(which * kRank);
                    moments[id] += to_parent_[child].transpose() *
                                   shifted(moments[child], tree.cluster(child).center, cluster.center);
                }
        }
}

} // namespace toile
