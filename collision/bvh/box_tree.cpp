#include "collision/bvh/box_tree.h"

#include <numeric>

namespace toile::collision {

namespace {

constexpr int kBins = 16;

/// Depth from which nodes are split in the middle of their list, so that no input makes a deep tree.
constexpr int kMaxUnevenDepth = 40;

/// Node still to be split: items [begin, end) of the order belong below `node`.
struct Range {
    int node, begin, end, depth;
};

/// Equal bins of item centres along the longest axis of their box.
struct Bins {
    Bins(View<const Box> items, View<const int> order)
    {
        Box centers;
        for (const int i : order)
            centers.add(center_box(items[i]));
        for (int k = 1; k < 3; ++k)
            if (extent(centers, k) > extent(centers, axis))
                axis = k;
        lower = centers.lower[axis];
        per_meter = extent(centers, axis) > 0.0f ? float(kBins) / extent(centers, axis) : 0.0f;
    }

    int operator()(const Box& box) const
    {
        const float center = 0.5f * (box.lower[axis] + box.upper[axis]);
        return std::clamp(int((center - lower) * per_meter), 0, kBins - 1);
    }

    int axis = 0;
    float lower = 0.0f;
    float per_meter = 0.0f;

private:
    static Box center_box(const Box& box)
    {
        Box center;
        for (int k = 0; k < 3; ++k)
            center.lower[k] = center.upper[k] = 0.5f * (box.lower[k] + box.upper[k]);
        return center;
    }
    static float extent(const Box& box, int k) { return box.upper[k] - box.lower[k]; }
};

/// Expected cost of a query that reaches this side: surface times blocks of lanes.
float cost(const Box& box, int count)
{
    const int blocks = lane_blocks(count);
    return blocks == 0 ? 0.0f : box.half_area() * float(blocks);
}

/// Last bin of the lower side of the cheapest cut.
int best_cut(View<const Box> items, View<const int> order, const Bins& bin_of)
{
    std::array<Box, kBins> box;
    std::array<int, kBins> count{};
    for (const int i : order) {
        const int bin = bin_of(items[i]);
        box[bin].add(items[i]);
        ++count[bin];
    }

    // Costs of all right sides; the left sides follow in the second loop.
    std::array<float, kBins> right_cost{};
    Box right;
    int right_count = 0;
    for (int bin = kBins - 1; bin > 0; --bin) {
        right.add(box[bin]);
        right_count += count[bin];
        right_cost[bin] = cost(right, right_count);
    }
    Box left;
    int left_count = 0, best = 0;
    float best_cost = std::numeric_limits<float>::max();
    for (int bin = 0; bin + 1 < kBins; ++bin) {
        left.add(box[bin]);
        left_count += count[bin];
        if (const float both = cost(left, left_count) + right_cost[bin + 1]; both < best_cost) {
            best_cost = both;
            best = bin;
        }
    }
    return best;
}

/// Partitions the range's items into two sides; returns the index of the second side's first item.
int split(View<const Box> items, const Range& range, std::vector<int>& order)
{
    const View<int> part(order.data() + range.begin, range.end - range.begin);
    if (range.depth < kMaxUnevenDepth) {
        const Bins bin_of(items, part);
        const int cut = best_cut(items, part, bin_of);
        const auto middle =
            std::stable_partition(part.begin(), part.end(), [&](int i) { return bin_of(items[i]) <= cut; });
        if (middle != part.begin() && middle != part.end())
            return range.begin + int(middle - part.begin());
    }
    return range.begin + part.size() / 2;
}

} // namespace

void BoxTree::build(View<const Box> items)
{
    nodes_.clear();
    leaves_ = {{0}, {}};
    if (items.empty())
        return;
    leaves_.items.resize(items.size());
    std::iota(leaves_.items.begin(), leaves_.items.end(), 0);

    // Split depth first, left to right, so that leaves near each other in the list are near in space.
    nodes_.emplace_back();
    std::vector<Range> open_ranges{{0, 0, items.size(), 0}};
    while (!open_ranges.empty()) {
        const Range range = open_ranges.back();
        open_ranges.pop_back();
        if (range.end - range.begin <= kLeafItems) {
            nodes_[range.node].leaf = leaf_count();
            leaves_.first.push_back(range.end);
            continue;
        }
        const int middle = split(items, range, leaves_.items);
        const int child = int(nodes_.size());
        nodes_[range.node].child = child;
        nodes_.resize(nodes_.size() + 2);
        open_ranges.push_back({child + 1, middle, range.end, range.depth + 1});
        open_ranges.push_back({child, range.begin, middle, range.depth + 1});
    }
}

void BoxTree::refit(View<const Box> leaf_boxes, View<const unsigned char> wanted)
{
    // Run backwards: children come after their parents.
    for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
        if (node->child < 0) {
            node->box = leaf_boxes[node->leaf];
            node->is_wanted = wanted[node->leaf] != 0;
            continue;
        }
        node->box = nodes_[node->child].box;
        node->box.add(nodes_[node->child + 1].box);
        node->is_wanted = nodes_[node->child].is_wanted || nodes_[node->child + 1].is_wanted;
    }
}

double BoxTree::surface(float shrink) const
{
    return std::accumulate(nodes_.begin(), nodes_.end(), 0.0, [&](double sum, const Node& node) {
        return sum + double(node.box.half_area(shrink));
    });
}

void BoxTree::pairs_of_nodes(int count, std::vector<NodePair>& out) const
{
    out.clear();
    if (nodes_.empty())
        return;
    out.push_back({0, 0});
    std::vector<NodePair> below;
    bool is_open = true;
    while (is_open && int(out.size()) < count) {
        is_open = false;
        below.clear();
        for (const NodePair& pair : out) {
            if (nodes_[pair[0]].child < 0 && nodes_[pair[1]].child < 0) {
                below.push_back(pair);
                continue;
            }
            is_open = true;
            open(pair, [&](NodePair next) {
                if (may_meet(next))
                    below.push_back(next);
            });
        }
        out.swap(below);
    }
}

} // namespace toile::collision
