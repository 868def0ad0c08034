#include "collision/check/crossing_box_tree.h"

#include <algorithm>
#include <numeric>

namespace toile::collision {

namespace {

constexpr int kLeafSize = 4;

} // namespace

CrossingBoxTree::CrossingBoxTree(View<const Bounds> boxes)
{
    for (int i = 0; i < boxes.size(); ++i)
        if (!boxes[i].empty())
            order_.push_back(i);
    if (!order_.empty())
        build(boxes, 0, int(order_.size()));
    boxes_.reserve(order_.size());
    for (const int i : order_)
        boxes_.push_back(boxes[i]);
}

void CrossingBoxTree::build(View<const Bounds> boxes, int first, int count)
{
    const auto begin = order_.begin() + first;
    Bounds box, centers;
    for (auto i = begin; i != begin + count; ++i) {
        box.extend(boxes[*i].lower);
        box.extend(boxes[*i].upper);
        centers.extend(boxes[*i].center());
    }
    const size_t node = nodes_.size();
    nodes_.push_back({box, first, count});
    if (count <= kLeafSize)
        return;

    int axis = 0;
    (centers.upper - centers.lower).maxCoeff(&axis);
    const int half = count / 2;
    // Order equal centres by index, so that the tree is the same on every machine.
    std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
        const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
        const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
        return at_a < at_b || (at_a == at_b && a < b);
    });
    build(boxes, first, half);
    nodes_[node].first = int(nodes_.size());
    nodes_[node].count = 0;
    build(boxes, first + half, count - half);
}

void CrossingBoxTree::find(const Bounds& box, std::vector<int>& out) const
{
    constexpr int kDeepest = 64; // halving 2^31 boxes takes 31 levels
    int waiting[kDeepest];
    int top = 0;
    if (!nodes_.empty() && meet(nodes_[0].box, box))
        waiting[top++] = 0;
    while (top > 0) {
        const int at = waiting[--top];
        const Node& node = nodes_[at];
        for (int i = node.first; i < node.first + node.count; ++i)
            if (meet(boxes_[i], box))
                out.push_back(order_[i]);
        if (node.count > 0)
            continue;
        if (meet(nodes_[node.first].box, box))
            waiting[top++] = node.first;
        if (meet(nodes_[at + 1].box, box))
            waiting[top++] = at + 1;
    }
}

} // namespace toile::collision
