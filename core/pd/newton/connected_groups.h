#pragma once

#include <vector>

#include "core/compute/types.h"
#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// Links between items, both ways. Repeats count: they are how strongly two items are linked.
struct Links {
    std::vector<int> first{0}; ///< [items + 1]
    std::vector<int> to;       ///< [links] the other item

    int count() const { return int(first.size()) - 1; }
    View<const int> of(int item) const { return {to.data() + first[item], first[item + 1] - first[item]}; }
};

/// Links between vertices by entries of two matrices.
/// @param excluded  [vertices] 1: has no links
Links links_of(const BlockMatrix& blocks, const SparseMatrix& isotropic, View<const unsigned char> excluded);

/// Sets of linked items, each ascending.
/// @param excluded  [items] 1: belongs to none
std::vector<std::vector<int>> connected_components(const Links& links, View<const unsigned char> excluded);

/// Disjoint sets of items, in the order of their labels.
struct Groups {
    std::vector<int> of;    ///< [items] -1: none
    std::vector<int> label; ///< [groups]

    int count() const { return int(label.size()); }
};

/// Groups of linked items of one label. Small groups join one that they are linked to, whatever its label:
/// the one with most links, the first of several. So groups are connected, and several may have one label.
/// @param labels    [items] -1: belongs to no group
/// @param weights   [items]
/// @param smallest  weight below which a group joins another, if one has room
/// @param largest   weight of a group of more than one item
Groups connected_groups(const Links& links, View<const int> labels, View<const int> weights, int smallest,
                        int largest);

/// Joins groups until there are `count`, or no more can be joined: the lightest first, each with the one that
/// it has most links to by weight.
/// @param links    between items
/// @param weights  [items]
/// @param largest  weight of joined groups
Groups joined_groups(const Links& links, const Groups& groups, View<const int> weights, int count,
                     int largest);

/// Links between groups, one for each between their items.
Links links_between(const Links& links, const Groups& groups);

/// Sum of a number over the items of each group.
std::vector<int> sums_of(const Groups& groups, View<const int> numbers);

} // namespace toile
