#include "collision/bvh/triangle_tree.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "collision/bvh/box_tree.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Single-precision slack of boxes, points and squares, relative to the largest coordinate and to the radius
/// [-]. It is several times the rounding of each (2^-24), so that no triangle is missed.
constexpr double kFloatSlack = 1e-6;

/// Leaves per task of a refit.
constexpr int kLeafGrain = 64;

/// Child of an unused lane; not a block number.
constexpr int kUnused = std::numeric_limits<int>::max();

/// Box of a triangle. Corners that are not finite become the origin, so that items can be sorted.
Box box_of(const Triangle& corner, View<const Vec3> positions)
{
    Box box;
    for (const int v : corner) {
        const Vec3 x = positions[v].allFinite() ? positions[v] : Vec3(Vec3::Zero());
        for (int k = 0; k < 3; ++k) {
            box.lower[k] = std::min(box.lower[k], float(x[k]));
            box.upper[k] = std::max(box.upper[k], float(x[k]));
        }
    }
    return box;
}

/// Refits the tree around all items.
void fit(BoxTree& shape, View<const Box> items)
{
    std::vector<Box> leaf_boxes(shape.leaf_count());
    for (int leaf = 0; leaf < shape.leaf_count(); ++leaf)
        for (const int t : shape.items_of(leaf))
            leaf_boxes[leaf].add(items[t]);
    shape.refit(leaf_boxes, std::vector<unsigned char>(leaf_boxes.size(), 1));
}

/// Up to eight nodes that together cover everything below `node`, found by opening the largest first.
std::vector<int> nodes_below(const BoxTree& shape, int node)
{
    const std::vector<BoxTree::Node>& nodes = shape.nodes();
    std::vector<int> below{nodes[node].child, nodes[node].child + 1};
    while (int(below.size()) < BoxBlock::kCount) {
        const auto extent = [&](int n) { return nodes[n].child < 0 ? -1.0f : nodes[n].box.half_area(); };
        const auto largest =
            std::max_element(below.begin(), below.end(), [&](int m, int n) { return extent(m) < extent(n); });
        const int child = nodes[*largest].child;
        if (child < 0)
            break;
        *largest = child;
        below.push_back(child + 1);
    }
    return below;
}
} // namespace

/// Search radius [m] that covers in single precision every triangle within `radius` of p in exact arithmetic.
double TriangleTree::padded(double radius, const Vec3& p) const
{
    return radius + kFloatSlack * (radius + largest_coordinate_ + p.cwiseAbs().maxCoeff());
}

/// Square of the padded radius [m^2]; finite, so that empty boxes lie outside.
float TriangleTree::squared(double radius, const Vec3& p) const
{
    const double all = padded(radius, p);
    return float(std::min(all * all, 0.5 * double(std::numeric_limits<float>::max())));
}

void TriangleTree::build(View<const Triangle> triangles, View<const Vec3> positions)
{
    triangles_ = triangles;
    blocks_.clear();
    leaves_.clear();
    if (triangles.empty())
        return;
    std::vector<Box> items(triangles.size());
    for (int t = 0; t < triangles.size(); ++t)
        items[t] = box_of(triangles[t], positions);
    BoxTree shape;
    shape.build(items);
    fit(shape, items);

    // Append the leaves after all inner blocks.
    if (shape.nodes()[0].child >= 0)
        add_inner(shape, 0);
    first_leaf_ = int(blocks_.size());
    leaves_.resize(shape.leaf_count());
    for (int leaf = 0; leaf < shape.leaf_count(); ++leaf) {
        const View<const int> items_of_leaf = shape.items_of(leaf);
        add_block();
        std::copy(items_of_leaf.begin(), items_of_leaf.end(), blocks_.back().below.begin());
        leaves_[leaf].count = items_of_leaf.size();
    }
    for (int block = 0; block < first_leaf_; ++block)
        for (int lane = 0; lane < BoxBlock::kCount; ++lane) {
            int& below = blocks_[block].below[lane];
            if (below < 0)
                below = first_leaf_ - 1 - below;
            if (below < int(blocks_.size()))
                blocks_[below].slot_above = BoxBlock::kCount * block + lane;
        }
    refit(positions);
}

