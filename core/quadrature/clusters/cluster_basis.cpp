#include "core/quadrature/clusters/cluster_basis.h"

#include "core/quadrature/clusters/orthonormalise.h"

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

/// Moments of 1 and of the six coordinates relative to a cluster's centre.
template <int Rank>
using LinearMoments = Eigen::Matrix<double, Rank, 7>;

/// Moments of 1 and the coordinates along the axes of `of`, from a cluster's moments and centre.
template <int Rank>
Eigen::Matrix<double, Rank, Rank> moments_of_coordinates(const LinearMoments<Rank>& moments,
                                                         const EmbeddedPoint& center,
                                                         const ClusterTree::Cluster& of)
{
    Eigen::Matrix<double, Rank, Rank> result;
    result.col(0) = moments.col(0);
    for (int k = 0; k + 1 < Rank; ++k)
        result.col(1 + k) = moments.template rightCols<6>() * of.axes.col(k) +
                            of.axes.col(k).dot(center - of.center) * moments.col(0);
    return result;
}

/// Moments relative to another centre.
template <int Rank>
LinearMoments<Rank> shifted(const LinearMoments<Rank>& moments, const EmbeddedPoint& from,
                            const EmbeddedPoint& to)
{
    LinearMoments<Rank> result = moments;
    result.template rightCols<6>() += moments.col(0) * (from - to).transpose();
    return result;
}

/// Values of 1 and the six coordinates relative to the centre at the slots of a leaf, zero where padded.
Eigen::Matrix<double, kLeaf, 7> linear_functions(const ClusterTree& tree, int leaf,
                                                 View<const EmbeddedPoint> points)
{
    Eigen::Matrix<double, kLeaf, 7> linear = Eigen::Matrix<double, kLeaf, 7>::Zero();
    for (int i = 0; i < kLeaf; ++i)
        if (const int v = tree.nodes()[leaf * kLeaf + i]; v >= 0)
            linear.row(i) << 1.0, (points[v] - tree.cluster(leaf).center).transpose();
    return linear;
}

} // namespace

ClusterBasis::ClusterBasis(const ClusterTree& tree, View<const EmbeddedPoint> points)
    : tree_(tree), rank_(rank_of(tree.extent())), leaves_(size_t(tree.leaf_count()) * kLeaf * rank_, 0.0),
      transfers_(size_t(tree.cluster_count()) * rank_ * rank_, 0.0)
{
    if (tree.extent() == Extent::Surface)
        fill<rank_of(Extent::Surface)>(points);
    else
        fill<rank_of(Extent::Volume)>(points);
    view_.rank = rank_;
    view_.leaf_count = tree.leaf_count();
    for (int level = 0; level < tree.level_count(); ++level)
        view_.first_of_level[level] = tree.first_of_level(level);
    view_.leaves = leaves_;
    view_.transfers = transfers_;
}

template <int Rank>
void ClusterBasis::fill(View<const EmbeddedPoint> points)
{
    using LeafFunctions = Eigen::Matrix<double, kLeaf, Rank>;
    using Transfer = Eigen::Matrix<double, Rank, Rank>;
    using StoredLeaf = Eigen::Map<Eigen::Matrix<double, kLeaf, Rank, Eigen::RowMajor>>;
    using StoredTransfer = Eigen::Map<Eigen::Matrix<double, Rank, Rank, Eigen::RowMajor>>;

    // Leaves: orthonormalise 1 and the coordinates at their nodes.
    std::vector<LinearMoments<Rank>> moments(tree_.cluster_count(), LinearMoments<Rank>::Zero());
    for (int id = 0; id < tree_.leaf_count(); ++id) {
        const Eigen::Matrix<double, kLeaf, 7> linear = linear_functions(tree_, id, points);
        LeafFunctions functions;
        functions.col(0) = linear.col(0);
        functions.template rightCols<Rank - 1>() =
            linear.template rightCols<6>() * tree_.cluster(id).axes.template leftCols<Rank - 1>();
        orthonormalise(functions);
        moments[id] = functions.transpose() * linear;
        StoredLeaf(leaves_.data() + size_t(id) * kLeaf * Rank) = functions;
    }

    // Higher levels: orthonormalise the children's moments of 1 and the coordinates.
    for (int level = 1; level < tree_.level_count(); ++level)
        for (int c = 0; c < tree_.level_size(level); ++c) {
            const int id = tree_.first_of_level(level) + c;
            const ClusterTree::Cluster& cluster = tree_.cluster(id);
            Eigen::Matrix<double, 2 * Rank, Rank> functions = Eigen::Matrix<double, 2 * Rank, Rank>::Zero();
            for (int which = 0; which < 2; ++which)
                if (const int child = tree_.child(level, c, which); child >= 0)
                    functions.template middleRows<Rank>(which * Rank) =
                        moments_of_coordinates<Rank>(moments[child], tree_.cluster(child).center, cluster);
            orthonormalise(functions);
            for (int which = 0; which < 2; ++which)
                if (const int child = tree_.child(level, c, which); child >= 0) {
                    const Transfer transfer = functions.template middleRows<Rank>(which * Rank);
                    StoredTransfer(transfers_.data() + size_t(child) * Rank * Rank) = transfer;
                    moments[id] += transfer.transpose() *
                                   shifted<Rank>(moments[child], tree_.cluster(child).center, cluster.center);
                }
        }
}

} // namespace toile
