#include "collision/self/near_pairs.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "collision/ccd/safe_motion.h"
#include "collision/geometry/surface_edges.h"
#include "core/compute/parallel.h"
#include "tests/collision/soups.h"

namespace toile::test {

using namespace collision;

namespace {

using test::add_sheet;
using test::folded_sheet;
using test::Random;
using test::random_soup;
using test::Soup;

using Key = std::tuple<bool, std::array<int, 4>>;

/// True if a vertex moves differently from the others.
bool is_moving(const Soup& soup)
{
    return std::any_of(soup.motion.begin(), soup.motion.end(),
                       [&](const Vec3& m) { return m != soup.motion[0]; });
}

/// Corners of a pair at a fraction of its motion.
std::array<Vec3, 4> corners_at(const Soup& soup, const std::array<int, 4>& v, double fraction)
{
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k)
        x[k] = soup.x[v[k]] + fraction * soup.motion[v[k]];
    return x;
}

/// Max deviation of both sides of a pair from their trajectories at their end [m].
double slack_of(const Soup& soup, bool is_edge_edge, const std::array<int, 4>& v)
{
    double side[2] = {0.0, 0.0};
    for (int k = 0; k < 4; ++k) {
        double& largest = side[k < (is_edge_edge ? 2 : 1) ? 0 : 1];
        largest = std::max(largest, soup.slack[v[k]]);
    }
    return side[0] + side[1];
}

double distance_at(const Soup& soup, bool is_edge_edge, const std::array<int, 4>& v, double fraction)
{
    const std::array<Vec3, 4> x = corners_at(soup, v, fraction);
    return closest_difference(closest_weights(is_edge_edge, x), x).norm();
}

/// True if the pair comes nearer than the margin at a sampled time, both sides deviating towards each other.
bool must_be_found(const Soup& soup, bool is_edge_edge, const std::array<int, 4>& v, double margin)
{
    const int times = is_moving(soup) ? 5 : 0;
    for (int k = 0; k <= times; ++k)
        if (distance_at(soup, is_edge_edge, v, 0.2 * k) <=
            margin + 0.2 * k * 0.999 * slack_of(soup, is_edge_edge, v))
            return true;
    return false;
}

/// True if the initial separating direction does not separate the pair throughout.
bool may_be_found(const Soup& soup, bool is_edge_edge, const std::array<int, 4>& v, double margin)
{
    margin += slack_of(soup, is_edge_edge, v);
    const std::array<Vec3, 4> x = corners_at(soup, v, 0.0);
    const Vec3 difference = closest_difference(closest_weights(is_edge_edge, x), x);
    if (difference.norm() <= margin)
        return true;
    return is_moving(soup) &&
           gap_along(difference.normalized(), is_edge_edge, corners_at(soup, v, 1.0)) <= margin;
}

/// All pairs that satisfy a rule, unordered.
template <typename Rule>
std::set<Key> all_pairs(const Soup& soup, double margin, const Rule& rule)
{
    std::set<Key> pairs;
    const auto add = [&](bool is_edge_edge, const std::array<int, 4>& v) {
        const int first = is_edge_edge ? 2 : 1;
        for (int a = 0; a < first; ++a)
            if (std::find(v.begin() + first, v.end(), v[a]) != v.end())
                return;
        if (rule(soup, is_edge_edge, v, margin))
            pairs.emplace(is_edge_edge, v);
    };
    std::set<int> used;
    for (const Triangle& t : soup.triangles)
        used.insert(t.begin(), t.end());
    for (const int p : used)
        for (const Triangle& t : soup.triangles)
            add(false, {p, t[0], t[1], t[2]});
    const auto edges = build_surface_edges(soup.triangles, int(soup.x.size())).vertex;
    for (size_t e = 0; e < edges.size(); ++e)
        for (size_t f = e + 1; f < edges.size(); ++f)
            add(true, {edges[e][0], edges[e][1], edges[f][0], edges[f][1]});
    return pairs;
}

std::vector<NearPair> find(const Soup& soup, double margin)
{
    std::vector<NearPair> pairs;
    NearPairs(soup.triangles, soup.x).find(soup.x, soup.trajectories(), margin, pairs);
    return pairs;
}

std::set<Key> keys_of(const std::vector<NearPair>& pairs)
{
    std::set<Key> keys;
    for (const NearPair& pair : pairs)
        keys.emplace(pair.is_edge_edge, pair.vertex);
    return keys;
}

/// Expects all pairs that must be found, none that may not be found, in order.
void expect_all_pairs(const Soup& soup, double margin, const std::vector<NearPair>& found)
{
    const std::set<Key> keys = keys_of(found);
    const std::set<Key> must = all_pairs(soup, margin, must_be_found);
    const std::set<Key> may = all_pairs(soup, margin, may_be_found);
    EXPECT_TRUE(std::includes(keys.begin(), keys.end(), must.begin(), must.end()));
    EXPECT_TRUE(std::includes(may.begin(), may.end(), keys.begin(), keys.end()));
    const auto order = [](const NearPair& p) {
        return std::tuple(p.is_edge_edge, p.vertex[0], p.is_edge_edge ? p.vertex[1] : 0);
    };
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(),
                               [&](const NearPair& a, const NearPair& b) { return order(a) < order(b); }));
}

TEST(NearPairs, MatchAllPairsInRandomSoups)
{
    Random random(21);
    size_t count = 0;
    for (int i = 0; i < 20; ++i) {
        Soup soup = random_soup(random);
        NearPairs near(soup.triangles, soup.x);
        std::vector<NearPair> found;
        for (const double margin : {0.0, 0.01, 0.1}) {
            near.find(soup.x, soup.trajectories(), margin, found);
            expect_all_pairs(soup, margin, found);
            count += found.size();
            for (Vec3& x : soup.x)
                x += 0.3 * random.point() + Vec3(100, 0, 0);
        }
    }
    EXPECT_GT(count, 10000u);
}

