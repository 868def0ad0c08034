#include "collision/cloth/bring_back.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

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

/// Rounds in which the vertices of a pair or sliver are brought back in proportion. Those that are still in
/// the way then go where their zone does.
constexpr int kRounds = 16;

/// Those of cloth.
std::vector<Tethers::Edge> flexible_edges(const SurfaceEdges& edges, const RigidWays& bodies)
{
    std::vector<Tethers::Edge> flexible;
    std::copy_if(edges.vertex.begin(), edges.vertex.end(), std::back_inserter(flexible),
                 [&](const Tethers::Edge& edge) { return !bodies.is_rigid(edge[0]); });
    return flexible;
}

} // namespace

BringBack::BringBack(const SurfaceEdges& edges, const Settings& settings, RigidWays bodies)
    : settings_(settings), bodies_(std::move(bodies)),
      tethers_(flexible_edges(edges, bodies_), int(edges.corners_of_vertex.first.size()) - 1)
{
}

void BringBack::begin(View<const Vec3> base, View<const unsigned char> fixed)
{
    base_ = base;
    fixed_ = fixed;
}

double BringBack::limit(View<Vec3> x, View<const unsigned char> leans, PairWatch& watch,
                        View<const BlockedPair> first)
{
    watch_ = &watch;
    in_the_way_ = first;
    start(x);
    deflect();
    find_shares(leans);
    return finish(x);
}

void BringBack::start(View<const Vec3> x)
{
    way_.resize(x.size());
    motion_.resize(x.size());
    parallel_for(kCpu, "collision/ways", x.size(), [&](int v) { motion_[v] = way_[v] = x[v] - base_[v]; });
    for (VertexSet* set : {&deflected_, &moved_, &stale_, &fresh_})
        set->reset(x.size());
}

/// Those that were moved, to where they may go.
double BringBack::finish(View<Vec3> x) const
{
    double farthest = 0.0;
    for (const int v : moved_.items()) {
        if (zones_.share(bodies_.leader_of(v)) == 1.0 && !deflected_.has(v))
            continue;
        const Vec3 wanted = x[v];
        x[v] = base_[v] + motion_[v];
        farthest = std::max(farthest, (x[v] - wanted).norm());
    }
    return farthest;
}

/// Tells the watch who has changed. What gives way is likely to do so again.
void BringBack::look()
{
    changes_.clear();
    for (const int v : stale_.items())
        changes_.push_back(
            {v, motion_[v],
             std::max((motion_[v] - way_[v]).norm(), deflected_.has(v) ? settings_.most_deflection : 0.0)});
    stale_.clear();
    in_the_way_ = watch_->look(changes_);
}

/// Begins and ends with what is in the way of the ways as they then are.
void BringBack::deflect()
{
    for (int round = 0; round < kDeflections && give_way(); ++round) {
        for (const int v : stale_.items())
            motion_[v] = way_[v];
        look();
    }
}

/// Moves the ends of ways apart where pairs are in each other's way, never so far that a pair parts. False
/// when none is.
bool BringBack::give_way()
{
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const BlockedPair& blocked : in_the_way_) {
            const NearPair& pair = blocked.pair;
            std::array<Vec3, 4> end;
            double longest = 0.0;
            for (int k = 0; k < 4; ++k) {
                end[k] = base_[pair.vertex[k]] + way_[pair.vertex[k]];
                longest = std::max(longest, way_[pair.vertex[k]].norm());
            }
            const double kept = std::min(kMoreThanLeast * settings_.gap.of(pair), pair.distance);
            const double lacking = kept - gap_along(pair.normal, pair.is_edge_edge, end);
            const bool is_small = lacking <= settings_.most_deflection;
            const bool is_slow = longest < kSlow * settings_.most_deflection;
            if (lacking > 0.0 && is_small && !is_slow)
                give_way_at(pair, lacking);
        }
    return !stale_.is_empty();
}

void BringBack::give_way_at(const NearPair& pair, double lacking)
{
    const double ahead = mobility_of(pair, true), behind = mobility_of(pair, false);
    for (int k = 0; k < 4; ++k) {
        const int v = pair.vertex[k];
        if (!may_give_way(v))
            continue;
        const double share = k < first_count(pair.is_edge_edge) ? ahead : -behind;
        way_[v] += share / (ahead + behind) * lacking * pair.normal;
        deflected_.add(v);
        moved_.add(v);
        stale_.add(v);
    }
}

/// 1; 0 where all of the side is held or rigid.
double BringBack::mobility_of(const NearPair& pair, bool is_first_side) const
{
    const int split = first_count(pair.is_edge_edge);
    for (int k = is_first_side ? 0 : split; k < (is_first_side ? split : 4); ++k)
        if (may_give_way(pair.vertex[k]))
            return 1.0;
    return 0.0;
}

