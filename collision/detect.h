#pragma once

#include <limits>
#include <vector>

#include "collision/clearance.h"
#include "collision/contact_pair.h"
#include "collision/side_memory.h"

namespace toile {

struct DetectSettings {
    /// [m] Places closer than this become pairs. Positive; larger than the contact thickness plus what cloth
    /// moves between two detections, or contacts start late.
    double radius = 0.01;

    /// [m] Cloth vertices up to this far inside a mesh are still pushed out to the nearest surface. Deeper
    /// ones are left alone: they more likely belong to the other side of a limb. Shapes have no such limit.
    double max_depth = 0.1;

    /// [m] A sheet that moved farther than this in the step has been replaced: its remembered sides are void.
    double farthest_motion = std::numeric_limits<double>::infinity();

    bool face_vertex = true; ///< cloth faces against vertices, corners, balls: points under coarse cloth
    bool edge_edge = true;   ///< edges against ridges: folds over sharp rims; the most numerous kind
};

/// Finds the places where one cloth is near colliders.
///
/// The pairs come in a fixed order, with the same bits for any number of threads. Nothing throws for
/// self-intersecting or collapsed colliders, and every pair is finite with a unit normal.
class ContactDetector {
public:
    /// @param triangles  [triangles x 3] the cloth's
    /// @param positions  [vertices x 3] any pose of it, e.g. the first [m]; borrowed until the first move()
    ContactDetector(View<const Triangle> triangles, View<const Vec3> positions);

    /// Cloth positions to detect at: the guess for t1 [vertices x 3] [m]. Borrowed until the next move().
    /// @param reach  [vertices] largest distance of a pair with a mesh [m], where that is less than the
    ///               radius of detect(); empty: nowhere. Borrowed likewise
    void move(View<const Vec3> x, View<const double> reach = {});

    /// Appends the pairs against one collider, by kind, cloth vertices, collider feature:
    ///   kVertexFace  up to three planes a vertex: the closest point, then the next local minima of the
    ///                distance whose normals differ by more than 45 degrees and that face the vertex
    ///                (armpits, between limbs: one plane is not enough there)
    ///   kFaceVertex  collider vertices against the cloth sheets that they are about to touch or have pierced
    ///   kEdgeEdge    cloth edges across ridges of the collider
    /// A vertex that is behind sheets it was in front of gets their planes, and none of the nearest surface
    /// that it is behind: it goes back where it came from. Without such memory the nearest surface decides.
    /// @param collider  its number, copied into the pairs
    /// @param sides     may be null
    void detect(const MeshCollider& mesh, int collider, const DetectSettings& settings,
                std::vector<ContactPair>& out, const SideMemory* sides = nullptr);

    /// Appends the pairs against a solid in the order of their kinds:
    ///   kVertexShape  one per cloth vertex nearer than the radius, or inside at any depth
    ///   kFaceShape    cloth faces against corners of a box, or the balls of a sphere or capsule
    ///   kEdgeShape    cloth edges against corners and edges of a box, or the balls and axis of a capsule
    /// Planes make vertex pairs only. Round shapes meet faces and edges only where these come nearer than
    /// their own vertices.
    void detect(const ShapeCollider& shape, int collider, const DetectSettings& settings,
                std::vector<ContactPair>& out);

    /// How far in front of a mesh every vertex is at the positions of the last move(), at least.
    /// @param collider  the mesh's number: always the same one
    Clearance& clearance_of(const MeshCollider& mesh, int collider);

private:
    /// The cloth's tree at the current positions, refitted when first asked for after a move().
    const SurfaceProximity& cloth_surface();

    SurfaceProximity cloth_;
    View<const Vec3> x_;
    View<const double> reach_;
    std::vector<Clearance> clearance_; ///< by collider
    Bounds bounds_;
    bool tree_is_stale_ = true;
};

} // namespace toile