/// Adds the inner block of a node and returns its number. Leaves get -1 - number until their blocks exist.
int TriangleTree::add_inner(const BoxTree& shape, int node)
{
    const int block = add_block();
    int lane = 0;
    for (const int n : nodes_below(shape, node)) {
        const int leaf = shape.nodes()[n].leaf;
        const int below = leaf >= 0 ? -1 - leaf : add_inner(shape, n);
        blocks_[block].below[lane++] = below;
    }
    return block;
}

/// Adds an empty block and returns its number.
int TriangleTree::add_block()
{
    Block& block = blocks_.emplace_back();
    for (int lane = 0; lane < BoxBlock::kCount; ++lane)
        block.box.set(lane, Box());
    block.below.fill(kUnused);
    block.slot_above = -1;
    return int(blocks_.size()) - 1;
}

void TriangleTree::refit(View<const Vec3> positions)
{
    parallel_for(
        kCpu, "collision/fit_leaves", int(leaves_.size()), [&](int leaf) { fit_leaf(leaf, positions); },
        kLeafGrain);
    for (int block = first_leaf_ - 1; block > 0; --block)
        pass_up(block);

    largest_coordinate_ = 0.0;
    if (blocks_.empty())
        return;
    const Box all = blocks_[0].box.bounds();
    for (int k = 0; k < 3; ++k)
        largest_coordinate_ = std::max({largest_coordinate_, -double(all.lower[k]), double(all.upper[k])});
}

void TriangleTree::fit_leaf(int leaf, View<const Vec3> positions)
{
    Block& block = blocks_[first_leaf_ + leaf];
    Leaf& self = leaves_[leaf];
    std::array<Vec3Of<Lanes>, 3> x;
    for (int corner = 0; corner < 3; ++corner)
        for (int k = 0; k < 3; ++k)
            x[corner][k] = gather(
                0, self.count, [&](int lane) { return positions[triangles_[block.below[lane]][corner]][k]; });

    // Boxes. Lanes without a triangle, or with a corner that is not finite, stay empty.
    const Lanes sum = x[0].sum() + x[1].sum() + x[2].sum();
    const Lanes number([](auto lane) { return double(lane); });
    const auto is_nowhere = std::experimental::static_simd_cast<FloatLanes>(number) >= float(self.count) ||
                            std::experimental::static_simd_cast<FloatLanes>(sum - sum) != 0.0f;
    for (int k = 0; k < 3; ++k) {
        using std::experimental::static_simd_cast;
        FloatLanes lower = static_simd_cast<FloatLanes>(min(min(x[0][k], x[1][k]), x[2][k]));
        FloatLanes upper = static_simd_cast<FloatLanes>(max(max(x[0][k], x[1][k]), x[2][k]));
        where(is_nowhere, lower) = Box::kFar;
        where(is_nowhere, upper) = -Box::kFar;
        lower.copy_to(block.box.lower[k].data(), std::experimental::element_aligned);
        upper.copy_to(block.box.upper[k].data(), std::experimental::element_aligned);
    }

    // Face normals.
    const Vec3Of<Lanes> side = x[1] - x[0], other = x[2] - x[0];
    const Vec3Of<Lanes> doubled_area = side.cross(other);
    const Lanes length = square_root(Lanes(doubled_area.dot(doubled_area)));
    const Lanes scale = select(length > 0.0, Lanes(1.0) / length, Lanes(0.0));
    for (int k = 0; k < 3; ++k)
        std::experimental::static_simd_cast<FloatLanes>(scale * doubled_area[k])
            .copy_to(self.normal[k].data(), std::experimental::element_aligned);
    pass_up(first_leaf_ + leaf);
}

/// Updates the box of a block in its parent.
void TriangleTree::pass_up(int block)
{
    const Block& self = blocks_[block];
    if (self.slot_above < 0)
        return;
    blocks_[self.slot_above / BoxBlock::kCount].box.set(self.slot_above % BoxBlock::kCount,
                                                        self.box.bounds());
}

} // namespace toile::collision
