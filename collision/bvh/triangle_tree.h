#pragma once

#include <array>
#include <vector>

#include "collision/bvh/box_block.h"
#include "core/compute/types.h"
#include "core/mesh/topology.h"

namespace toile::collision {

class BoxTree;

/// Box tree over moving triangles for proximity queries of points and segments. build() fixes its topology
/// once; refit() updates the boxes. Every node is a block of eight boxes tested at once.
///
/// The tree only proposes candidates. Its boxes are in single precision, and queries are padded by more than
/// their rounding. No triangle is missed, and some candidates are too far away. Triangles with a corner that
/// is not finite are never candidates.
class TriangleTree {
public:
    /// Builds the topology (see BoxTree) and fits the boxes. O(n log n).
    /// @param triangles  [triangles x 3] indices into positions; borrowed for the tree's lifetime
    /// @param positions  [vertices x 3] [m]
    void build(View<const Triangle> triangles, View<const Vec3> positions);

    /// Updates the boxes for new positions [vertices x 3] [m]. O(n).
    void refit(View<const Vec3> positions);

    /// Calls visit(triangle) for every triangle within `radius` [m] of p and some more, nearer boxes first.
    /// visit returns a smaller radius, or a negative number to keep the current one.
    template <typename Visit>
    void visit_nearest(const Vec3& p, double radius, const Visit& visit) const;

    /// Calls visit(triangle) for every triangle within `radius` [m] of p and some more, in any order.
    /// @param unlike  unit or zero: skips nearly all triangles whose face normal has a cosine [-] with
    ///                `unlike` above `cosine`
    template <typename Visit>
    void visit_within(const Vec3& p, double radius, const Vec3& unlike, double cosine,
                      const Visit& visit) const;

    /// Calls visit(triangle) for every triangle within `radius` [m] of the segment ab and some more, in any
    /// order.
    template <typename Visit>
    void visit_near(const Vec3& a, const Vec3& b, double radius, const Visit& visit) const;

private:
    /// Eight inner nodes side by side, or the eight triangles of a leaf. Unused lanes are empty.
    struct Block {
        BoxBlock box;
        std::array<int, BoxBlock::kCount> below; ///< child blocks, or triangles
        int slot_above;                          ///< 8 * block + lane; -1: the root
    };
    struct Leaf {
        std::array<std::array<float, BoxBlock::kCount>, 3> normal; ///< of the faces; unit or zero
        int count;                                                 ///< triangles in use
    };
    /// Point in single precision.
    struct Center {
        explicit Center(const Vec3& p) : x(float(p.x())), y(float(p.y())), z(float(p.z())) {}
        FloatLanes distance2(const BoxBlock& box) const;
        float x, y, z; ///< [m]
    };

    bool is_leaf(int block) const { return block >= first_leaf_; }
    double padded(double radius, const Vec3& p) const;
    float squared(double radius, const Vec3& p) const;

    int add_inner(const BoxTree& shape, int node);
    int add_block();
    void fit_leaf(int leaf, View<const Vec3> positions);
    void pass_up(int block);

    template <typename Visit>
    void nearest_below(int block, const Vec3& p, const Center& center, float& radius2,
                       const Visit& visit) const;
    /// Calls visit(leaf block, lanes) for the lanes that overlaps(box block) selects.
    template <typename Overlaps, typename Visit>
    void leaves_below(int block, const Overlaps& overlaps, const Visit& visit) const;

    View<const Triangle> triangles_;
    int first_leaf_ = 0;
    double largest_coordinate_ = 0.0; ///< [m]
    std::vector<Block> blocks_;       ///< inner blocks, parents before children; then leaves
    std::vector<Leaf> leaves_;
};

inline FloatLanes TriangleTree::Center::distance2(const BoxBlock& box) const
{
    const std::array<float, 3> center{x, y, z};
    FloatLanes sum = 0.0f;
    for (int k = 0; k < 3; ++k) {
        const FloatLanes below = load(box.lower[k].data()) - center[k];
        const FloatLanes above = center[k] - load(box.upper[k].data());
        const FloatLanes outside = max(max(below, above), FloatLanes(0.0f));
        sum += outside * outside;
    }
    return sum;
}

template <typename Visit>
void TriangleTree::visit_nearest(const Vec3& p, double radius, const Visit& visit) const
{
    float radius2 = squared(radius, p);
    if (!blocks_.empty())
        nearest_below(0, p, Center(p), radius2, visit);
}

template <typename Visit>
void TriangleTree::nearest_below(int block, const Vec3& p, const Center& center, float& radius2,
                                 const Visit& visit) const
{
    struct Lane {
        float distance2;
        int below;
    };
    std::array<Lane, BoxBlock::kCount> lanes;
    int count = 0;
    const FloatLanes distance2 = center.distance2(blocks_[block].box);
    for_each_lane(distance2 <= radius2, [&](int lane) {
        // Insertion sort: the lanes are few.
        const float lane_distance2 = distance2[lane];
        int slot = count++;
        for (; slot > 0 && lanes[slot - 1].distance2 > lane_distance2; --slot)
            lanes[slot] = lanes[slot - 1];
        lanes[slot] = {lane_distance2, blocks_[block].below[lane]};
    });
    for (int i = 0; i < count && lanes[i].distance2 <= radius2; ++i) {
        if (!is_leaf(block))
            nearest_below(lanes[i].below, p, center, radius2, visit);
        else if (const double smaller = visit(lanes[i].below); smaller >= 0.0)
            radius2 = std::min(radius2, squared(smaller, p));
    }
}

template <typename Visit>
void TriangleTree::visit_within(const Vec3& p, double radius, const Vec3& unlike, double cosine,
                                const Visit& visit) const
{
    constexpr float kCosineSlack = 1e-5f; // [-] of single precision
    const Center center(p);
    const float radius2 = squared(radius, p);
    const std::array<float, 3> n{float(unlike.x()), float(unlike.y()), float(unlike.z())};
    leaves_below(
        0, [&](const BoxBlock& box) { return center.distance2(box) <= radius2; },
        [&](int block, const FloatLanes::mask_type& met) {
            const auto& normal = leaves_[block - first_leaf_].normal;
            FloatLanes along = 0.0f;
            for (int k = 0; k < 3; ++k)
                along += n[k] * load(normal[k].data());
            for_each_lane(met && along <= float(cosine) + kCosineSlack,
                          [&](int lane) { visit(blocks_[block].below[lane]); });
        });
}

template <typename Visit>
void TriangleTree::visit_near(const Vec3& a, const Vec3& b, double radius, const Visit& visit) const
{
    const float grow = float(padded(radius, a.cwiseAbs().cwiseMax(b.cwiseAbs())));
    Box query;
    for (int k = 0; k < 3; ++k) {
        query.lower[k] = float(std::min(a[k], b[k])) - grow;
        query.upper[k] = float(std::max(a[k], b[k])) + grow;
    }
    leaves_below(
        0, [&](const BoxBlock& box) { return box.overlaps(query); },
        [&](int block, const FloatLanes::mask_type& met) {
            for_each_lane(met, [&](int lane) { visit(blocks_[block].below[lane]); });
        });
}

template <typename Overlaps, typename Visit>
void TriangleTree::leaves_below(int block, const Overlaps& overlaps, const Visit& visit) const
{
    if (blocks_.empty())
        return;
    const FloatLanes::mask_type met = overlaps(blocks_[block].box);
    if (is_leaf(block))
        visit(block, met);
    else
        for_each_lane(met, [&](int lane) { leaves_below(blocks_[block].below[lane], overlaps, visit); });
}

} // namespace toile::collision
