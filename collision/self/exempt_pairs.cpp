#include "collision/self/exempt_pairs.h"

#include <algorithm>

namespace toile::collision {

namespace {

/// Distance in the start pose, relative to the minimum gap [-], below which neighbours cannot be
/// distinguished from folded cloth.
constexpr double kTooNear = 10.0;

} // namespace

ExemptPairs::ExemptPairs(View<const Vec3> rest, View<const double> altitude, double min_gap)
    : rest_(rest.begin(), rest.end()), too_near_(kTooNear * min_gap), crosses_(rest.size(), 0)
{
    for (const double height : altitude)
        is_thin_.push_back(height < too_near_);
}

void ExemptPairs::set_body_crossings(std::vector<BodyCrossing> crossings)
{
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    body_crossings_ = std::move(crossings);
}

void ExemptPairs::add_body_crossings(View<const BodyCrossing> more)
{
    std::vector<BodyCrossing> all = body_crossings_;
    all.insert(all.end(), more.begin(), more.end());
    set_body_crossings(std::move(all));
}

/// True if the pair has vertices of two triangles that cross, or cloth inside a body.
bool ExemptPairs::crosses_body(const NearPair& pair) const
{
    if (body_crossings_.empty() && inside_.empty())
        return false;
    const int cloth = int(inside_.size());
    const bool has_body = is_with_body(pair, cloth);
    for (const int v : pair.vertex)
        if (has_body && v < cloth && inside_[v] != 0)
            return true;
    const int first = first_count(pair.is_edge_edge);
    for (int a = 0; a < first; ++a)
        for (int b = first; b < 4; ++b) {
            const auto [low, high] = std::minmax(pair.vertex[a], pair.vertex[b]);
            if (std::binary_search(body_crossings_.begin(), body_crossings_.end(), BodyCrossing(low, high)))
                return true;
        }
    return false;
}

} // namespace toile::collision
