#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/linear/sparse_matrix.h"
#include "core/quadrature/kernel_table.h"

namespace toile {

/// What quadrature needs of one H: where its clusters are, their functions, and its inverse as a table. Never
/// changes once built, so that equal bodies share it.
struct QuadratureTables {
    struct Settings {
        KernelTable::Settings kernel;
        Extent extent = Extent::Surface; ///< what the places fill
    };

    ClusterTree tree; ///< of the free nodes
    ClusterBasis basis;
    KernelTable kernel;

    /// Tree and basis; the kernel is still to come.
    QuadratureTables(View<const Place> places, std::vector<int> nodes, Extent extent)
        : tree(places, std::move(nodes), extent), basis(tree, places)
    {
    }
    QuadratureTables(const QuadratureTables&) = delete; // the basis borrows the tree
    QuadratureTables& operator=(const QuadratureTables&) = delete;
};

/// What tables are made of; borrowed.
struct TableInput {
    const SparseMatrix& H;           ///< [n x n] symmetric positive definite, compressed [N/m]
    View<const unsigned char> fixed; ///< [n] 1 where row and column of H are the identity's
    View<const Place> places;        ///< [n] where the nodes are
    QuadratureTables::Settings settings;
};

/// The tables' tree and basis: all that does not take the inverse.
std::shared_ptr<QuadratureTables> begin_tables(const TableInput& input);

/// Factors H and tabulates its inverse into tables begun with the same input. N solves: seconds for 10 000
/// nodes.
/// @param progress  may be empty
/// @throws InvalidInput where H is not positive definite, Cancelled where `progress` returned false
void build_kernel(const TableInput& input, const BuildProgress& progress, QuadratureTables& tables);

/// Both.
std::shared_ptr<const QuadratureTables> build_tables(const TableInput& input, const BuildProgress& progress);

} // namespace toile
