#pragma once

#include <algorithm>
#include <vector>

#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// Components of the vertices that entries of two matrices connect, each ascending.
/// @param excluded  [vertices] 1: belongs to none, and connects none
inline std::vector<std::vector<int>> connected_components(const BlockMatrix& blocks,
                                                          const SparseMatrix& isotropic,
                                                          View<const unsigned char> excluded)
{
    std::vector<unsigned char> seen(excluded.begin(), excluded.end());
    std::vector<std::vector<int>> components;
    for (int start = 0; start < excluded.size(); ++start) {
        if (seen[start])
            continue;
        std::vector<int> found{start};
        seen[start] = 1;
        const auto add = [&](int j) {
            if (!seen[j])
                found.push_back(j);
            seen[j] = 1;
        };
        for (size_t k = 0; k < found.size(); ++k) {
            for (const int j : blocks.columns(found[k]))
                add(j);
            for (SparseMatrix::InnerIterator entry(isotropic, found[k]); entry; ++entry)
                add(int(entry.col()));
        }
        std::sort(found.begin(), found.end());
        components.push_back(std::move(found));
    }
    return components;
}

} // namespace toile
