#pragma once

#include <array>
#include <memory>
#include <vector>

#include "collision/surface_edges.h"
#include "collision/ways.h"
#include "core/backend/types.h"

namespace toile {

struct SoupView;

/// Two primitives of one triangle soup that share no vertex and are near each other: a vertex and a
/// triangle, or two edges. "First" and "second" below are these two.
struct NearPair {
    std::array<int, 4> vertex;    ///< vertex, then the triangle's corners; or both ends of each edge
    std::array<double, 4> weight; ///< signed, sum 0: sum_k weight_k x_k runs from the second's closest
                                  ///< point to the first's
    Vec3 normal;       ///< unit, along that difference; where they touch the triangle's normal or the cross
                       ///< product of the edges, of either sign
    double distance;   ///< [m] between the closest points
    int first, second; ///< vertex and triangle, or two edges numbered as in build_surface_edges
    bool is_edge_edge;
    bool is_facing; ///< stands for a local minimum of the distance between two SURFACES (see below)
};

/// Finds the pairs of primitives that might meet while the vertices of one triangle soup move: every cloth
/// that is stepped together is part of the soup.
///
/// A tree of boxes over the triangles, built once and refitted per search, is descended against itself.
/// Every vertex and every edge belongs to the lowest of its triangles, so each pair is met exactly once
/// [Curtis et al. 2008, Fast collision detection for deformable models using representative-triangles].
///
/// NearPair::is_facing picks, of the many pairs around one place where two surfaces face each other, those
/// that stand for it:
/// - vertex and triangle: where the closest point lies on an edge or a corner, all triangles around that edge
///   or corner agree that it is closest (else the minimum lies on another triangle, which has its own pair),
///   and this is the lowest of them; of two vertices the smaller is the pair's `vertex`;
/// - two edges: closest inside both, not parallel, and both stand out: the direction between them leads into
///   no face beside either, and off one of them or over a border. Flat sheets meet with their vertices.
/// docs/collision/cloth.md draws them.
///
/// While cloth stays about where it was, pairs that a wide search has found are asked instead of the tree
/// (KeptPairs). What find() gives is the same, to the bit; but of triangles that are thin, whose distances
/// are off by rounding, a search may let pairs pass that are farther apart than asked for.
class NearPairs {
public:
    enum class Keeping { kPairs, kNothing }; ///< kNothing: each find() searches, to measure that

    /// Builds edges and tree. O(n log n).
    /// @param triangles  [triangles x 3] indices into positions; any list: collapsed, non-manifold
    /// @param positions  [vertices x 3] [m] the first pose
    /// @param rigid      [vertices] number of the rigid body, -1 for none: no pairs within one body. Empty:
    ///                   none at all
    NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid = {},
              Keeping keeping = Keeping::kPairs);
    ~NearPairs();
    NearPairs(NearPairs&&) noexcept;
    NearPairs& operator=(NearPairs&&) noexcept;

    /// All pairs that may come nearer than `margin` while each vertex moves straight to where `ways` says,
    /// and some more: a pair is left out only where the boxes around its ways stay apart, or its corners
    /// along the direction that separates it at x. Replaces the content of out. Order: vertex-triangle by
    /// vertex, triangle; then edge-edge by edge, edge, edges numbered as in build_surface_edges. Same bits
    /// for every thread count.
    /// @param x       [vertices x 3] [m]
    /// @param margin  [m] >= 0
    /// @param slack   [vertices] [m] >= 0 how far from the expected place a vertex may end
    void find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out);

    const SurfaceEdges& edges() const; ///< of the triangles

    SoupView soup() const; ///< borrowed

private:
    class Search;
    std::unique_ptr<Search> search_;
};

} // namespace toile
