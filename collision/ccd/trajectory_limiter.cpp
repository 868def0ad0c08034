#include "collision/ccd/trajectory_limiter.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "core/base/cancellation.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Part of an allowed fraction that is taken [-]. The shortened trajectory has another limit, which rounding
/// must not reach again.
constexpr double kTaken = 0.95;

/// Deflection: number of passes, sweeps over the pairs in each, and restored gap relative to the minimum gap
/// [-].
constexpr int kDeflections = 4;
constexpr int kSweeps = 3;
constexpr double kMinGapFactor = 1.1;

/// Missing distance, along the normal where a pair meets, up to which it is deflected, relative to the
/// longest displacement of one side as seen from the other [-]. What slides fast, as a body that blades stir,
/// comes farther into what it slides along. Were it not deflected it would stick there, with all of its zone,
/// while the rest of it moves on and is crushed.
constexpr double kDeflected = 0.25;

/// Displacement, relative to max_deflection [-], below which cloth is slow.
constexpr double kSlow = 0.5;

/// Length below which an edge is short, relative to max_deflection [-].
constexpr double kShortEdge = 0.2;

/// Largest deviation of a vertex that widens the search for its pairs, relative to max_deflection [-]: half a
/// mean edge, so that pairs are searched within a quarter of an edge. Wider searches are as many, and find
/// more pairs by the cube of edges.
constexpr double kMaxDeviation = 5.0;

/// Passes that limit the vertices of a pair or short edge in proportion. Vertices still blocked afterwards
/// move with their zone.
constexpr int kPasses = 16;

/// Trajectories of a pair's vertices.
class PairMotion {
public:
    PairMotion(const NearPair& pair, View<const Vec3> base, View<const Vec3> displacement)
        : is_edge_edge_(pair.is_edge_edge)
    {
        for (int k = 0; k < 4; ++k) {
            start_[k] = base[pair.vertex[k]];
            move_[k] = displacement[pair.vertex[k]];
        }
    }

    /// Smallest distance [m] of the sides' corners along n at the end.
    double end_gap(const Vec3& n) const { return gap_along(n, is_edge_edge_, at(1.0)); }

    /// Direction in which the sides are apart after a fraction of the motion.
    Vec3 normal_at(double fraction) const { return widest_direction(is_edge_edge_, at(fraction), move_).n; }

    /// Longest displacement of a vertex [m].
    double longest() const
    {
        double longest = 0.0;
        for (const Vec3& move : move_)
            longest = std::max(longest, move.norm());
        return longest;
    }

    /// Longest displacement of a vertex as seen from one of the other side [m].
    double relative() const
    {
        const int split = first_count(is_edge_edge_);
        double longest = 0.0;
        for (int i = 0; i < split; ++i)
            for (int k = split; k < 4; ++k)
                longest = std::max(longest, (move_[i] - move_[k]).norm());
        return longest;
    }

private:
    std::array<Vec3, 4> at(double fraction) const
    {
        std::array<Vec3, 4> x;
        for (int k = 0; k < 4; ++k)
            x[k] = start_[k] + fraction * move_[k];
        return x;
    }

    bool is_edge_edge_;
    std::array<Vec3, 4> start_, move_; ///< [m]
};

/// Edges of cloth.
std::vector<ShortEdges::Edge> flexible_edges(const SurfaceEdges& edges, const RigidTrajectories& bodies,
                                             int first_prescribed)
{
    std::vector<ShortEdges::Edge> flexible;
    std::copy_if(edges.vertex.begin(), edges.vertex.end(), std::back_inserter(flexible),
                 [&](const ShortEdges::Edge& edge) {
                     return edge[0] < first_prescribed && !bodies.is_rigid(edge[0]);
                 });
    return flexible;
}

} // namespace

TrajectoryLimiter::TrajectoryLimiter(const SurfaceEdges& edges, const Settings& settings,
                                     RigidTrajectories bodies)
    : settings_(settings), bodies_(std::move(bodies)),
      short_edges_(flexible_edges(edges, bodies_, settings.first_prescribed),
                   int(edges.corners_of_vertex.first.size()) - 1)
{
}

