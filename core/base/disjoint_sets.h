#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace toile {

/// Sets of joined items. The lowest member stands for a set.
class DisjointSets {
public:
    explicit DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(int a, int b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

} // namespace toile
