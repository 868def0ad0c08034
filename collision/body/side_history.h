#pragma once

#include <vector>

#include "collision/body/clearance.h"
#include "collision/body/side_rules.h"

namespace toile::collision {

/// Sheets of moving meshes that each cloth vertex is in front of. When body parts close on cloth until they
/// overlap, a vertex is behind several sheets at once. The nearest surface then does not determine its side;
/// the history does.
class ContactSideHistory {
public:
    explicit ContactSideHistory(int vertex_count) : sides_(size_t(vertex_count)) {}

    void forget() { std::fill(sides_.begin(), sides_.end(), VertexSides{}); }

    /// Updates the sides at the end of a step. Keeps sheets that the vertex has passed behind; adds those it
    /// is in front of. One or two queries for each vertex near the mesh; none for a mesh that never moved.
    /// @param x          [vertices] cloth at t1 [m]
    /// @param collider   number of the mesh
    /// @param clearance  of the cloth above the mesh, at x
    void update(View<const Vec3> x, const MeshCollider& mesh, int collider, const Clearance& clearance);

    /// Finds the points on recorded sheets of a mesh at t1 that vertex v of the cloth, at x, is behind.
    /// Sheets that moved farther than `max_motion` [m] in the step were replaced and are skipped. Replaces
    /// the content of out.
    void find_behind(int v, const Vec3& x, const MeshCollider& mesh, int collider, double max_motion,
                     std::vector<SurfacePoint>& out) const;

private:
    VertexSides updated_sides(int v, const Vec3& x, const MeshCollider& mesh, int collider, int hint) const;

    std::vector<VertexSides> sides_; ///< [vertices]
};

} // namespace toile::collision
