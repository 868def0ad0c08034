#pragma once

/// Stages of ContactDetector, one source file each.

#include <vector>

#include "collision/body/detect.h"
#include "collision/geometry/collider_rules.h"
#include "core/compute/parallel.h"

namespace toile::collision {

/// Inputs shared by the stages.
struct PairSearch {
    View<const Vec3> x;       // [vertices] cloth positions [m]
    View<const double> reach; // [vertices] see ContactDetector::move
    const MeshCollider& mesh; // collider near the cloth
    int collider;             // its number
    DetectSettings settings;
    const ContactSideHistory* sides; // sides of each vertex; null: unknown
    Clearance& clearance;            // of the cloth above the mesh; recorded by find_vertex_face

    /// Largest distance of a pair of these vertices [m].
    template <typename... Vertices>
    double radius_of(Vertices... v) const
    {
        return reach.empty() ? settings.mesh_radius()
                             : std::min(settings.mesh_radius(), std::max({reach[v]...}));
    }
};

/// Appends vertex-face pairs to `out`, sorted by cloth vertex, then by distance.
void find_vertex_face(const PairSearch& search, std::vector<ContactPair>& out);

/// Mesh vertex that may be near cloth.
struct ReachingVertex {
    int vertex;
    double reach; ///< [m] maximum distance of cloth to search
};

/// Mesh vertices that may be near the given cloth triangles, by number.
std::vector<ReachingVertex> find_reaching_vertices(const PairSearch& search, View<const Triangle> cloth);

/// Appends face-vertex pairs to `out`, sorted by cloth vertices, then by collider vertex.
/// @param cloth  tree at search.x
void find_face_vertex(const PairSearch& search, View<const ReachingVertex> vertices,
                      const SurfaceProximity& cloth, std::vector<ContactPair>& out);

/// Appends edge-edge pairs to `out`, sorted by cloth edge, then by collider edge.
void find_edge_edge(const PairSearch& search, const SurfaceEdges& cloth, std::vector<ContactPair>& out);

/// Appends one pair per cloth vertex inside the solid or nearer than the radius, by vertex.
void find_vertex_shape(View<const Vec3> x, const ShapeCollider& shape, int collider, double radius,
                       std::vector<ContactPair>& out);

/// True if the cloth point c is inside the collider, below a feature with normal n at distance `reach` or
/// less. False on the far side of a thin part, where a push along n would pull the cloth through.
struct InsideBelow {
    const MeshCollider& mesh;
    bool operator()(const Vec3& c, double reach, const Vec3& n) const;
};

/// True if x is within `margin` of the box.
inline bool is_near(const Bounds& box, const Vec3& x, double margin)
{
    return ((x - box.lower).array() >= -margin).all() && ((x - box.upper).array() <= margin).all();
}

} // namespace toile::collision
