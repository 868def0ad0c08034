#pragma once

#include <limits>
#include <vector>

#include "collision/body/clearance.h"
#include "collision/body/side_history.h"
#include "collision/geometry/contact_pair.h"

namespace toile::collision {

struct DetectSettings {
    /// [m] Points closer than this become pairs. Positive; larger than the contact thickness plus the motion
    /// of cloth between two detections, or contacts start late.
    double radius = 0.01;

    /// [m] Maximum radius of meshes, whose search takes longer the larger it is.
    double max_mesh_radius = std::numeric_limits<double>::infinity();
    double mesh_radius() const { return radius < max_mesh_radius ? radius : max_mesh_radius; } ///< [m]

    /// [m] Maximum depth inside a mesh from which cloth vertices are pushed out to the nearest surface.
    /// Deeper ones are ignored: they more likely belong to the other side of a limb. Shapes have no such
    /// limit.
    double max_depth = 0.1;

    /// [m] Maximum motion of a sheet in the step. A faster sheet has been replaced, so its recorded sides
    /// are void.
    double max_motion = std::numeric_limits<double>::infinity();

    bool face_vertex = true; ///< cloth faces against vertices, corners, balls: points under coarse cloth
    bool edge_edge = true;   ///< cloth edges against ridges: folds over sharp rims; the most numerous kind
};

/// Finds the contact pairs of one cloth and colliders.
///
/// The pairs come in a fixed order, with the same bits for any number of threads. Self-intersecting or
/// collapsed colliders cause no exceptions, and every pair is finite with a unit normal.
class ContactDetector {
public:
    /// @param triangles  [triangles x 3] the cloth's
    /// @param positions  [vertices x 3] any pose of it, e.g. the first [m]; borrowed until the first move()
    ContactDetector(View<const Triangle> triangles, View<const Vec3> positions);

    /// Sets the cloth positions to detect at: the guess for t1 [vertices x 3] [m]. Borrowed until the next
    /// move().
    /// @param reach  [vertices] maximum distance of a pair with a mesh [m], if less than the radius of
    ///               detect(); empty: no such limit. Borrowed likewise
    void move(View<const Vec3> x, View<const double> reach = {});

    /// Appends the pairs against one mesh, by kind, cloth vertices, collider feature:
    ///   kVertexFace  up to three planes a vertex: the closest point, then the next local minima of the
    ///                distance whose normals differ by more than 45 degrees and that face the vertex
    ///                (armpits, between limbs: one plane is not enough)
    ///   kFaceVertex  collider vertices against the cloth sheets that they approach or have pierced
    ///   kEdgeEdge    cloth edges across ridges of the collider
    /// A vertex behind sheets that it was in front of gets their planes instead of the nearest surface's: it
    /// returns to the side it came from. Without this history the nearest surface decides.
    /// @param collider  number of the mesh, copied into the pairs
    /// @param sides     may be null
    void detect(const MeshCollider& mesh, int collider, const DetectSettings& settings,
                std::vector<ContactPair>& out, const ContactSideHistory* sides = nullptr);

    /// Appends the pairs against a solid in the order of their kinds:
    ///   kVertexShape  one per cloth vertex nearer than the radius, or inside at any depth
    ///   kFaceShape    cloth faces against corners of a box, or the balls of a sphere or capsule
    ///   kEdgeShape    cloth edges against corners and edges of a box, or the balls and axis of a capsule
    /// Planes form vertex pairs only. Round shapes form pairs with faces and edges only if these come nearer
    /// than their own vertices.
    void detect(const ShapeCollider& shape, int collider, const DetectSettings& settings,
                std::vector<ContactPair>& out);

    /// Lower bounds on each vertex's distance in front of a mesh, at the positions of the last move().
    /// @param collider  number of the mesh, the same in every call
    Clearance& clearance_of(const MeshCollider& mesh, int collider);

private:
    /// Cloth tree at the current positions, refitted at the first call after a move().
    const SurfaceProximity& cloth_surface();

    SurfaceProximity cloth_;
    View<const Vec3> x_;
    View<const double> reach_;
    std::vector<Clearance> clearance_; ///< [colliders]
    Bounds bounds_;
    bool tree_is_stale_ = true;
};

} // namespace toile::collision
