#pragma once

#include <algorithm>
#include <vector>

#include "collision/body/body_surfaces.h"
#include "collision/body/collider_pairs_kernels.h"
#include "collision/self/exempt_pairs.h"

namespace toile::collision {

/// Cloth between body parts that close on it until there is no room. It cannot stay outside both: the surface
/// that it is dressed on, its owner, keeps it, and surfaces that oppose the owner pass through it. They leave
/// as they came, and cloth that nothing crosses any more keeps off all surfaces again.
///
/// Where parts that overlap both wear cloth, such as the sleeve and the side of a shirt in an armpit, owners
/// cannot keep it either: each layer would have to be beyond the other. All surfaces pass there; owners only
/// push, and the layers meet in the middle of the overlap.
class LetThrough {
public:
    /// @param triangles  [triangles] of cloth
    /// @param room       distance between surfaces that leaves cloth no room [m]
    LetThrough(const BodySurfaces& bodies, View<const Triangle> triangles, int vertices, double room);

    /// Updates the owners at the start of a step, at x [vertices] [m].
    /// @param nearest  [vertices] surface nearest to each
    void begin_step(View<const Vec3> x, View<const NearestSurface> nearest);

    /// Lets surfaces that oppose their owners pass through these vertices. A patch most of which has owners
    /// on one side takes them for all of it; one with owners on both lets all surfaces pass, as do vertices
    /// that are blocked once more as a last resort. False if that changes nothing.
    bool release(View<const int> vertices, bool is_last_resort);

    /// Ends it for patches of cloth that no longer cross bodies.
    /// @param crossing  all triangles of cloth that cross bodies at the start of the step
    void close(View<const int> crossing);

    View<const int> neighbours(int v) const { return neighbours_[v]; } ///< once for each common triangle

    bool any() const { return count_ > 0; }
    int count() const { return count_; } ///< vertices
    int first() const
    {
        return int(std::find_if(released_.begin(), released_.end(), [](auto r) { return r != 0; }) -
                   released_.begin());
    }
    bool is_released(int v) const { return released_[v] != 0; }
    bool is_released(const Triangle& t) const
    {
        return is_released(t[0]) || is_released(t[1]) || is_released(t[2]);
    }
    View<const unsigned char> released() const { return released_; } ///< [vertices]
    View<const Vec3> owner_normal() const { return owner_normal_; }  ///< [vertices]
    /// [bodies] Unit normals at t1, evaluated at the first call after a motion.
    View<const Vec3> body_normal();
    /// True for a released vertex near its owner, with which it goes along.
    bool goes_with_owner(int v) const
    {
        return is_released(v) && bodies_.distance_to(owner_[v], x_[v] + owner_motion(v)) < room_;
    }
    /// Displacement in the step of the owner of a vertex, which has one [m].
    Vec3 owner_motion(int v) const { return bodies_.motion_of(owner_[v], x_[v]); }
    void forget();

private:
    void walk(int v, const Vec3& x, const NearestSurface& nearest);
    void agree(View<const int> patch);
    bool is_between(View<const int> patch) const;

    const BodySurfaces& bodies_;
    double room_;
    std::vector<Triangle> triangles_;
    std::vector<std::vector<int>> neighbours_; ///< [vertices]
    std::vector<NearestSurface> owner_;        ///< [vertices]
    std::vector<unsigned char> released_; ///< [vertices] 0: keeps off all surfaces; kLetsOpposing, kLetsAll
    std::vector<Vec3> x_;                 ///< [vertices] at the start of the step [m]
    std::vector<Vec3> owner_normal_, body_normal_;
    bool has_normals_ = false; ///< body_normal_ is that of this step
    int count_ = 0;
};

} // namespace toile::collision
