#include "collision/cloth/safe_step.h"

#include <algorithm>
#include <iterator>

#include "collision/cloth/safe_step_kernels.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Part of an allowed share that is taken [-]: the shortened way is another one, whose own limit must not be
/// met again by rounding.
constexpr double kTaken = 0.95;

/// How often the ends of ways are moved apart, in how many sweeps over the pairs each, and how much farther
/// than they have to be [-].
constexpr int kDeflections = 4;
constexpr int kSweeps = 3;
constexpr double kMoreThanLeast = 1.1;

/// Ways, of the largest deflection [-], below which cloth may as well be stopped: giving way or taken along
/// by its zone, cloth at rest would creep.
constexpr double kSlow = 0.5;

/// How much longer than wanted an edge may get where one end is brought back, of the largest deflection [-].
constexpr double kTethered = 0.2;

/// Rounds in which the vertices of a pair or edge are brought back in proportion. Those that are still in the
/// way then go where their zone does.
constexpr int kRounds = 16;

/// Appends the numbers in [0, count) of which `is_one` is true, ascending.
template <typename IsOne>
void list_where(std::string_view name, int count, const IsOne& is_one, std::vector<int>& out)
{
    parallel_append(
        kCpu, name, count,
        [&](int begin, int end, std::vector<int>& found) {
            for (int i = begin; i < end; ++i)
                if (is_one(i))
                    found.push_back(i);
        },
        out);
}

/// Those of cloth.
std::vector<Tethers::Edge> flexible_edges(const SurfaceEdges& edges, const RigidWays& bodies)
{
    std::vector<Tethers::Edge> flexible;
    std::copy_if(edges.vertex.begin(), edges.vertex.end(), std::back_inserter(flexible),
                 [&](const Tethers::Edge& edge) { return !bodies.is_rigid(edge[0]); });
    return flexible;
}

} // namespace

SafeStep::SafeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings, RigidWays bodies)
    : near_(near), exempt_(exempt), settings_(settings), bodies_(std::move(bodies)),
      tethers_(flexible_edges(near.edges(), bodies_))
{
}

void SafeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                     View<const unsigned char> fixed, View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    slack_ = slack;
    fixed_ = fixed;
    expected_pairs_ = pairs;
    more_pairs_.clear();
    known_radius_.resize(x.size());
    known_motion_.resize(x.size());
    parallel_for(kCpu, "collision/know_expected", x.size(), KnowExpected{x, expected, slack, known()});
}

double SafeStep::limit(View<Vec3> x, View<const unsigned char> leans)
{
    const StageScope stage("collision/safe_step");
    way_.resize(x.size());
    motion_.resize(x.size());
    parallel_for(kCpu, "collision/ways", x.size(), [&](int v) { motion_[v] = way_[v] = x[v] - base_[v]; });
    is_stale_.assign(x.size(), 1);
    is_deflected_.assign(x.size(), 0);
    if (mark_strays())
        look_around_marked();
    look_at_pairs();
    if (in_the_way_.empty())
        return 0.0;
    deflect();
    find_shares(leans);

    double farthest = 0.0;
    for (int v = 0; v < x.size(); ++v) {
        if (zones_.share(bodies_.leader_of(v)) == 1.0 && !is_deflected_[v])
            continue;
        const Vec3 wanted = x[v];
        x[v] = base_[v] + motion_[v];
        farthest = std::max(farthest, (x[v] - wanted).norm());
    }
    return farthest;
}

/// Marks whose motion is none that the lists are complete for. False when all are.
bool SafeStep::mark_strays()
{
    is_marked_.resize(motion_.size());
    return parallel_sum(kCpu, int(motion_.size()), 0, [&](int v) {
               is_marked_[v] = !known().hold(v, motion_[v]);
               return int(is_marked_[v]);
           }) > 0;
}

