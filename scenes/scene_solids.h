#pragma once

#include <vector>

#include "core/pd/rigid_bodies.h"
#include "scenes/world.h"

namespace toile {

/// The surface of a solid where the scene puts it, closed and outward.
/// @throws InvalidInput for a mesh that does not work
TriangleMesh solid_mesh(const scene::Solid& solid);

/// The rigid bodies of a running scene. They are moved by the ClothGroup that they belong to.
class SceneSolids {
public:
    /// @throws InvalidInput for a mesh that does not work, naming solid or file.
    explicit SceneSolids(const Scene& scene);

    int count() const { return int(states_.size()); }
    const ClothState& state(int solid) const { return states_[solid]; } ///< at the start
    std::vector<Vec3> positions(int solid) const;                       ///< now [vertices] [m]

    RigidBodies& bodies() { return *bodies_; }
    const RigidBodies& bodies() const { return *bodies_; }

    /// Appends the triangles of all surfaces, whose vertices are numbered from first_vertex.
    void append_triangles(int first_vertex, std::vector<Triangle>& triangles) const;

private:
    std::vector<ClothState> states_;
    std::unique_ptr<RigidBodies> bodies_;
};

} // namespace toile
