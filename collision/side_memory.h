#pragma once

#include <vector>

#include "collision/clearance.h"
#include "collision/side_rules.h"

namespace toile {

/// Which sheets of moving meshes each cloth vertex is in front of. Where body parts close on cloth until they
/// overlap, the vertex is behind several sheets at once and the nearest surface says nothing about where it
/// belongs: what it was in front of before does.
class SideMemory {
public:
    explicit SideMemory(int vertex_count) : sides_(size_t(vertex_count)) {}

    void forget() { std::fill(sides_.begin(), sides_.end(), VertexSides{}); }

    /// Learns at the end of a step. A sheet that the vertex is behind by now is kept; new ones are those it
    /// is in front of. A query or two for each vertex near the mesh; none for a mesh that never moved.
    /// @param x          [vertices] cloth at t1 [m]
    /// @param collider   number of the mesh
    /// @param clearance  of x above it
    void learn(View<const Vec3> x, const MeshCollider& mesh, int collider, const Clearance& clearance);

    /// The places of the remembered sheets of a mesh at t1 that x, vertex v of the cloth, is behind, but for
    /// sheets that moved faster than `farthest` [m] in the step: those were replaced. Replaces the content of
    /// out.
    void find_behind(int v, const Vec3& x, const MeshCollider& mesh, int collider, double farthest,
                     std::vector<SurfacePoint>& out) const;

private:
    VertexSides learnt(int v, const Vec3& x, const MeshCollider& mesh, int collider, int hint) const;

    std::vector<VertexSides> sides_; ///< [vertices]
};

} // namespace toile
