#pragma once

/// Comparison of two lists of near pairs: by CPU and GPU, or in two runs.

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "collision/self/near_pairs.h"

namespace toile::test {

using namespace collision;

/// Max differences between machines: of distances [m], of weights and normals [-].
inline constexpr double kDistanceTolerance = 1e-13;
inline constexpr double kPairTolerance = 1e-9;

/// Weight of a vertex in a pair [-], summed over the corners that are this vertex. On a collapsed triangle
/// the closest point lies on two sides at once, and rounding decides which corner carries the weight.
inline double weight_of(const NearPair& pair, int vertex)
{
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
        sum += pair.vertex[k] == vertex ? pair.weight[k] : 0.0;
    return sum;
}

/// Differences of two lists of pairs, accumulated for one message.
struct Differences {
    int keys = 0, facing = 0, not_finite = 0;
    double distance = 0.0, rest = 0.0;

    void add(const NearPair& a, const NearPair& b)
    {
        keys += int(std::tie(a.is_edge_edge, a.first, a.second, a.vertex) !=
                    std::tie(b.is_edge_edge, b.first, b.second, b.vertex));
        facing += int(a.is_facing != b.is_facing);
        not_finite += int(!std::isfinite(b.distance + b.normal.sum() + b.weight[0] + b.weight[1] +
                                         b.weight[2] + b.weight[3]));
        distance = std::max(distance, std::abs(a.distance - b.distance));
        rest = std::max(rest, (a.normal - b.normal).norm());
        for (int k = 0; k < 4; ++k)
            rest = std::max(rest, std::abs(weight_of(a, a.vertex[k]) - weight_of(b, a.vertex[k])));
    }
};

/// Compares entry by entry.
inline void expect_same(const std::vector<NearPair>& cpu, const std::vector<NearPair>& gpu,
                        const std::string& what)
{
    ASSERT_EQ(cpu.size(), gpu.size()) << what;
    Differences differences;
    for (size_t i = 0; i < cpu.size(); ++i)
        differences.add(cpu[i], gpu[i]);
    EXPECT_EQ(differences.keys, 0) << what;
    EXPECT_EQ(differences.facing, 0) << what;
    EXPECT_EQ(differences.not_finite, 0) << what;
    EXPECT_LT(differences.distance, kDistanceTolerance) << what;
    EXPECT_LT(differences.rest, kPairTolerance) << what;
}

inline bool are_same_bits(const std::vector<NearPair>& a, const std::vector<NearPair>& b)
{
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) {
               return std::tie(p.vertex, p.weight, p.distance, p.first, p.second, p.is_edge_edge,
                               p.is_facing) == std::tie(q.vertex, q.weight, q.distance, q.first, q.second,
                                                        q.is_edge_edge, q.is_facing) &&
                      p.normal == q.normal;
           });
}

} // namespace toile::test
