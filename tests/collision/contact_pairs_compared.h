#pragma once

/// Comparison of two results of a query of pairs of cloth and colliders: by CPU and GPU, or in two runs.

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "collision/geometry/contact_pair.h"

namespace toile::test {

using namespace collision;

/// Max differences between machines of points and motions [m], and of weights [-].
inline constexpr double kContactTolerance = 1e-12;

/// Max difference of normals [-], due to the face normals of needles. Rounding of coordinates of some metres
/// comes on top, divided by the distance whose direction is the normal.
inline constexpr double kNormalTolerance = 1e-11;
inline constexpr double kNormalRounding = 1e-14; ///< [m]

/// Differences of two lists of pairs, accumulated for one message.
struct ContactDifferences {
    int keys = 0, not_finite = 0;
    double numbers = 0.0; ///< [m] of points and motions, and of weights
    double normal = 0.0;  ///< [-] less the part explained by rounding

    void add(const ContactPair& a, const ContactPair& b, View<const Vec3> x)
    {
        keys += int(std::tie(a.kind, a.collider, a.feature, a.vertex) !=
                    std::tie(b.kind, b.collider, b.feature, b.vertex));
        not_finite += int(!b.point.allFinite() || !b.motion.allFinite() || !b.normal.allFinite());
        numbers = std::max({numbers, (a.point - b.point).norm(), (a.motion - b.motion).norm()});
        for (int k = 0; k < 4; ++k)
            numbers = std::max(numbers, std::abs(a.weight[k] - b.weight[k]));
        const double distance = (a.cloth_point(x) - a.point).norm();
        normal = std::max(normal, (a.normal - b.normal).norm() - kNormalRounding / std::max(distance, 1e-6));
    }
};

/// Compares entry by entry.
/// @param x  cloth positions [m]
inline void expect_same(const std::vector<ContactPair>& cpu, const std::vector<ContactPair>& gpu,
                        View<const Vec3> x, const std::string& what)
{
    ASSERT_EQ(cpu.size(), gpu.size()) << what;
    ContactDifferences differences;
    for (size_t i = 0; i < cpu.size(); ++i)
        differences.add(cpu[i], gpu[i], x);
    EXPECT_EQ(differences.keys, 0) << what;
    EXPECT_EQ(differences.not_finite, 0) << what;
    EXPECT_LT(differences.numbers, kContactTolerance) << what;
    EXPECT_LT(differences.normal, kNormalTolerance) << what;
}

inline bool are_same_bits(const std::vector<ContactPair>& a, const std::vector<ContactPair>& b)
{
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) {
               return std::tie(p.vertex, p.weight, p.collider, p.kind, p.feature) ==
                          std::tie(q.vertex, q.weight, q.collider, q.kind, q.feature) &&
                      p.normal == q.normal && p.point == q.point && p.motion == q.motion;
           });
}

} // namespace toile::test
