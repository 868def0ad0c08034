#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Set of vertices, in order of insertion.
class VertexSet {
public:
    /// Empties the set, and sets the number of vertices.
    void reset(int vertex_count)
    {
        clear();
        has_.resize(vertex_count, 0);
    }
    /// O(size).
    void clear()
    {
        for (const int v : items_)
            has_[v] = 0;
        items_.clear();
    }
    void add(int v)
    {
        if (has_[v])
            return;
        has_[v] = 1;
        items_.push_back(v);
    }

    bool has(int v) const { return has_[v] != 0; }
    bool is_empty() const { return items_.empty(); }
    View<const int> items() const { return items_; }

private:
    std::vector<unsigned char> has_; ///< [vertices]
    std::vector<int> items_;
};

} // namespace toile::collision
