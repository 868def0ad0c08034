#pragma once

/// Near pairs of vertices whose trajectories changed after a search of all.

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "collision/self/near_pairs.h"
#include "collision/self/pair_rules.h"
#include "tests/collision/soups.h"

namespace toile::test {

using namespace collision;

/// Gives some vertices of a soup new, longer trajectories, and marks them.
inline std::vector<unsigned char> send_elsewhere(Random& random, Soup& soup, int vertices)
{
    std::vector<unsigned char> selected(soup.x.size());
    for (int k = 0; k < vertices; ++k) {
        const int v = random.below(int(soup.x.size()));
        selected[v] = 1;
        soup.motion[v] += random.scale(1e-3, 0.05) * random.point();
        soup.slack[v] = 2e-3 * random.uniform(0, 1);
    }
    return selected;
}

/// True if a pair comes as near as `margin` on its straight trajectories, sampled at many times.
inline bool comes_near(const NearPair& pair, const Soup& soup, double margin)
{
    constexpr int kSamples = 200;
    const int first = first_count(pair.is_edge_edge);
    double slack[2] = {0.0, 0.0};
    for (int k = 0; k < 4; ++k)
        slack[k < first ? 0 : 1] = std::max(slack[k < first ? 0 : 1], soup.slack[pair.vertex[k]]);
    for (int i = 0; i <= kSamples; ++i) {
        std::array<Vec3, 4> at = corners_of(pair.vertex, soup.x);
        for (int k = 0; k < 4; ++k)
            at[k] += double(i) / kSamples * soup.motion[pair.vertex[k]];
        if (closest_difference(closest_weights(pair.is_edge_edge, at), at).norm() <=
            margin + slack[0] + slack[1])
            return true;
    }
    return false;
}

/// Order of near pairs: vertex-triangle by vertex, triangle; then edge-edge.
inline bool comes_before(const NearPair& a, const NearPair& b)
{
    return std::tie(a.is_edge_edge, a.first, a.second) < std::tie(b.is_edge_edge, b.first, b.second);
}

/// Expects sorted pairs without duplicates. Of the pairs with a marked vertex that NearPairs finds, all that
/// come near must be present. Pairs that may not meet must be absent. (The boxes depend on the mean of all
/// trajectories, so other pairs are optional.)
inline void expect_pairs_near(const std::vector<NearPair>& found, const Soup& soup,
                              const std::vector<unsigned char>& selected, double margin,
                              const std::vector<int>& rigid = {})
{
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end(),
                                 [](const NearPair& a, const NearPair& b) { return !comes_before(a, b); }),
              found.end());

    const Trajectories trajectories{soup.motion, soup.slack, selected};
    std::vector<NearPair> expected, missing;
    NearPairs(soup.triangles, soup.x, rigid).find(soup.x, trajectories, margin, expected);
    std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                        std::back_inserter(missing), comes_before);
    EXPECT_TRUE(std::none_of(missing.begin(), missing.end(),
                             [&](const NearPair& pair) { return comes_near(pair, soup, margin); }));

    std::vector<unsigned char> has_triangle(soup.x.size());
    for (const Triangle& corner : soup.triangles)
        for (const int v : corner)
            has_triangle[v] = 1;
    const MayMeet may_meet{soup.x, trajectories, margin + 1e-12, true};
    const auto is_refused = [&](const NearPair& pair) {
        const std::array<int, 4>& v = pair.vertex;
        const int other = v[first_count(pair.is_edge_edge)];
        const bool is_in_one_body = !rigid.empty() && rigid[v[0]] >= 0 && rigid[v[0]] == rigid[other];
        return !is_any_marked(v, selected) || share_vertex(v, pair.is_edge_edge) || is_in_one_body ||
               has_triangle[v[0]] == 0 || !may_meet(v, pair.is_edge_edge);
    };
    EXPECT_TRUE(std::none_of(found.begin(), found.end(), is_refused));
}

} // namespace toile::test