/// Displacement [m] below which cloth is stopped.
double TrajectoryLimiter::slow() const
{
    return settings_.stops_slow ? kSlow * settings_.max_deflection : 0.0;
}

void TrajectoryLimiter::begin(View<const Vec3> base, View<const unsigned char> fixed)
{
    base_ = base;
    fixed_ = fixed;
}

double TrajectoryLimiter::limit(View<Vec3> x, View<const unsigned char> supported, CcdQuery& query,
                                View<const BlockedPair> first)
{
    query_ = &query;
    blocked_ = first;
    start(x);
    deflect();
    find_fractions(supported);
    return finish(x);
}

void TrajectoryLimiter::start(View<const Vec3> x)
{
    displacement_.resize(x.size());
    motion_.resize(x.size());
    parallel_for(kCpu, "collision/displacements", x.size(),
                 [&](int v) { motion_[v] = displacement_[v] = x[v] - base_[v]; });
    for (VertexSet* set : {&deflected_, &moved_, &stale_, &fresh_})
        set->reset(x.size());
}

/// Writes the allowed positions of changed vertices. Returns the maximum correction [m].
double TrajectoryLimiter::finish(View<Vec3> x) const
{
    double max_move = 0.0;
    for (const int v : moved_.items()) {
        if (zones_.fraction(bodies_.leader_of(v)) == 1.0 && !deflected_.has(v))
            continue;
        const Vec3 wanted = x[v];
        x[v] = base_[v] + motion_[v];
        max_move = std::max(max_move, (x[v] - wanted).norm());
    }
    return max_move;
}

/// Passes changed trajectories to the query. Deflected vertices are likely to be deflected again.
void TrajectoryLimiter::update_query()
{
    Cancellation::check();
    changes_.clear();
    for (const int v : stale_.items()) {
        const double deviation = std::max((motion_[v] - displacement_[v]).norm(),
                                          deflected_.has(v) ? settings_.max_deflection : 0.0);
        changes_.push_back({v, motion_[v], std::min(deviation, kMaxDeviation * settings_.max_deflection)});
    }
    stale_.clear();
    blocked_ = query_->update(changes_);
}

/// Deflects blocked pairs. blocked_ belongs to the current displacements before and after.
void TrajectoryLimiter::deflect()
{
    for (int pass = 0; pass < kDeflections && separate_pairs(); ++pass) {
        for (const int v : stale_.items())
            motion_[v] = displacement_[v];
        update_query();
    }
}

/// Moves the ends of blocked pairs apart, never beyond a pair's start distance. False if none moves.
bool TrajectoryLimiter::separate_pairs()
{
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const BlockedPair& blocked : blocked_) {
            const NearPair& pair = blocked.pair;
            const PairMotion motion(pair, base_, displacement_);
            const double kept = std::min(kMinGapFactor * settings_.gap.of(pair), pair.distance);
            Vec3 normal = pair.normal;
            double lacking = kept - motion.end_gap(normal);
            bool is_small = lacking <= settings_.max_deflection;
            if (!is_small) {
                normal = motion.normal_at(blocked.fraction);
                lacking = kept - motion.end_gap(normal);
                is_small = lacking <= kDeflected * motion.relative();
            }
            // Against a body cloth slides on, however slowly.
            const bool is_slow = !is_with_body(pair, settings_.first_prescribed) && motion.longest() < slow();
            if (lacking > 0.0 && is_small && !is_slow)
                separate_pair(pair, lacking * normal);
        }
    return !stale_.is_empty();
}

/// @param apart  what the pair's sides are to be moved apart by [m]
void TrajectoryLimiter::separate_pair(const NearPair& pair, const Vec3& apart)
{
    const double ahead = mobility_of(pair, true), behind = mobility_of(pair, false);
    for (int k = 0; k < 4; ++k) {
        const int v = pair.vertex[k];
        if (!may_deflect(v))
            continue;
        const double mobility = k < first_count(pair.is_edge_edge) ? ahead : -behind;
        displacement_[v] += mobility / (ahead + behind) * apart;
        deflected_.add(v);
        moved_.add(v);
        stale_.add(v);
    }
}

