#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "collision/geometry/surface_edges.h"
#include "collision/geometry/trajectories.h"
#include "core/compute/types.h"

namespace toile::collision {

struct SoupView;

/// In place of the number of a rigid body: vertices whose motion is given. They make no pairs with each other
/// nor with rigid bodies.
inline constexpr int kPrescribed = std::numeric_limits<int>::max();
/// Likewise: vertices that make pairs with prescribed ones only.
inline constexpr int kTogether = kPrescribed - 1;

/// True if vertices of two numbers make no pairs with each other.
/// @param a, b  numbers of rigid bodies, -1 for none, or one of the above
TOILE_HD inline bool are_in_one_body(int a, int b)
{
    if (a < 0 || b < 0)
        return false;
    const int low = std::min(a, b), high = std::max(a, b);
    return low == high || high == kTogether || (high == kPrescribed && low != kTogether);
}

/// Two primitives of one triangle soup that share no vertex and are near each other: a vertex and a
/// triangle, or two edges. "First" and "second" below are these two.
struct NearPair {
    std::array<int, 4> vertex;    ///< vertex, then the triangle's corners; or both ends of each edge
    std::array<double, 4> weight; ///< signed, sum 0: sum_k weight_k x_k runs from the second's closest
                                  ///< point to the first's
    Vec3 normal; ///< unit, along that difference; for touching primitives the triangle's normal or the cross
                 ///< product of the edges, of either sign
    double distance;   ///< [m] between the closest points
    int first, second; ///< vertex and triangle, or two edges numbered as in build_surface_edges
    bool is_edge_edge;
    bool is_facing; ///< represents a local minimum of the distance between two SURFACES (see below)
};

/// True for a pair of cloth with a body.
/// @param first_body  all vertices from it on belong to bodies
TOILE_HD inline bool is_with_body(const NearPair& pair, int first_body)
{
    return pair.vertex[0] >= first_body || pair.vertex[3] >= first_body;
}

/// Finds the pairs of primitives that may meet while the vertices of one triangle soup move. The soup
/// contains all cloths that are stepped together.
///
/// A tree of boxes over the triangles is refitted per search, rebuilt when it has worn out, and descended
/// against itself. Every vertex and every edge belongs to the lowest of its triangles, so each pair is
/// visited exactly once [Curtis et al. 2008, Fast collision detection for deformable models using
/// representative-triangles].
///
/// NearPair::is_facing marks, among the many pairs around one local minimum of the distance, those that
/// represent it:
/// - vertex and triangle: if the closest point lies on an edge or a corner, it is closest on all triangles
///   around that edge or corner, and this triangle is the lowest of them. Otherwise the minimum lies on
///   another triangle, which has its own pair. Of two vertices the smaller is the pair's `vertex`;
/// - two edges: the closest points lie inside both, the edges are not parallel, and both stand out: the
///   direction between them leads into no adjacent face, and away from at least one or over a border. Flat
///   sheets are covered by their vertices. See docs/theory/self_collision.md#facing-pairs.
///
/// While the cloth moves little, pairs kept from a wider search replace the descent of the tree (KeptPairs).
/// find() returns the same pairs, bit for bit. Exception: distances of thin triangles are inexact, so a
/// search of the tree may report pairs beyond the margin.
class NearPairs {
public:
    enum class Keeping { kPairs, kNothing }; ///< kNothing: every find() searches the tree, for measurements

    /// Builds edges and tree. O(n log n).
    /// @param triangles  [triangles x 3] indices into positions; collapsed and non-manifold triangles are
    ///                   allowed
    /// @param positions  [vertices x 3] [m] first pose
    /// @param rigid      [vertices] number of the rigid body, -1 for none, or kPrescribed: no pairs within
    /// one
    ///                   body. Empty: no bodies
    NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid = {},
              Keeping keeping = Keeping::kPairs);
    ~NearPairs();
    NearPairs(NearPairs&&) noexcept;
    NearPairs& operator=(NearPairs&&) noexcept;

    /// Finds all pairs that may come nearer than `margin` while each vertex moves straight along its
    /// trajectory, and some more. A pair is left out only if the boxes around its trajectories are disjoint,
    /// or its corners stay apart along the direction that separates it at x. Replaces the content of out.
    /// Order: vertex-triangle by vertex, triangle; then edge-edge by edge, edge, edges numbered as in
    /// build_surface_edges. The result has the same bits for every thread count.
    /// @param x       [vertices x 3] [m]
    /// @param margin  [m] >= 0
    /// @param trajectories  see Trajectories
    void find(View<const Vec3> x, const Trajectories& trajectories, double margin,
              std::vector<NearPair>& out);

    const SurfaceEdges& edges() const; ///< of the triangles

    SoupView soup() const; ///< borrowed

private:
    class Search;
    std::unique_ptr<Search> search_;
};

} // namespace toile::collision
