#pragma once

#include <vector>

#include "core/pd/rigid/rigid_bodies.h"
#include "scenes/world/world.h"

namespace toile::scenes {

/// The rigid bodies of a running scene. Their ClothGroup moves them.
class SceneSolids {
public:
    /// @throws InvalidInput for an unusable mesh, naming solid or file.
    explicit SceneSolids(const Scene& scene);

    int count() const { return int(states_.size()); }
    const ClothState& state(int solid) const { return states_[solid]; } ///< at the start
    std::vector<Vec3> positions(int solid) const;                       ///< current [vertices] [m]

    RigidBodies& bodies() { return *bodies_; }
    const RigidBodies& bodies() const { return *bodies_; }

    /// Appends the triangles of all surfaces, with vertices numbered from first_vertex.
    void append_triangles(int first_vertex, std::vector<Triangle>& triangles) const;

private:
    std::vector<ClothState> states_;
    std::unique_ptr<RigidBodies> bodies_;
};

} // namespace toile::scenes
