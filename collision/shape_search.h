#pragma once

#include <span>
#include <vector>

#include "collision/detect.h"
#include "collision/skeleton.h"

namespace toile {

/// The search for places where faces and edges of one cloth are near the corners and edges of one solid.
class ShapeSearch {
public:
    /// @param cloth     its triangles and edges are read, not its tree
    /// @param x         [vertices] cloth positions [m]
    /// @param skeleton  the solid's, at t1
    /// @param collider  the solid's number
    /// @param radius    [m] places closer than this become pairs
    ShapeSearch(const SurfaceProximity& cloth, View<const Vec3> x, const ShapeCollider& shape,
                const Skeleton& skeleton, int collider, double radius);

    /// Appends cloth faces against corners, by cloth face, then by corner.
    void find_faces(std::vector<ContactPair>& out) const;

    /// Appends cloth edges against corners and edges, by cloth edge, then by feature.
    void find_edges(std::vector<ContactPair>& out) const;

private:
    struct Meeting;
    bool is_worth_testing(std::span<const int> vertices, double longest) const;
    bool is_nearest_of_its_faces(int edge, const Vec3& p) const;
    void add_face(int t, std::vector<ContactPair>& out) const;
    void add_corner_edge(int e, int corner, std::vector<ContactPair>& out) const;
    void add_edge_edge(int e, int edge, std::vector<ContactPair>& out) const;
    bool has_pierced(const Vec3& c, const Vec3& n, double depth) const;
    void add(const Meeting& meeting, std::vector<ContactPair>& out) const;
    void add_round(const Meeting& meeting, std::vector<ContactPair>& out) const;
    void add_sharp(const Meeting& meeting, std::vector<ContactPair>& out) const;
    void push(const Meeting& meeting, const Vec3& normal, const Vec3& point,
              std::vector<ContactPair>& out) const;

    View<const Triangle> triangles_;
    const SurfaceEdges& edges_;
    View<const Vec3> x_;
    const ShapeCollider& shape_;
    const Skeleton& skeleton_;
    int collider_;
    double radius_;
    std::vector<double> distance_; ///< [vertices] to the skeleton [m]
};

} // namespace toile
