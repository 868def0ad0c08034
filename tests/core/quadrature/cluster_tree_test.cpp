#include "core/quadrature/clusters/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace toile::test {

namespace {

/// Points of a bent, tapering body.
std::vector<Vec3> horn()
{
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) {
        const double t = i / 1000.0, angle = 2.4 * i, width = 0.1 * std::fmod(0.618 * i, 1.0) * (1.2 - t);
        points.emplace_back(t + width * std::cos(angle), t * t + width * std::sin(angle),
                            0.3 * width * std::sin(3.0 * angle));
    }
    return points;
}

/// Nodes of the clusters of 64.
std::set<std::set<int>> clusters_of(const std::vector<Vec3>& positions)
{
    std::vector<EmbeddedPoint> points(positions.size(), EmbeddedPoint::Zero());
    for (size_t i = 0; i < positions.size(); ++i)
        points[i].head<3>() = positions[i];
    std::vector<int> all(points.size());
    std::iota(all.begin(), all.end(), 0);
    const ClusterTree tree(points, all, Extent::Volume);
    std::set<std::set<int>> clusters;
    for (int first = 0; first < tree.nodes().size(); first += 64) {
        std::set<int> cluster;
        for (int slot = first; slot < std::min(first + 64, tree.nodes().size()); ++slot)
            if (tree.nodes()[slot] >= 0)
                cluster.insert(tree.nodes()[slot]);
        clusters.insert(cluster);
    }
    return clusters;
}

TEST(ClusterTree, GroupsABodyInOneWayHoweverItLies)
{
    const std::vector<Vec3> upright = horn();
    const std::set<std::set<int>> clusters = clusters_of(upright);
    EXPECT_EQ(clusters.size(), 16U);
    for (const double angle : {0.4, 1.7, 3.1, 5.0}) {
        const Eigen::AngleAxisd turn(angle, Vec3(1.0, -2.0, 0.5).normalized());
        std::vector<Vec3> placed = upright;
        for (Vec3& x : placed)
            x = turn * x + Vec3(0.3, angle, -1.0);
        EXPECT_EQ(clusters_of(placed), clusters) << "turned by " << angle;
    }
}

} // namespace

} // namespace toile::test
