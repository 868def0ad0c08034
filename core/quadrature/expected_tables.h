#pragma once

#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Expected cost of the tables of one body, from its number of nodes alone: before a matrix exists. Fitted to
/// measurements (docs/performance.md#tables), of stiff bodies on loaded machines: tables of soft bodies are
/// smaller by up to a third.
struct ExpectedTables {
    double seconds = 0.0; ///< [s] factoring and building
    double bytes = 0.0;   ///< [bytes] once built
};

/// Tables on a CPU, with single weights.
/// @param nodes    at least one
/// @param threads  that build
ExpectedTables expected_tables(int nodes, Extent extent, int threads);

/// Tables on a GPU, most weights of which are bytes. Their matrix is factored by the host, with 16 threads
/// where this was measured.
ExpectedTables expected_tables_on_gpu(int nodes, Extent extent);

} // namespace toile