/// Mobility of a side: 1, or 0 if all of it is fixed or rigid.
double TrajectoryLimiter::mobility_of(const NearPair& pair, bool is_first_side) const
{
    const int split = first_count(pair.is_edge_edge);
    for (int k = is_first_side ? 0 : split; k < (is_first_side ? split : 4); ++k)
        if (may_deflect(pair.vertex[k]))
            return 1.0;
    return 0.0;
}

/// Finds motion_ of all vertices from the blocked pairs.
void TrajectoryLimiter::find_fractions(View<const unsigned char> supported)
{
    using Support = ImpactZones::Support;
    support_.resize(displacement_.size());
    parallel_for(kCpu, "collision/support", int(displacement_.size()), [&](int v) {
        support_[v] = fixed_[v]                            ? Support::kFixed
                      : !supported.empty() && supported[v] ? Support::kSupported
                                                           : Support::kNone;
    });
    zones_.reset(displacement_, support_, slow());
    bodies_.begin(base_, displacement_);
    for (int body = 0; body < bodies_.count(); ++body)
        zones_.set_body(bodies_.leader(body), bodies_.move(body), bodies_.weight(body));
    short_edges_.begin(base_, kShortEdge * settings_.max_deflection);

    // Let the other ends of their short edges follow deflected vertices before pairs are limited.
    for (const int v : deflected_.items())
        fresh_.add(v);
    keep_short_edges();
    for (int pass = 0; !blocked_.empty(); ++pass) {
        shorten(pass >= kPasses);
        follow_zones();
        keep_short_edges();
    }
}

/// Joins the ends of short edges until none is overstretched. Then updates the query.
void TrajectoryLimiter::keep_short_edges()
{
    for (int sweep = 0; shorten_edges(sweep >= kPasses); ++sweep)
        follow_zones();
    if (!stale_.is_empty())
        update_query();
}

/// Joins and limits the vertices of blocked pairs.
void TrajectoryLimiter::shorten(bool for_good)
{
    for (const BlockedPair& blocked : blocked_) {
        const std::array<int, 4>& vertices = blocked.pair.vertex;
        const double fraction = for_good ? 0.0 : kTaken * blocked.fraction;
        for (const int v : vertices) {
            zones_.join(bodies_.leader_of(vertices[0]), bodies_.leader_of(v));
            zones_.limit_by(bodies_.leader_of(v), fraction);
        }
    }
}

/// Updates motion_ of vertices whose zone's displacement or whose fraction has changed.
void TrajectoryLimiter::follow_zones()
{
    const View<const int> changed = zones_.close_pass();
    for (const int v : changed)
        if (!bodies_.is_rigid(v))
            go(v, zones_.motion(v));
    for (int body = 0; body < bodies_.count(); ++body) {
        const int leader = bodies_.leader(body);
        const double fraction = zones_.fraction(leader);
        if (fraction == 1.0 || !zones_.has_changed(leader))
            continue;
        const Vec3 common = zones_.common(leader);
        const std::vector<int>& vertices = bodies_.vertices(body);
        bodies_.go(body, common + fraction * (bodies_.move(body) - common), fraction, body_motion_);
        for (size_t i = 0; i < vertices.size(); ++i)
            go(vertices[i], body_motion_[i]);
    }
}

void TrajectoryLimiter::go(int v, const Vec3& motion)
{
    if (motion_[v] == motion)
        return;
    motion_[v] = motion;
    for (VertexSet* set : {&moved_, &stale_, &fresh_})
        set->add(v);
}

/// Joins and limits the ends of overstretched short edges. False if there are none.
bool TrajectoryLimiter::shorten_edges(bool for_good)
{
    short_edges_.find_overstretched(fresh_.items(), motion_, overstretched_);
    fresh_.clear();
    for (const int e : overstretched_) {
        const auto [a, b] = short_edges_.edges()[e];
        const double fraction = for_good ? 0.0 : kTaken * short_edges_.fraction(e, motion_);
        zones_.join(a, b);
        zones_.limit_by(a, fraction);
        zones_.limit_by(b, fraction);
    }
    return !overstretched_.empty();
}

} // namespace toile::collision
