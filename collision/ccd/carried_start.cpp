#include "collision/ccd/carried_start.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/stages.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Rounds of a part; parts of the motion from which on pairs are released, and the smallest [-].
constexpr int kRounds = 8;
constexpr double kReleasing = 1.0 / 4.0, kSmallestPart = 1.0 / 16.0;

/// Releases in one part: each lets bodies through one more ring of cloth.
constexpr int kReleases = 8;

/// Part of the motion up to a contact that cloth makes before it goes along [-]. Rounding must not meet it
/// again.
constexpr double kTaken = 0.95;

/// Gap that a push restores, relative to the minimum gap [-]; bounds of a push and of all pushes of a vertex
/// in a part [m]. Unbounded, cloth between two bodies would be shot out.
constexpr double kRestoredGap = 1.1;
constexpr double kMaxPush = 0.002, kMaxPushed = 0.01;

/// Least push, relative to the minimum gap [-], where all pairs that are left end at the gap to be restored:
/// they come too near on their way, as edges that turn do.
constexpr double kLeastPush = 0.25;

/// Hides pairs with bodies, which the limiter could only answer by stopping the bodies.
class ClothQuery : public CcdQuery {
public:
    using Filter = std::function<View<const BlockedPair>(View<const BlockedPair>)>;
    ClothQuery(CcdQuery& all, Filter filter) : all_(all), filter_(std::move(filter)) {}
    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override
    {
        return filter_(all_.update(changed));
    }

private:
    CcdQuery& all_;
    Filter filter_;
};

} // namespace

CarriedStart::CarriedStart(CcdSearch& search, const SurfaceEdges& edges,
                           const CollisionFreeStep::Settings& settings, const RigidTrajectories& rigid)
    : search_(search), gap_(settings.gap()), first_prescribed_(settings.first_prescribed),
      limiter_(edges, {settings.gap(), settings.max_deflection, settings.first_prescribed, false}, rigid)
{
}

void CarriedStart::carry(View<Vec3> x, View<const Vec3> way, View<const Vec3> end,
                         View<const unsigned char> fixed, const Release& release)
{
    const StageScope stage("collision/carry");
    way_ = way;
    body_end_ = end;
    body_start_.assign(x.begin() + first_prescribed_, x.end());
    fixed_ = fixed;
    release_ = &release;
    stuck_.clear();
    go(x, 0.0, 1.0);
}

/// Moves x from one fraction of the bodies' motion to another.
void CarriedStart::go(View<Vec3> x, double from, double to)
{
    const int releases = to - from <= kReleasing ? kReleases : 0;
    Part part = Part::kReleased;
    for (int k = 0; k <= releases && part == Part::kReleased; ++k)
        part = try_part(x, from, to, k < releases);
    if (part == Part::kDone)
        return;
    const double middle = 0.5 * (from + to);
    go(x, from, middle);
    go(x, middle, to);
}

