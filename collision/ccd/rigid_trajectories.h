#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Trajectories of the rigid bodies of a soup between two poses. The middle moves straight, and the rotation
/// about it is uniform. Every pose in between is rigid to rounding.
class RigidTrajectories {
public:
    RigidTrajectories() = default; ///< of no bodies

    /// @param rigid   [vertices] number of the rigid body, -1 for none
    /// @param weight  [bodies] relative to a vertex of cloth [-]
    RigidTrajectories(const std::vector<int>& rigid, const std::vector<double>& weight);

    int count() const { return int(bodies_.size()); }
    int leader(int body) const { return bodies_[body].vertices.front(); } ///< its first vertex
    const std::vector<int>& vertices(int body) const { return bodies_[body].vertices; }
    double weight(int body) const { return bodies_[body].weight; }
    const Vec3& move(int body) const { return bodies_[body].move; } ///< total displacement of its middle [m]

    bool is_rigid(int v) const { return v < int(leader_.size()) && leader_[v] >= 0; }

    /// First vertex of v's body; v itself in cloth.
    int leader_of(int v) const { return is_rigid(v) ? leader_[v] : v; }

    /// @param x    [vertices] start pose [m]; borrowed until the next begin()
    /// @param displacement  [vertices] displacement of every body to its second pose [m]
    void begin(View<const Vec3> x, View<const Vec3> displacement);

    /// Displacements of the vertices of a body whose middle moves by `move` [m] and that rotates by a
    /// fraction of its rotation.
    /// @param motion  [vertices(body)] out [m]
    void go(int body, const Vec3& move, double fraction, std::vector<Vec3>& motion) const;

private:
    struct Body {
        std::vector<int> vertices;
        double weight = 0.0;
        Vec3 middle = Vec3::Zero(); ///< mean of the vertices at the start [m]
        Vec3 move = Vec3::Zero();
        Vec3 rotation = Vec3::Zero(); ///< rotation vector [rad]
    };

    std::vector<Body> bodies_;
    std::vector<int> leader_; ///< [vertices] -1 in cloth; shorter if none follows
    View<const Vec3> x_;
};

} // namespace toile::collision
