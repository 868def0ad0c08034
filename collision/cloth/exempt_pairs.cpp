#include "collision/cloth/exempt_pairs.h"

#include "collision/cloth/pair_geometry.h"

namespace toile {

namespace {

/// Distance at rest, of the least gap [-], below which neighbours are too near to be told apart from folded
/// cloth.
constexpr double kTooNear = 10.0;

} // namespace

ExemptPairs::ExemptPairs(View<const Vec3> rest, View<const double> altitude, double least_gap)
    : rest_(rest.begin(), rest.end()), too_near_(kTooNear * least_gap), crosses_(rest.size(), 0)
{
    for (const double height : altitude)
        is_thin_.push_back(height < too_near_);
}

bool ExemptPairs::is_exempt(const NearPair& pair) const
{
    const int first = first_count(pair.is_edge_edge);
    bool crosses[2] = {false, false};
    bool is_thin = false;
    for (int k = 0; k < 4; ++k) {
        bool& side = crosses[k < first ? 0 : 1];
        side = side || crosses_[pair.vertex[k]];
        is_thin = is_thin || is_thin_[pair.vertex[k]];
    }
    return (crosses[0] && crosses[1]) || (is_thin && is_sliver_pair(pair));
}

bool ExemptPairs::is_sliver_pair(const NearPair& pair) const
{
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k)
        x[k] = rest_[pair.vertex[k]];
    return closest_difference(closest_weights(pair.is_edge_edge, x), x).norm() < too_near_;
}

} // namespace toile