/// Not done if pairs are left and the part can be divided or tried again: x is then unchanged.
CarriedStart::Part CarriedStart::try_part(View<Vec3> x, double from, double to, bool may_release)
{
    end_.resize(x.size());
    parallel_for(kCpu, "collision/expect", x.size(), [&](int v) {
        if (v < first_prescribed_) {
            end_[v] = x[v] + (to - from) * way_[v];
        } else {
            const int b = v - first_prescribed_;
            end_[v] = to == 1.0 ? body_end_[b] : Vec3(body_start_[b] + to * (body_end_[b] - body_start_[b]));
        }
    });
    View<const BlockedPair> blocked = search_.begin(x, end_);
    if (!blocked.empty()) {
        limiter_.begin(x, fixed_);
        rides_.assign(x.size(), 0);
        pushed_.assign(x.size(), 0.0);
        changed_.reset(x.size());
    }
    for (int round = 0; round < kRounds && !blocked.empty(); ++round) {
        const std::vector<BlockedPair> now(blocked.begin(), blocked.end());
        const auto divert_all = [&](double least_push) {
            for (const BlockedPair& pair : now)
                if (is_with_body(pair.pair, first_prescribed_))
                    divert(pair, x, least_push);
        };
        divert_all(0.0);
        if (changed_.items().empty())
            divert_all(kLeastPush);
        std::vector<ChangedTrajectory> changes;
        for (const int v : changed_.items())
            changes.push_back({v, end_[v] - x[v], 0.0});
        changed_.clear();
        blocked = search_.update(changes);
        ClothQuery cloths(search_, [this](View<const BlockedPair> all) { return between_cloths(all); });
        if (const auto first = between_cloths(blocked); !first.empty()) {
            limiter_.limit(end_, rides_, cloths, first);
            blocked = search_.query_all(end_);
        }
    }
    if (!blocked.empty() && may_release && (*release_)(blocked, to - from <= kSmallestPart))
        return Part::kReleased;
    if (!blocked.empty() && to - from > kSmallestPart)
        return Part::kBlocked;
    for (const BlockedPair& left : blocked)
        stuck_.push_back(left.pair.vertex);
    parallel_for(kCpu, "collision/go", x.size(), [&](int v) { x[v] = end_[v]; });
    return Part::kDone;
}

View<const BlockedPair> CarriedStart::between_cloths(View<const BlockedPair> blocked)
{
    blocked_cloths_.clear();
    std::copy_if(blocked.begin(), blocked.end(), std::back_inserter(blocked_cloths_),
                 [&](const BlockedPair& pair) { return !is_with_body(pair.pair, first_prescribed_); });
    return blocked_cloths_;
}

void CarriedStart::change(int v, const Vec3& end)
{
    end_[v] = end;
    changed_.add(v);
}

/// Lets the cloth of a pair go on with the body from the time of contact. If it does so already, pushes it.
/// @param least_push  see kLeastPush
void CarriedStart::divert(const BlockedPair& blocked, View<const Vec3> x, double least_push)
{
    const NearPair& pair = blocked.pair;
    std::array<Vec3, 4> at;
    for (int k = 0; k < 4; ++k)
        at[k] = x[pair.vertex[k]] + blocked.fraction * (end_[pair.vertex[k]] - x[pair.vertex[k]]);
    const std::array<double, 4> weight = closest_weights(pair.is_edge_edge, at);
    Vec3 of_body = Vec3::Zero();
    bool rides = true;
    for (int k = 0; k < 4; ++k) {
        const int v = pair.vertex[k];
        if (v >= first_prescribed_)
            of_body += std::fabs(weight[k]) * (end_[v] - x[v]);
        else
            rides = rides && rides_[v] != 0;
    }
    if (rides) {
        push(pair, separating_direction(pair.is_edge_edge, at, weight, closest_difference(weight, at)),
             least_push * gap_.of(pair));
        return;
    }
    const double kept = kTaken * blocked.fraction;
    for (const int v : pair.vertex)
        if (v < first_prescribed_ && rides_[v] == 0) {
            rides_[v] = 1;
            change(v, x[v] + kept * (end_[v] - x[v]) + (1.0 - kept) * of_body);
        }
}

/// @param direction  from the pair's second primitive to its first, unit
/// @param least      [m]
void CarriedStart::push(const NearPair& pair, const Vec3& direction, double least)
{
    std::array<Vec3, 4> end;
    for (int k = 0; k < 4; ++k)
        end[k] = end_[pair.vertex[k]];
    const double kept = std::min(kRestoredGap * gap_.of(pair), pair.distance);
    const double lacking =
        std::min(std::max(kept - gap_along(direction, pair.is_edge_edge, end), least), kMaxPush);
    if (!(lacking > 0.0))
        return;
    const double side = pair.vertex[0] < first_prescribed_ ? 1.0 : -1.0;
    for (const int v : pair.vertex)
        if (v < first_prescribed_ && pushed_[v] + lacking <= kMaxPushed) {
            pushed_[v] += lacking;
            change(v, end_[v] + side * lacking * direction);
        }
}

} // namespace toile::collision
