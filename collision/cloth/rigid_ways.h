#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// The rigid bodies among the vertices of a soup, and how each goes from one of its poses to another: its
/// middle straight on, turning evenly about it. Wherever it is stopped on the way it is rigid to rounding.
class RigidWays {
public:
    RigidWays() = default; ///< of no bodies

    /// @param rigid   [vertices] number of the rigid body, -1 for none
    /// @param weight  [bodies] against that of a vertex of cloth [-]
    RigidWays(const std::vector<int>& rigid, const std::vector<double>& weight);

    int count() const { return int(bodies_.size()); }
    int leader(int body) const { return bodies_[body].vertices.front(); } ///< its first vertex
    const std::vector<int>& vertices(int body) const { return bodies_[body].vertices; }
    double weight(int body) const { return bodies_[body].weight; }
    const Vec3& move(int body) const { return bodies_[body].move; } ///< of its middle, all the way [m]

    bool is_rigid(int v) const { return !leader_.empty() && leader_[v] >= 0; }

    /// The first vertex of v's body; of cloth v itself.
    int leader_of(int v) const { return is_rigid(v) ? leader_[v] : v; }

    /// @param x    [vertices] a pose [m]; borrowed until the next begin()
    /// @param way  [vertices] from there to another of every body [m]
    void begin(View<const Vec3> x, View<const Vec3> way);

    /// Displacements of one body where its middle goes only so far and turns by a share of its turn.
    /// @param motion  [vertices(body)] out [m]
    void go(int body, const Vec3& move, double share, std::vector<Vec3>& motion) const;

private:
    struct Body {
        std::vector<int> vertices;
        double weight = 0.0;
        Vec3 middle = Vec3::Zero(); ///< at the start, of the vertices [m]
        Vec3 move = Vec3::Zero();
        Vec3 turn = Vec3::Zero(); ///< rotation vector [rad]
    };

    std::vector<Body> bodies_;
    std::vector<int> leader_; ///< [vertices] -1 in cloth; or empty
    View<const Vec3> x_;
};

} // namespace toile
