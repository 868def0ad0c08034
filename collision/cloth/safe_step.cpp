#include "collision/cloth/safe_step.h"

#include <algorithm>

#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Part of an allowed share that is taken [-]: the shortened way is another one, whose own limit must not be
/// met again by rounding.
constexpr double kTaken = 0.95;

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

SafeStep::SafeStep(const Settings& settings, std::vector<int> rigid)
    : settings_(settings), rigid_(std::move(rigid))
{
    for (const int body : rigid_)
        body_count_ = std::max(body_count_, body + 1);
}

void SafeStep::begin(View<const Vec3> x, View<const Vec3> motion, View<const double> slack,
                     View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    expected_.resize(x.size());
    for (int v = 0; v < x.size(); ++v)
        expected_[v] = x[v] + motion[v];
    slack_ = slack;
    pairs_ = pairs;
}

double SafeStep::limit(View<Vec3> x)
{
    const StageScope stage("collision/safe_step");
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const bool was_far = keep_near_expectation(x);
    const bool was_shortened = !pairs_.empty() && find_shares(x);
    held_count_ = 0;
    if (!was_far && !was_shortened)
        return 0.0;

    double farthest = 0.0;
    for (int v = 0; v < x.size(); ++v) {
        if (was_shortened && share_[slot(v)] < 1.0)
            x[v] = base_[v] + share_[slot(v)] * (x[v] - base_[v]);
        const double held = (x[v] - wanted[v]).norm();
        held_count_ += held > 0.0 ? 1 : 0;
        farthest = std::max(farthest, held);
    }
    return farthest;
}

/// Of two layers that lie on each other a tenth of their distance is left; far ones may come that near too.
double SafeStep::least_gap_of(const NearPair& pair) const
{
    return std::max(settings_.least_gap,
                    settings_.least_share * std::min(pair.distance, settings_.thickness));
}

bool SafeStep::keep_near_expectation(View<Vec3> x)
{
    bool was_far = body_count_ > 0 && keep_bodies_near_expectation(x);
    for (int v = 0; v < x.size(); ++v) {
        if (is_rigid(v))
            continue;
        const Vec3 away = x[v] - expected_[v];
        const double distance = away.norm();
        if (distance <= slack_[v])
            continue;
        x[v] = expected_[v] + slack_[v] / distance * away;
        was_far = true;
    }
    return was_far;
}

/// True when a body was brought back, with all of its vertices in proportion.
bool SafeStep::keep_bodies_near_expectation(View<Vec3> x)
{
    std::vector<double> reach(body_count_, 1.0);
    for (int v = 0; v < x.size(); ++v)
        if (is_rigid(v))
            if (const double distance = (x[v] - expected_[v]).norm(); distance > slack_[v])
                reach[rigid_[v]] = std::min(reach[rigid_[v]], slack_[v] / distance);
    bool was_far = false;
    for (int v = 0; v < x.size(); ++v)
        if (is_rigid(v) && reach[rigid_[v]] < 1.0) {
            x[v] = expected_[v] + reach[rigid_[v]] * (x[v] - expected_[v]);
            was_far = true;
        }
    return was_far;
}

/// The share of the way to x that every vertex may go. False when all may go all of it.
bool SafeStep::find_shares(View<const Vec3> x)
{
    std::vector<Vec3> way(x.size());
    for (int v = 0; v < x.size(); ++v)
        way[v] = x[v] - base_[v];
    share_.assign(x.size() + body_count_, 1.0);
    is_stale_.assign(x.size() + body_count_, 1);
    pair_share_.assign(pairs_.size(), 1.0);
    bool was_shortened = false;
    for (int round = 0;; ++round) {
        look_at_pairs(way);
        if (!shorten(round >= kRounds))
            return was_shortened;
        was_shortened = true;
    }
}

void SafeStep::look_at_pairs(View<const Vec3> way)
{
    parallel_for(kCpu, "collision/safe_share", pairs_.size(), [&](int i) {
        const NearPair& pair = pairs_[i];
        pair_share_[i] = 1.0;
        std::array<Vec3, 4> x, move;
        bool is_stale = false;
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertex[k];
            is_stale = is_stale || is_stale_[slot(v)];
            x[k] = base_[v];
            move[k] = share_[slot(v)] * way[v];
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
    for (int i = 0; i < pairs_.size(); ++i) {
        if (pair_share_[i] >= 1.0)
            continue;
        any = true;
        for (const int v : pairs_[i].vertex) {
            const int s = slot(v);
            share_[s] = for_good ? 0.0 : std::min(share_[s], kTaken * pair_share_[i] * before[s]);
            is_stale_[s] = 1;
        }
    }
    return any;
}

} // namespace toile