TEST(NearPairs, MatchAllPairsOnFoldedSheets)
{
    Random random(22);
    for (int i = 0; i < 3; ++i) {
        const Soup soup = folded_sheet(random);
        const std::vector<NearPair> found = find(soup, 0.002);
        expect_all_pairs(soup, 0.002, found);
        EXPECT_GT(found.size(), 1000u);
        EXPECT_EQ(found.size(), keys_of(found).size()); // no duplicates
    }
}

TEST(NearPairs, GiveTheClosestPoints)
{
    Random random(23);
    const Soup soup = folded_sheet(random);
    for (const NearPair& pair : find(soup, 0.002)) {
        std::array<Vec3, 4> x;
        Vec3 difference = Vec3::Zero();
        double sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            x[k] = soup.x[pair.vertex[k]];
            difference += pair.weight[k] * x[k];
            sum += pair.weight[k];
        }
        EXPECT_NEAR(sum, 0.0, 1e-15);
        EXPECT_NEAR(pair.distance, test::exact_distance(pair.is_edge_edge, x), 1e-14);
        EXPECT_LT((pair.distance * pair.normal - difference).norm(), 1e-15);
    }
}

TEST(NearPairs, AreEmptyOnAFlatSheet)
{
    Soup soup;
    add_sheet(soup, 40, 0.01, 0.2);
    // Min distance of primitives without a common vertex: a diagonal and the opposite corner.
    EXPECT_TRUE(find(soup, 0.0070).empty());
    EXPECT_FALSE(find(soup, 0.0072).empty());
    // Free fall is no relative motion; single precision resolves the sheet far from the origin.
    std::fill(soup.motion.begin(), soup.motion.end(), Vec3(0.1, -40.0, 0.3));
    for (Vec3& x : soup.x)
        x += Vec3(5000, -3000, 100);
    EXPECT_TRUE(find(soup, 0.0070).empty());
}

TEST(NearPairs, ExactlyAtTheMarginAreNotMissed)
{
    // Boxes touch, on coordinates that single precision rounds up or down.
    Random random(26);
    for (int i = 0; i < 200; ++i) {
        Soup soup;
        soup.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 6, 6}};
        const Vec3 corner = random.point() + Vec3(1000, 0, 0);
        const double height = random.uniform(0.1, 1.0);
        for (const double y : {0.0, height})
            for (const Vec3& x : {Vec3(0, y, 0), Vec3(1, y, 0), Vec3(0, y, 1)})
                soup.x.push_back(corner + x);
        soup.x.push_back(corner + 10.0 * random.point()); // moves the centre of the boxes' coordinates
        soup.stand_still();
        const double gap = soup.x[3].y() - soup.x[0].y();
        EXPECT_EQ(find(soup, gap).size(), all_pairs(soup, gap, must_be_found).size());
        EXPECT_FALSE(find(soup, gap).empty());
    }
}

TEST(NearPairs, HaveTheSameBitsForEveryThreadCount)
{
    Random random(24);
    const Soup soup = folded_sheet(random);
    std::vector<std::vector<NearPair>> found;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        found.push_back(find(soup, 0.002));
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    for (size_t i = 0; i < found[0].size(); ++i) {
        const NearPair &a = found[0][i], &b = found[1][i];
        EXPECT_EQ(std::tie(a.vertex, a.weight, a.distance, a.is_edge_edge, a.is_facing),
                  std::tie(b.vertex, b.weight, b.distance, b.is_edge_edge, b.is_facing));
        EXPECT_EQ(a.normal, b.normal);
    }
}

TEST(NearPairs, RebuildOnlyWhenTheTreeDegrades)
{
    Random random(25);
    Soup soup;
    for (int layer = 0; layer < 20; ++layer)
        add_sheet(soup, 8, 0.01, 0.01 * layer);
    NearPairs near(soup.triangles, soup.x);
    Stages stages;
    const Stages::Activate activate(stages);
    std::vector<NearPair> found;
    // Unchanged, translated, rotated, and with another margin.
    near.find(soup.x, soup.trajectories(), 0.004, found);
    for (Vec3& x : soup.x)
        x = Vec3(x.y(), 10.0 - x.x(), x.z());
    near.find(soup.x, soup.trajectories(), 0.04, found);
    EXPECT_EQ(stages.calls("collision/cloth_rebuild"), 0);
    EXPECT_EQ(stages.calls("collision/cloth_refit"), 2);
    // Layers scattered: the old tree is inefficient, the new one is not.
    for (size_t v = 0; v < soup.x.size(); ++v)
        soup.x[v] += Vec3(0.3 * double((7 * (v / 64)) % 20), 0, 0);
    near.find(soup.x, soup.trajectories(), 0.004, found);
    near.find(soup.x, soup.trajectories(), 0.004, found);
    EXPECT_EQ(stages.calls("collision/cloth_rebuild"), 1);
    expect_all_pairs(soup, 0.004, found);
}

TEST(NearPairs, AreEmptyWithoutTriangles)
{
    Soup soup;
    EXPECT_TRUE(find(soup, 1.0).empty());
    soup.x = {Vec3::Zero(), Vec3::UnitX()};
    soup.stand_still();
    EXPECT_TRUE(find(soup, 1.0).empty());
}

} // namespace
} // namespace toile::test