/// motion_ of all vertices, from what is in the way.
void BringBack::find_shares(View<const unsigned char> leans)
{
    using Hold = ImpactZones::Hold;
    hold_.resize(way_.size());
    parallel_for(kCpu, "collision/holds", int(way_.size()), [&](int v) {
        hold_[v] = fixed_[v] ? Hold::kIsHeld : !leans.empty() && leans[v] ? Hold::kLeans : Hold::kNone;
    });
    zones_.reset(way_, hold_, kSlow * settings_.most_deflection);
    bodies_.begin(base_, way_);
    for (int body = 0; body < bodies_.count(); ++body)
        zones_.set_body(bodies_.leader(body), bodies_.move(body), bodies_.weight(body));
    tethers_.begin(base_, way_, kTethered * settings_.most_deflection);

    // What gave way takes the other ends of its slivers along, before it is asked who is in the way still.
    for (const int v : deflected_.items())
        fresh_.add(v);
    take_along();
    for (int round = 0; !in_the_way_.empty(); ++round) {
        shorten(round >= kRounds);
        follow_zones();
        take_along();
    }
}

/// Brings the ends of torn edges together until none is torn and every zone goes where its vertices let it,
/// and looks at the pairs of what has changed.
void BringBack::take_along()
{
    for (int sweep = 0; hold_together(sweep >= kRounds) || zones_.settle(); ++sweep)
        follow_zones();
    if (!stale_.is_empty())
        look();
}

/// Brings the vertices of pairs in each other's way together.
void BringBack::shorten(bool for_good)
{
    for (const BlockedPair& blocked : in_the_way_) {
        const std::array<int, 4>& vertices = blocked.pair.vertex;
        const double share = for_good ? 0.0 : kTaken * blocked.share;
        for (const int v : vertices) {
            zones_.join(bodies_.leader_of(vertices[0]), bodies_.leader_of(v));
            zones_.bring_back(bodies_.leader_of(v), share);
        }
    }
}

/// Of vertices whose zone goes elsewhere or who are brought back farther.
void BringBack::follow_zones()
{
    const View<const int> changed = zones_.close_round();
    for (const int v : changed)
        if (!bodies_.is_rigid(v))
            go(v, zones_.motion(v));
    for (int body = 0; body < bodies_.count(); ++body) {
        const int leader = bodies_.leader(body);
        const double share = zones_.share(leader);
        if (share == 1.0 || !zones_.has_changed(leader))
            continue;
        const Vec3 common = zones_.common(leader);
        const std::vector<int>& vertices = bodies_.vertices(body);
        bodies_.go(body, common + share * (bodies_.move(body) - common), share, body_motion_);
        for (size_t i = 0; i < vertices.size(); ++i)
            go(vertices[i], body_motion_[i]);
    }
}

void BringBack::go(int v, const Vec3& motion)
{
    if (motion_[v] == motion)
        return;
    motion_[v] = motion;
    for (VertexSet* set : {&moved_, &stale_, &fresh_})
        set->add(v);
}

/// Brings the ends of torn edges together. False when there are none. Cloth on bodies takes nothing along and
/// is not taken, slivers apart: zones that reach from one leg to the other would draw it through both.
bool BringBack::hold_together(bool for_good)
{
    tethers_.find_torn(fresh_.items(), motion_, torn_);
    fresh_.clear();
    bool any = false;
    for (const int e : torn_) {
        const auto [a, b] = tethers_.edges()[e];
        if (tethers_.is_sliver(e)) {
            const double share = for_good ? 0.0 : kTaken * tethers_.share(e, motion_);
            zones_.join(a, b);
            zones_.bring_back(a, share);
            zones_.bring_back(b, share);
            any = true;
        } else if (!zones_.leans(a) && !zones_.leans(b)) {
            hold_behind(e);
            any = true;
        }
    }
    return any;
}

/// The end of a torn edge that goes on farther with its zone joins the other's and keeps of its own way what
/// the edge lets it. The rest of the slack is for the next edge: what is stopped takes along as many rings of
/// edges as it takes for each to give in a little.
void BringBack::hold_behind(int edge)
{
    const auto [a, b] = tethers_.edges()[edge];
    zones_.attach(a, b);
    const auto [lead, last] = zones_.share(a) <= zones_.share(b) ? std::pair(a, b) : std::pair(b, a);
    const double least = zones_.share(lead);
    const double share = tethers_.share_behind(edge, last, zones_.common(lead), least);
    zones_.bring_back_to(last, least + kTaken * (share - least));
}

} // namespace toile
