#pragma once

#include "core/linear/supernodal_factor.h"

namespace toile {

/// Supernode of an InvertedFactor: columns of L that are eliminated together.
struct InvertedNode {
    int first_column = 0;
    int width = 0;
    int first_row = 0; ///< into rows: the indices below the diagonal block
    int row_count = 0;
    int parent = -1; ///< node of the first of these rows
    int stride = 0;  ///< between the rows of the block, even
    std::size_t first_value = 0;

    TOILE_HD int height() const { return width + row_count; }
};

/// View of an InvertedFactor for kernels.
struct InvertedFactorView {
    View<const InvertedNode> nodes;
    View<const int> rows;
    View<const double> values;
    View<const int> first_child, children;
};

/// Supernodal factor in which both substitutions are products with dense blocks: selective inversion
/// [Raghavan 1998]. No thread waits for another within a supernode.
//
//      columns [first_column, first_column + width)
//        |  L11^-1      |   width x width, lower triangle
//        | -L21 L11^-1  |   (rows below) x width; their indices in `rows`
//
/// Subtrees of few columns become one node with a full block. On a GPU many small products cost more than
/// fewer ones with zeros.
class InvertedFactor {
public:
    /// Max columns of a subtree that becomes one node: two tiles (inverse_kernels.h). With 96 a block has a
    /// third more entries.
    static constexpr int kMergedColumns = 64;

    /// Inverts the blocks on all threads. A node costs its columns squared times its rows.
    /// @throws InvalidInput if the blocks hold more numbers than an int counts
    explicit InvertedFactor(const SupernodalFactor& factor);

    int size() const { return int(permutation_.size()); }
    int level_count() const { return int(first_of_level_.size()) - 1; }

    /// Nodes of a level, which do not depend on each other; level 0 has the roots.
    View<const int> level(int level) const
    {
        return View<const int>(nodes_of_levels_)
            .subview(first_of_level_[level], first_of_level_[level + 1] - first_of_level_[level]);
    }

    View<const InvertedNode> nodes() const { return nodes_; } ///< ascending columns, children first
    int level_of(int node) const { return level_of_[node]; }
    int node_of_column(int column) const { return node_of_column_[column]; }
    View<const int> rows() const { return rows_; }
    View<const double> values() const { return values_; } ///< row-major blocks, zeros up to their stride
    View<const int> first_child() const { return first_child_; } ///< [nodes + 1] into children
    View<const int> children() const { return children_; }
    View<const int> permutation() const { return permutation_; } ///< as the factor's
    InvertedFactorView view() const { return {nodes_, rows_, values_, first_child_, children_}; }

private:
    void merge(const SupernodalFactor& factor);
    void connect();
    void sort_into_levels();
    void invert(const SupernodalFactor& factor);

    std::vector<InvertedNode> nodes_;
    std::vector<int> first_supernode_; ///< [nodes + 1] first of the supernodes that a node replaces
    std::vector<int> rows_, permutation_, node_of_column_;
    std::vector<double> values_;
    std::vector<int> first_child_, children_;
    std::vector<int> level_of_, nodes_of_levels_, first_of_level_;
};

} // namespace toile
