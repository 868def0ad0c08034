#include "collision/ccd/trajectory_limiter.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "collision/self/pair_rules.h"

namespace toile::test {

using namespace collision;

namespace {

/// Answers that nothing is blocked after the first change, and notes the deviations.
class NotingQuery : public CcdQuery {
public:
    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override
    {
        for (const ChangedTrajectory& change : changed)
            largest = std::max(largest, change.deviation);
        return {};
    }
    double largest = 0.0; ///< [m]
};

/// Largest deviation [m] that the limiter asks a query for, where a vertex is stopped before a triangle.
/// @param edge  [m] mean edge
double largest_deviation(double edge, double asked_motion)
{
    const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
    std::vector<Vec3> base{Vec3(0, 0, 0), Vec3(edge, 0, 0), Vec3(0, 0, edge)};
    for (int k = 0; k < 3; ++k)
        base.push_back(base[k] + Vec3(0, -edge, 0));
    std::vector<Vec3> x = base;
    for (int k = 0; k < 3; ++k)
        x[k].y() -= asked_motion;

    const SurfaceEdges edges = build_surface_edges(triangles, 6);
    const MinGap gap{2e-6, 0.1, 1e-4};
    TrajectoryLimiter limiter(edges, {gap, 0.1 * edge}, RigidTrajectories());
    const std::vector<unsigned char> fixed(6, 0);
    limiter.begin(base, fixed);
    const std::vector<BlockedPair> blocked{
        {near_pair_at(triangles, view_of(edges), base, 0, 1, false), 0.5 * edge / asked_motion}};
    NotingQuery query;
    limiter.limit(x, fixed, query, blocked);
    return query.largest;
}

/// Wide margins around many vertices would make pairs of everything in a fine mesh.
TEST(TrajectoryLimiter, WidensSearchesByPartsOfAnEdge)
{
    EXPECT_NEAR(largest_deviation(0.01, 0.5), 0.005, 1e-12);
    EXPECT_NEAR(largest_deviation(0.001, 0.5), 0.0005, 1e-12);
    const double small = largest_deviation(0.01, 0.006);
    EXPECT_GT(small, 0.0);
    EXPECT_LT(small, 0.005);
}

} // namespace
} // namespace toile::test
