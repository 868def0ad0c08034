#pragma once

/// The stages of ContactDetector, one source each.

#include <vector>

#include "collision/collider_rules.h"
#include "collision/detect.h"
#include "core/backend/parallel.h"

namespace toile {

/// What the stages share.
struct PairSearch {
    View<const Vec3> x;       // [vertices] cloth positions [m]
    View<const double> reach; // [vertices] see ContactDetector::move
    const MeshCollider& mesh; // what the cloth is near to
    int collider;             // its number
    DetectSettings settings;
    const SideMemory* sides; // where each vertex belongs; null: not known
    Clearance& clearance;    // of the cloth above the mesh; the search for vertices learns it

    /// Largest distance of a pair of these vertices [m].
    template <typename... Vertices>
    double radius_of(Vertices... v) const
    {
        return reach.empty() ? settings.radius : std::min(settings.radius, std::max({reach[v]...}));
    }
};

/// Appends to `out`, sorted by cloth vertex, then by distance.
void find_vertex_face(const PairSearch& search, std::vector<ContactPair>& out);

/// A vertex of the mesh that may be near cloth that is wanted.
struct ReachingVertex {
    int vertex;
    double reach; ///< [m] cloth farther away is not wanted
};

/// Those of the mesh, by number.
std::vector<ReachingVertex> find_reaching_vertices(const PairSearch& search, View<const Triangle> cloth);

/// Appends to `out`, sorted by cloth vertices, then by collider vertex. `cloth` is the tree at search.x.
void find_face_vertex(const PairSearch& search, View<const ReachingVertex> vertices,
                      const SurfaceProximity& cloth, std::vector<ContactPair>& out);

/// Appends to `out`, sorted by cloth edge, then by collider edge.
void find_edge_edge(const PairSearch& search, const SurfaceEdges& cloth, std::vector<ContactPair>& out);

/// Appends one pair per cloth vertex nearer than the radius to the solid or inside it, by vertex.
void find_vertex_shape(View<const Vec3> x, const ShapeCollider& shape, int collider, double radius,
                       std::vector<ContactPair>& out);

/// True when the cloth point c, which lies behind a collider feature with normal n at distance `reach` or
/// less, is inside the collider there: not outside on the far side of a thin part, where pushing along n
/// would pull the cloth through.
struct InsideBelow {
    const MeshCollider& mesh;
    bool operator()(const Vec3& c, double reach, const Vec3& n) const;
};

/// True when x is within `margin` of the box.
inline bool is_near(const Bounds& box, const Vec3& x, double margin)
{
    return ((x - box.lower).array() >= -margin).all() && ((x - box.upper).array() <= margin).all();
}

} // namespace toile
