#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collision/ccd/collision_free_step.h"

namespace toile::collision {

/// Start of a step in which bodies move as prescribed: carries cloth along, so that nothing crosses when the
/// bodies have arrived. From that pose on the bodies stand still, and CollisionFreeStep does the rest.
///
/// Cloth begins on the way that its caller expects of the nearest skin. Where a pair with a body would meet
/// before the end,
///   1. the cloth goes on with the body from that moment,
///   2. cloth that does so already is pushed off, along the direction at the time of contact, by little;
///   3. cloth that would now meet cloth is limited as in CollisionFreeStep.
/// Where this does not end in a few rounds, the motion is divided into two parts, each of which begins anew.
/// Where bodies close on the cloth between them from both sides, pairs are left in small parts; the caller
/// may release some of them. Those that are left in the smallest part are stuck.
///
/// Known relatives: IPC moves prescribed bodies as far as collisions let them and pulls them on by an
/// augmented Lagrangian [Li et al. 2020, section 5.3]. Here a body always arrives on time.
class CarriedStart {
public:
    using StuckPair = std::array<int, 4>; ///< NearPair::vertex

    /// Exempts some of the pairs that block bodies in a small part; the part is then tried again. Returns
    /// false if there are none that may be exempt. is_last: the part cannot be divided further.
    using Release = std::function<bool(View<const BlockedPair> blocked, bool is_last)>;

    /// @param search    finds the pairs of cloth and bodies, without exempt ones; borrowed
    /// @param edges     of cloth and bodies
    /// @param settings  with first_prescribed
    CarriedStart(CcdSearch& search, const SurfaceEdges& edges, const CollisionFreeStep::Settings& settings,
                 const RigidTrajectories& rigid);

    /// @param x      [vertices] pose at the start, without crossings; out: at the end [m]
    /// @param way    [first_prescribed] expected displacement of cloth [m]
    /// @param end    [vertices - first_prescribed] bodies at the end [m]
    /// @param fixed  [vertices] as in CollisionFreeStep::begin
    /// @param release  see Release
    void carry(View<Vec3> x, View<const Vec3> way, View<const Vec3> end, View<const unsigned char> fixed,
               const Release& release);

    const std::vector<StuckPair>& stuck() const { return stuck_; } ///< of the last carry()

private:
    void go(View<Vec3> x, double from, double to);
    enum class Part { kDone, kReleased, kBlocked };
    Part try_part(View<Vec3> x, double from, double to, bool may_release);
    void divert(const BlockedPair& blocked, View<const Vec3> x, double least_push);
    void push(const NearPair& pair, const Vec3& direction, double least);
    void change(int v, const Vec3& end);
    View<const BlockedPair> between_cloths(View<const BlockedPair> blocked);

    CcdSearch& search_;
    MinGap gap_;
    int first_prescribed_;
    TrajectoryLimiter limiter_;
    std::vector<StuckPair> stuck_;

    // Arguments of carry().
    View<const Vec3> way_, body_end_;
    std::vector<Vec3> body_start_; ///< [m]
    View<const unsigned char> fixed_;
    const Release* release_ = nullptr;

    // Of one part.
    std::vector<Vec3> end_;            ///< [vertices] [m]
    std::vector<unsigned char> rides_; ///< [vertices] 1: cloth that goes on with a body
    std::vector<double> pushed_;       ///< [vertices] sum of its pushes [m]
    VertexSet changed_;
    std::vector<BlockedPair> blocked_cloths_;
};

} // namespace toile::collision
