#include "collision/cloth/safe_step.h"

#include <algorithm>
#include <iterator>

#include "collision/cloth/pair_geometry.h"
#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Part of an allowed share that is taken [-]: the shortened way is another one, whose own limit must not be
/// met again by rounding.
constexpr double kTaken = 0.95;

/// How much farther back than it is a vertex may fall before pairs are looked for again [-].
constexpr double kLagMore = 1.5;

/// How often the ends of ways are moved apart, in how many sweeps over the pairs each, and how much farther
/// than they have to be [-].
constexpr int kDeflections = 4;
constexpr int kSweeps = 3;
constexpr double kMoreThanLeast = 1.1;

/// Ways, of the largest deflection [-], below which cloth may as well be stopped: giving way, cloth at rest
/// would creep.
constexpr double kSlow = 0.5;

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
                     View<const unsigned char> fixed, View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    expected_ = expected;
    slack_ = slack;
    fixed_ = fixed;
    expected_pairs_ = pairs;
}

double SafeStep::limit(View<Vec3> x)
{
    const StageScope stage("collision/safe_step");
    way_.resize(x.size());
    for (int v = 0; v < x.size(); ++v)
        way_[v] = x[v] - base_[v];
    bodies_.begin(base_, way_);
    least_share_.assign(x.size(), 1.0);
    share_.assign(x.size(), 1.0);
    is_stale_.assign(x.size(), 1);
    is_marked_.assign(x.size(), 0);
    is_deflected_.assign(x.size(), 0);
    more_pairs_.clear();
    if (mark_strays(x))
        look_around_marked();
    if (pair_count() == 0)
        return 0.0;
    deflect();
    find_shares();

    double farthest = 0.0;
    for (int v = 0; v < x.size(); ++v) {
        if (share_[bodies_.leader_of(v)] == 1.0 && !is_deflected_[v])
            continue;
        const Vec3 wanted = x[v];
        x[v] = base_[v] + going_[v];
        farthest = std::max(farthest, (x[v] - wanted).norm());
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
        const bool strays = (x[v] - expected_[v]).squaredNorm() > slack_[v] * slack_[v];
        is_marked_[bodies_.leader_of(v)] |= strays;
        any = any || strays;
    }
    return any;
}

/// Adds the pairs of marked vertices, for the ways as they are, of which those that lag behind may go less.
void SafeStep::look_around_marked()
{
    const StageScope stage("collision/look_again");
    least_.resize(way_.size());
    for (size_t v = 0; v < way_.size(); ++v) {
        least_[v] = least_share_[bodies_.leader_of(v)] * way_[v];
        is_marked_[v] = is_marked_[bodies_.leader_of(v)];
    }
    near_.find(base_, {way_, least_, bodies_.bulge(), is_marked_},
               std::max(settings_.least_gap, settings_.least_share * settings_.thickness), found_pairs_);
    std::copy_if(found_pairs_.begin(), found_pairs_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
    std::fill(is_marked_.begin(), is_marked_.end(), 0);
    has_marked_ = false;
}

/// Ends with pair_share_ of the ways as they then are.
void SafeStep::deflect()
{
    go_shares();
    look_at_pairs();
    for (int round = 0; round < kDeflections && give_way(); ++round) {
        go_shares();
        look_around_marked();
        look_at_pairs();
    }
}

/// Moves the ends of ways apart where pairs are in each other's way, never so far that a pair parts. False
/// when none is.
bool SafeStep::give_way()
{
    std::fill(is_stale_.begin(), is_stale_.end(), 0);
    bool any = false;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (int i = 0; i < pair_count(); ++i) {
            if (pair_share_[i] >= 1.0)
                continue;
            const NearPair& pair = this->pair(i);
            std::array<Vec3, 4> end;
            double longest = 0.0;
            for (int k = 0; k < 4; ++k) {
                end[k] = base_[pair.vertex[k]] + way_[pair.vertex[k]];
                longest = std::max(longest, way_[pair.vertex[k]].norm());
            }
            const double kept = std::min(kMoreThanLeast * least_gap_of(pair), pair.distance);
            const double lacking = kept - gap_along(pair.normal, pair.is_edge_edge, end);
            const double ahead = mobility_of(pair, true), behind = mobility_of(pair, false);
            const bool is_small = lacking <= settings_.most_deflection;
            const bool is_slow = longest < kSlow * settings_.most_deflection;
            if (lacking <= 0.0 || !is_small || is_slow || ahead + behind == 0.0)
                continue;
            any = true;
            for (int k = 0; k < 4; ++k) {
                const int v = pair.vertex[k];
                if (!may_give_way(v))
                    continue;
                const double share = k < first_count(pair.is_edge_edge) ? ahead : -behind;
                way_[v] += share / (ahead + behind) * lacking * pair.normal;
                is_deflected_[v] = is_marked_[v] = is_stale_[v] = 1;
            }
        }
    return any;
}

/// 1; 0 where all of the side is held or rigid.
double SafeStep::mobility_of(const NearPair& pair, bool is_first_side) const
{
    const int split = first_count(pair.is_edge_edge);
    for (int k = is_first_side ? 0 : split; k < (is_first_side ? split : 4); ++k)
        if (may_give_way(pair.vertex[k]))
            return 1.0;
    return 0.0;
}

/// The share of its way that every vertex may go, from pair_share_, and the ways that come of it.
void SafeStep::find_shares()
{
    for (int round = 0; shorten(round >= kRounds); ++round) {
        go_shares();
        if (has_marked_)
            look_around_marked();
        look_at_pairs();
    }
}

/// The ways at the shares.
void SafeStep::go_shares()
{
    going_.resize(way_.size());
    for (size_t v = 0; v < way_.size(); ++v)
        going_[v] = share_[bodies_.leader_of(v)] * way_[v];
    bodies_.go(share_, going_);
}

void SafeStep::look_at_pairs()
{
    pair_share_.resize(pair_count(), 1.0);
    parallel_for(kCpu, "collision/safe_share", pair_count(), [&](int i) {
        const NearPair& pair = this->pair(i);
        std::array<Vec3, 4> x, move;
        bool is_stale = false;
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertex[k];
            is_stale = is_stale || is_stale_[bodies_.leader_of(v)];
            x[k] = base_[v];
            move[k] = going_[v];
        }
        if (!is_stale)
            return;
        const double least = least_gap_of(pair);
        pair_share_[i] =
            stays_apart(pair, x, move, least) ? 1.0 : safe_share(pair.is_edge_edge, x, move, least);
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
        for (const int corner : pair(i).vertex) {
            const int v = bodies_.leader_of(corner);
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
