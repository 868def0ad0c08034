#include "core/quadrature/clusters/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

namespace toile {

namespace {

/// Extent relative to the largest [-] below which a direction is rounding error.
constexpr double kFlat = 1e-6;

EmbeddedPoint mean_point(View<const EmbeddedPoint> points, View<const int> nodes)
{
    EmbeddedPoint sum = EmbeddedPoint::Zero();
    for (const int v : nodes)
        sum += points[v];
    return sum / nodes.size();
}

/// Candidate normals of the cut: the axes and the diagonals between two of them.
std::vector<Vec3> cut_directions(Extent extent)
{
    std::vector<Vec3> directions{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, -1, 0}};
    if (extent == Extent::Volume)
        for (const Vec3& more : {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, -1), Vec3(0, 1, 1), Vec3(0, 1, -1)})
            directions.push_back(more);
    return directions;
}

/// Squared radius of the ball around the mean [m^2].
double squared_radius(View<const EmbeddedPoint> points, View<const int> nodes)
{
    const EmbeddedPoint center = mean_point(points, nodes);
    double largest = 0.0;
    for (const int v : nodes)
        largest = std::max(largest, (points[v] - center).squaredNorm());
    return largest;
}

} // namespace

ClusterTree::ClusterTree(View<const EmbeddedPoint> points, std::vector<int> nodes, Extent extent)
    : extent_(extent), nodes_(std::move(nodes))
{
    first_of_level_ = {0};
    for (int size = (int(nodes_.size()) + kLeaf - 1) / kLeaf;; size = (size + 1) / 2) {
        first_of_level_.push_back(first_of_level_.back() + size);
        if (size <= 1)
            break;
    }
    clusters_.resize(first_of_level_.back());
    nodes_.resize(size_t(kLeaf) * leaf_count(), -1);
    for (int level = level_count() - 1; level >= 0; --level)
        for (int c = 0; c < level_size(level); ++c) {
            clusters_[first_of_level_[level] + c] = measure(points, nodes_of(level, c), extent);
            if (level > 0)
                split(points, level, c);
        }
}

View<const int> ClusterTree::nodes_of(int level, int c) const
{
    const long first = (long(c) << level) * kLeaf;
    long last = std::min((long(c + 1) << level) * kLeaf, long(nodes_.size()));
    while (last > first && nodes_[last - 1] < 0)
        --last;
    return {nodes_.data() + first, int(last - first)};
}

/// Sorts the nodes of the first child to the front. Cuts across the direction that gives the rounder halves.
/// The longest axis alone is arbitrary for a square, and halves would often be triangles.
void ClusterTree::split(View<const EmbeddedPoint> points, int level, int c)
{
    if (child(level, c, 1) < 0)
        return;
    const View<const int> all = nodes_of(level, c);
    const Eigen::Matrix<double, 6, 3>& axes = clusters_[first_of_level_[level] + c].axes;
    const long first_half = long(kLeaf) << (level - 1);
    std::vector<int> best, order(all.begin(), all.end());
    double best_size = std::numeric_limits<double>::infinity();
    for (const Vec3& direction : cut_directions(extent_)) {
        const EmbeddedPoint axis = axes * direction;
        std::nth_element(order.begin(), order.begin() + first_half, order.end(), [&](int u, int v) {
            const double at_u = axis.dot(points[u]), at_v = axis.dot(points[v]);
            return at_u != at_v ? at_u < at_v : u < v;
        });
        const double size = squared_radius(points, {order.data(), int(first_half)}) +
                            squared_radius(points, {order.data() + first_half, int(all.size() - first_half)});
        if (size < best_size) {
            best_size = size;
            best = order;
        }
    }
    std::copy(best.begin(), best.end(), nodes_.begin() + (all.begin() - nodes_.data()));
}

ClusterTree::Cluster ClusterTree::measure(View<const EmbeddedPoint> points, View<const int> nodes,
                                          Extent extent)
{
    Cluster cluster;
    cluster.center = mean_point(points, nodes);
    cluster.radius = std::sqrt(squared_radius(points, nodes));
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    for (const int v : nodes) {
        const EmbeddedPoint away = points[v] - cluster.center;
        covariance += away * away.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(covariance);
    const double widest = std::sqrt(std::max(eigen.eigenvalues()[5], 0.0));
    for (int k = 0; k < rank_of(extent) - 1; ++k)
        if (widest > 0.0 && std::sqrt(std::max(eigen.eigenvalues()[5 - k], 0.0)) > kFlat * widest)
            cluster.axes.col(k) = eigen.eigenvectors().col(5 - k);
    return cluster;
}

} // namespace toile
