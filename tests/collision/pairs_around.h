#pragma once

/// Near pairs around vertices that go elsewhere than all were searched for.

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "collision/cloth/near_pairs.h"
#include "collision/cloth/pair_rules.h"
#include "tests/collision/soups.h"

namespace toile::test {

/// Sends some vertices of a soup on other ways, farther than before; marks them.
inline std::vector<unsigned char> send_elsewhere(Random& random, Soup& soup, int vertices)
{
    std::vector<unsigned char> around(soup.x.size());
    for (int k = 0; k < vertices; ++k) {
        const int v = random.below(int(soup.x.size()));
        around[v] = 1;
        soup.motion[v] += random.scale(1e-3, 0.05) * random.point();
        soup.slack[v] = 2e-3 * random.uniform(0, 1);
    }
    return around;
}

/// Whether a pair comes as near as `margin` on its straight ways, looked at in many places.
inline bool comes_near(const NearPair& pair, const Soup& soup, double margin)
{
    constexpr int kPlaces = 200;
    const int first = first_count(pair.is_edge_edge);
    double slack[2] = {0.0, 0.0};
    for (int k = 0; k < 4; ++k)
        slack[k < first ? 0 : 1] = std::max(slack[k < first ? 0 : 1], soup.slack[pair.vertex[k]]);
    for (int i = 0; i <= kPlaces; ++i) {
        std::array<Vec3, 4> at = corners_of(pair.vertex, soup.x);
        for (int k = 0; k < 4; ++k)
            at[k] += double(i) / kPlaces * soup.motion[pair.vertex[k]];
        if (closest_difference(closest_weights(pair.is_edge_edge, at), at).norm() <=
            margin + slack[0] + slack[1])
            return true;
    }
    return false;
}

/// Expects each pair once, and of pairs with a marked vertex all that come near, of those that NearPairs
/// finds, and none that may not meet. (What boxes let pass depends on the mean of all ways.)
inline void expect_those_around(const std::vector<NearPair>& found, const Soup& soup,
                                const std::vector<unsigned char>& around, double margin)
{
    const auto key = [](const NearPair& pair) {
        return std::tuple(pair.is_edge_edge, pair.first, pair.second);
    };
    const auto comes_before = [&](const NearPair& a, const NearPair& b) { return key(a) < key(b); };
    const auto is_same = [&](const NearPair& a, const NearPair& b) { return key(a) == key(b); };
    const Ways ways{soup.motion, soup.slack, around};
    std::vector<NearPair> expected, sorted = found;
    NearPairs(soup.triangles, soup.x).find(soup.x, ways, margin, expected);
    std::sort(sorted.begin(), sorted.end(), comes_before);
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end(), is_same), sorted.end());
    std::vector<NearPair> missing;
    std::set_difference(expected.begin(), expected.end(), sorted.begin(), sorted.end(),
                        std::back_inserter(missing), comes_before);
    EXPECT_TRUE(std::none_of(missing.begin(), missing.end(),
                             [&](const NearPair& pair) { return comes_near(pair, soup, margin); }));

    const MayMeet may_meet{soup.x, ways, margin + 1e-12, true};
    int refused = 0;
    for (const NearPair& pair : found) {
        const std::array<int, 4>& v = pair.vertex;
        const bool is_asked_for = around[v[0]] || around[v[1]] || around[v[2]] || around[v[3]];
        refused +=
            int(!is_asked_for || share_vertex(v, pair.is_edge_edge) || !may_meet(v, pair.is_edge_edge));
    }
    EXPECT_EQ(refused, 0);
}

} // namespace toile::test