/// Adds the pairs of marked vertices.
void SafeStep::look_around_marked()
{
    const StageScope stage("collision/look_again");
    for (size_t v = 0; v < motion_.size(); ++v)
        if (is_marked_[v])
            known().widen(int(v), motion_[v], (motion_[v] - way_[v]).norm(), slack_[int(v)]);
    near_.find(base_, {known_motion_, known_radius_, is_marked_}, least_gap().most(), found_pairs_);
    std::copy_if(found_pairs_.begin(), found_pairs_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
}

/// Begins and ends with pair_share_ of the ways as they then are.
void SafeStep::deflect()
{
    for (int round = 0; round < kDeflections && give_way(); ++round) {
        motion_ = way_;
        if (mark_strays())
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
        for (const int i : in_the_way_) {
            const NearPair& pair = this->pair(i);
            std::array<Vec3, 4> end;
            double longest = 0.0;
            for (int k = 0; k < 4; ++k) {
                end[k] = base_[pair.vertex[k]] + way_[pair.vertex[k]];
                longest = std::max(longest, way_[pair.vertex[k]].norm());
            }
            const double kept = std::min(kMoreThanLeast * least_gap().of(pair), pair.distance);
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
                is_deflected_[v] = is_stale_[v] = 1;
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

/// motion_ of all vertices, from pair_share_.
void SafeStep::find_shares(View<const unsigned char> leans)
{
    std::vector<ImpactZones::Hold> hold(way_.size());
    for (int v = 0; v < int(way_.size()); ++v)
        hold[v] = fixed_[v]                    ? ImpactZones::Hold::kIsHeld
                  : !leans.empty() && leans[v] ? ImpactZones::Hold::kLeans
                                               : ImpactZones::Hold::kNone;
    zones_.reset(way_, hold, kSlow * settings_.most_deflection);
    bodies_.begin(base_, way_);
    for (int body = 0; body < bodies_.count(); ++body)
        zones_.set_body(bodies_.leader(body), bodies_.move(body), bodies_.weight(body));
    tethers_.begin(base_, way_, kTethered * settings_.most_deflection);
    // What gave way takes the other ends of its slivers along, before it is asked who is in the way still.
    is_stale_ = is_deflected_;
    take_along();
    for (int round = 0; shorten(round >= kRounds); ++round) {
        std::fill(is_stale_.begin(), is_stale_.end(), 0);
        follow_zones();
        take_along();
    }
}

/// Brings the ends of torn edges together until none is torn, and looks at the pairs of what has changed.
void SafeStep::take_along()
{
    for (int sweep = 0; hold_together(sweep >= kRounds); ++sweep)
        follow_zones();
    if (mark_strays())
        look_around_marked();
    look_at_pairs();
}

void SafeStep::look_at_pairs()
{
    pair_share_.resize(pair_count(), 1.0);
    const PairShare share{base_, motion_, least_gap()};
    parallel_for(kCpu, "collision/safe_share", pair_count(), [&](int i) {
        const NearPair& pair = this->pair(i);
        const std::array<int, 4>& v = pair.vertex;
        if (is_stale_[v[0]] || is_stale_[v[1]] || is_stale_[v[2]] || is_stale_[v[3]])
            pair_share_[i] = share(pair);
    });
    in_the_way_.clear();
    list_where(
        "collision/in_the_way", pair_count(), [&](int i) { return pair_share_[i] < 1.0; }, in_the_way_);
}

/// Brings the vertices of pairs in each other's way together. False when there are none.
bool SafeStep::shorten(bool for_good)
{
    for (const int i : in_the_way_) {
        const double share = for_good ? 0.0 : kTaken * pair_share_[i];
        for (const int v : pair(i).vertex) {
            zones_.join(bodies_.leader_of(pair(i).vertex[0]), bodies_.leader_of(v));
            zones_.bring_back(bodies_.leader_of(v), share);
        }
    }
    return !in_the_way_.empty();
}

/// Of vertices whose zone has grown or who are brought back farther.
void SafeStep::follow_zones()
{
    zones_.close_round();
    const std::vector<Vec3> before = bodies_.count() > 0 ? motion_ : std::vector<Vec3>();
    parallel_for(kCpu, "collision/follow_zones", int(motion_.size()), [&](int v) {
        if (bodies_.is_rigid(v))
            return;
        const Vec3 now = zones_.motion(v);
        is_stale_[v] = is_stale_[v] || motion_[v] != now;
        motion_[v] = now;
    });
    for (int body = 0; body < bodies_.count(); ++body) {
        const int leader = bodies_.leader(body);
        const double share = zones_.share(leader);
        const Vec3 common = zones_.common(leader);
        if (share < 1.0)
            bodies_.go(body, common + share * (bodies_.move(body) - common), share, motion_);
    }
    for (size_t v = 0; v < before.size(); ++v)
        is_stale_[v] = is_stale_[v] || motion_[v] != before[v];
}

/// Brings the ends of torn edges together. False when there are none. Cloth on bodies takes nothing along and
/// is not taken, slivers apart: zones that reach from one leg to the other would draw it through both.
bool SafeStep::hold_together(bool for_good)
{
    torn_.clear();
    list_where(
        "collision/torn_edges", int(tethers_.edges().size()),
        [&](int e) {
            const auto [a, b] = tethers_.edges()[e];
            return (is_stale_[a] || is_stale_[b]) && tethers_.is_torn(e, motion_);
        },
        torn_);
    bool any = false;
    for (const int e : torn_) {
        const auto [a, b] = tethers_.edges()[e];
        if (!tethers_.is_sliver(e) && (zones_.leans(a) || zones_.leans(b)))
            continue;
        any = true;
        const double share = for_good ? 0.0 : kTaken * tethers_.share(e, motion_);
        zones_.join(a, b);
        zones_.bring_back(a, share);
        zones_.bring_back(b, share);
    }
    return any;
}

} // namespace toile
