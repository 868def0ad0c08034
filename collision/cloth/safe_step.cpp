#include "collision/cloth/safe_step.h"

#include <algorithm>
#include <iterator>

#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Part of an allowed share that is taken [-]: the shortened way is another one, whose own limit must not be
/// met again by rounding.
constexpr double kTaken = 0.95;

/// How much farther back than it is a vertex may fall before pairs are looked for again [-].
constexpr double kLagMore = 1.5;

/// Rounds in which the vertices of a pair are brought back in proportion. Those that are still in the way
/// then stay where they began.
constexpr int kRounds = 16;

/// True where the direction that separates the pair at first shows that it may go all of its way.
bool stays_apart(const NearPair& pair, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& move,
                 double least)
{
    std::array<Vec3, 4> end;
    for (int k = 0; k < 4; ++k)
        end[k] = x[k] + move[k];
    return pair.distance >= least && gap_along(pair.normal, pair.is_edge_edge, end) >= least;
}

} // namespace

void SafeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                     View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    expected_ = expected;
    slack_ = slack;
    expected_pairs_ = pairs;
}

double SafeStep::limit(View<Vec3> x)
{
    const StageScope stage("collision/safe_step");
    way_.resize(x.size());
    for (int v = 0; v < x.size(); ++v)
        way_[v] = x[v] - base_[v];
    least_share_.assign(x.size(), 1.0);
    share_.assign(x.size(), 1.0);
    is_stale_.assign(x.size(), 1);
    is_marked_.assign(x.size(), 0);
    more_pairs_.clear();
    if (mark_strays(x))
        look_around_marked();
    if (pair_count() == 0 || !find_shares())
        return 0.0;

    double farthest = 0.0;
    for (int v = 0; v < x.size(); ++v) {
        if (share_[v] == 1.0)
            continue;
        x[v] = base_[v] + share_[v] * way_[v];
        farthest = std::max(farthest, (1.0 - share_[v]) * way_[v].norm());
    }
    return farthest;
}

/// Of two layers that lie on each other a tenth of their distance is left; far ones may come that near too.
double SafeStep::least_gap_of(const NearPair& pair) const
{
    return std::max(settings_.least_gap,
                    settings_.least_share * std::min(pair.distance, settings_.thickness));
}

/// Marks who is not near where it was expected. False when nobody is.
bool SafeStep::mark_strays(View<const Vec3> x)
{
    bool any = false;
    for (int v = 0; v < x.size(); ++v) {
        is_marked_[v] = (x[v] - expected_[v]).squaredNorm() > slack_[v] * slack_[v];
        any = any || is_marked_[v];
    }
    return any;
}

/// Adds the pairs of marked vertices, for the ways as they are, of which those that lag behind may go less.
void SafeStep::look_around_marked()
{
    const StageScope stage("collision/look_again");
    least_.resize(way_.size());
    for (size_t v = 0; v < way_.size(); ++v)
        least_[v] = least_share_[v] * way_[v];
    near_.find(base_, {way_, least_, {}, is_marked_},
               std::max(settings_.least_gap, settings_.least_share * settings_.thickness), found_pairs_);
    std::copy_if(found_pairs_.begin(), found_pairs_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
    std::fill(is_marked_.begin(), is_marked_.end(), 0);
    has_marked_ = false;
}

/// The share of its way that every vertex may go. False when all may go all of it.
bool SafeStep::find_shares()
{
    bool was_shortened = false;
    for (int round = 0;; ++round) {
        look_at_pairs();
        if (!shorten(round >= kRounds))
            return was_shortened;
        was_shortened = true;
        if (has_marked_)
            look_around_marked();
    }
}

void SafeStep::look_at_pairs()
{
    pair_share_.resize(pair_count());
    parallel_for(kCpu, "collision/safe_share", pair_count(), [&](int i) {
        const NearPair& pair = this->pair(i);
        pair_share_[i] = 1.0;
        std::array<Vec3, 4> x, move;
        bool is_stale = false;
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertex[k];
            is_stale = is_stale || is_stale_[v];
            x[k] = base_[v];
            move[k] = share_[v] * way_[v];
        }
        const double least = least_gap_of(pair);
        if (is_stale && !stays_apart(pair, x, move, least))
            pair_share_[i] = safe_share(pair.is_edge_edge, x, move, least);
    });
}

/// Brings the vertices of pairs in each other's way back. False when there are none.
bool SafeStep::shorten(bool for_good)
{
    std::fill(is_stale_.begin(), is_stale_.end(), 0);
    bool any = false;
    const std::vector<double> before = share_;
    for (int i = 0; i < pair_count(); ++i) {
        if (pair_share_[i] >= 1.0)
            continue;
        any = true;
        for (const int v : pair(i).vertex) {
            share_[v] = for_good ? 0.0 : std::min(share_[v], kTaken * pair_share_[i] * before[v]);
            is_stale_[v] = 1;
            if (share_[v] >= least_share_[v])
                continue;
            least_share_[v] = std::max(1.0 - kLagMore * (1.0 - share_[v]), 0.0);
            is_marked_[v] = 1;
            has_marked_ = true;
        }
    }
    return any;
}

} // namespace toile
