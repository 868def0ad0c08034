#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// The rigid bodies among the vertices of a soup, and how each goes from one of its poses to another: its
/// middle straight on, turning evenly about it. At any share of that way it is rigid to rounding.
class RigidWays {
public:
    /// @param rigid  [vertices] number of the rigid body, -1 for none; empty: no such bodies
    explicit RigidWays(const std::vector<int>& rigid);

    bool empty() const { return bodies_.empty(); }
    bool is_rigid(int v) const { return !leader_.empty() && leader_[v] >= 0; }

    /// The first vertex of the body; of cloth the vertex itself.
    int leader_of(int v) const { return is_rigid(v) ? leader_[v] : v; }

    /// @param x    [vertices] a pose [m]; borrowed until the next begin()
    /// @param way  [vertices] from there to another of every body [m]
    void begin(View<const Vec3> x, View<const Vec3> way);

    /// Replaces the displacements of bodies that do not go all of their way.
    /// @param share  [vertices] of the way, looked up for leaders [-]
    /// @param going  [vertices] out [m]
    void go(View<const double> share, View<Vec3> going) const;

    /// [vertices] how far beside the straight way to its end a vertex may come on the way [m]; 0 in cloth
    View<const double> bulge() const { return bulge_; }

private:
    struct Body {
        std::vector<int> vertices;
        Vec3 middle = Vec3::Zero(); ///< at the start [m]
        Vec3 move = Vec3::Zero();   ///< of the middle [m]
        Vec3 turn = Vec3::Zero();   ///< rotation vector [rad]
    };

    std::vector<Body> bodies_;
    std::vector<int> leader_; ///< [vertices] -1 in cloth; or empty
    View<const Vec3> x_;
    std::vector<double> bulge_;
};

} // namespace toile
