#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/linear/sparse_matrix.h"
#include "core/quadrature/tables/kernel_table.h"

namespace toile {

/// Data of quadrature for one H: cluster tree, cluster functions, and the inverse as a table. Immutable once
/// built, so that equal bodies share it.
struct QuadratureTables {
    struct Settings {
        KernelTable::Settings kernel;
        Extent extent = Extent::Surface; ///< of the set of points
    };

    ClusterTree tree; ///< of the free nodes
    ClusterBasis basis;
    KernelTable kernel;

    /// Builds tree and basis; leaves the kernel empty.
    QuadratureTables(View<const EmbeddedPoint> points, std::vector<int> nodes, Extent extent)
        : tree(points, std::move(nodes), extent), basis(tree, points)
    {
    }
    QuadratureTables(const QuadratureTables&) = delete; // the basis borrows the tree
    QuadratureTables& operator=(const QuadratureTables&) = delete;
};

/// Input of a build; borrowed.
struct TableInput {
    const SparseMatrix& H;            ///< [n x n] symmetric positive definite, compressed [N/m]
    View<const unsigned char> fixed;  ///< [n] 1 if row and column of H are the identity's
    View<const EmbeddedPoint> points; ///< [n] embedded points of the nodes
    QuadratureTables::Settings settings;
};

/// Tables with tree and basis but without the kernel.
std::shared_ptr<QuadratureTables> begin_tables(const TableInput& input);

/// Factors H and tabulates its inverse into tables that begin_tables() made from the same input. n solves:
/// seconds for 10 000 nodes.
/// @param progress  may be empty
/// @throws InvalidInput if H is not positive definite, Cancelled if `progress` returns false
void build_kernel(const TableInput& input, const BuildProgress& progress, QuadratureTables& tables);

/// Calls begin_tables(), then build_kernel().
std::shared_ptr<const QuadratureTables> build_tables(const TableInput& input, const BuildProgress& progress);

} // namespace toile
