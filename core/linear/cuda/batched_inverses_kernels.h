#pragma once

/// Kernels of BatchedInverses: the sweep operator [Goodnight 1979] on tiles of 48 rows. Sweeping tile k of a
/// symmetric matrix A, with P = A_kk^-1, is
///
///   A_ij -= A_ik P A_kj,   A_ik = A_ik P,   A_kk = -P;
///
/// A stays symmetric, so that its lower tiles suffice, and is -A^-1 after all tiles.

#include <cmath>
#include <cstddef>

#include "core/compute/team.h"
#include "core/compute/types.h"

namespace toile {

/// Tile (row, column) of a matrix.
struct MatrixTile {
    int matrix, row, column;
};

/// Matrices as kernels read and write them: rows are padded to whole tiles.
struct MatrixBatch {
    static constexpr int kTile = 48, kTileSize = kTile * kTile;

    struct Matrix {
        int first_entry; ///< of its entries and its inverse
        int first_row;   ///< among the padded rows of all
        int tiles;       ///< a row
        TOILE_HD int stride() const { return kTile * tiles; }
    };
    View<const Matrix> matrices;
    View<const MatrixTile> tile_rows; ///< all (matrix, row, row): large matrices first
    View<double> entries;             ///< row by row
    View<float> inverses;             ///< likewise; zero where padded

    TOILE_HD double& entry(int matrix, int i, int j) const
    {
        const Matrix& m = matrices[matrix];
        return entries[m.first_entry + i * m.stride() + j];
    }
    /// Entry (0, 0) of a tile of `numbers`.
    template <typename Number>
    TOILE_HD Number* tile(View<Number> numbers, int matrix, int row, int column) const
    {
        const Matrix& m = matrices[matrix];
        return numbers.data() + m.first_entry + kTile * (row * m.stride() + column);
    }
};

/// A thread of a block that works on a tile: it has the entries (i + 12 a, j + 12 b).
struct TileThread {
    static constexpr int kTile = MatrixBatch::kTile, kSquare = 4, kSide = kTile / kSquare;
    static constexpr int kThreads = kSide * kSide; ///< of the block

    using Square = double[kSquare][kSquare];

    int i, j;

    TOILE_HD explicit TileThread(int thread) : i(thread / kSide), j(thread % kSide) {}

    /// Calls visit(row, column in the tile, entry) for its entries.
    template <typename Visit>
    TOILE_HD void for_square(Square& square, const Visit& visit) const
    {
        for (int a = 0; a < kSquare; ++a)
            for (int b = 0; b < kSquare; ++b)
                visit(i + kSide * a, j + kSide * b, square[a][b]);
    }
};

/// Calls visit(row, column of the matrix) for a thread's entries of a lower tile: of one on the diagonal,
/// those that are not above it.
template <typename Visit>
TOILE_HD void for_lower_entries(const MatrixTile& tile, int thread, const Visit& visit)
{
    for (int k = thread; k < MatrixBatch::kTileSize; k += TileThread::kThreads) {
        const int i = MatrixBatch::kTile * tile.row + k / MatrixBatch::kTile;
        const int j = MatrixBatch::kTile * tile.column + k % MatrixBatch::kTile;
        if (j <= i)
            visit(i, j);
    }
}

/// Scales of the rows to a unit diagonal, zero for rows without entries.
struct FindScales {
    MatrixBatch batch;
    View<double> scales; ///< [padded rows of all]

    TOILE_HD void operator()(int item) const
    {
        const MatrixTile tile = batch.tile_rows[item / MatrixBatch::kTile];
        const int row = MatrixBatch::kTile * tile.row + item % MatrixBatch::kTile;
        const double diagonal = batch.entry(tile.matrix, row, row);
        scales[batch.matrices[tile.matrix].first_row + row] =
            diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 0.0;
    }
};

/// Scales a lower tile, and takes the mean of both triangles.
struct ScaleTile {
    static constexpr int kThreads = TileThread::kThreads;

    MatrixBatch batch;
    View<const double> scales;
    View<const MatrixTile> tile_pairs;

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        const MatrixTile tile = tile_pairs[item];
        const int first = batch.matrices[tile.matrix].first_row;
        for_lower_entries(tile, block.thread, [&](int i, int j) {
            const double mean = 0.5 * (batch.entry(tile.matrix, i, j) + batch.entry(tile.matrix, j, i));
            const double scaled = mean * scales[first + i] * scales[first + j];
            batch.entry(tile.matrix, i, j) = scaled;
            if (tile.row == tile.column)
                batch.entry(tile.matrix, j, i) = scaled;
        });
    }
};

/// Computes A_ik P for tile k of each row i. Rows that depend on others are left out: zero in P.
struct SweepColumn {
    static constexpr int kThreads = TileThread::kThreads, kTile = MatrixBatch::kTile;
    static constexpr std::size_t kBytes = sizeof(double) * (2 * MatrixBatch::kTileSize + 4 * kTile);

    /// Smallest pivot [-] of a row that counts as independent. With 1e-6, an inverse with entries of 6e8 was
    /// indefinite in single precision: beside fixed vertices there are all degrees of dependence.
    static constexpr double kDependent = 1e-4;

    MatrixBatch batch;
    int k;
    View<double> products, columns; ///< [tile rows][kTileSize] out: A_ik P, and P itself for i = k; A_ik

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        double* const P = static_cast<double*>(block.memory);
        double* const C = P + MatrixBatch::kTileSize;
        double* const pivots = C + MatrixBatch::kTileSize;
        const MatrixTile tile = batch.tile_rows[item];
        const int stride = batch.matrices[tile.matrix].stride();
        const TileThread own(block.thread);
        const std::size_t at = std::size_t(item) * MatrixBatch::kTileSize;

        const double* const diagonal = batch.tile(batch.entries, tile.matrix, k, k);
        TileThread::Square square;
        own.for_square(square, [&](int i, int j, double& a) { a = diagonal[i * stride + j]; });
        invert(block, own, square, pivots);
        own.for_square(square, [&](int i, int j, double& a) { P[i * kTile + j] = a; });
        if (tile.row == k) {
            own.for_square(square, [&](int i, int j, double& a) { products.data()[at + i * kTile + j] = a; });
            return;
        }
        // Of A_ik = A_ki^T the lower tile is stored.
        const bool is_lower = tile.row > k;
        const double* const from = is_lower ? batch.tile(batch.entries, tile.matrix, tile.row, k)
                                            : batch.tile(batch.entries, tile.matrix, k, tile.row);
        for (int e = block.thread; e < MatrixBatch::kTileSize; e += kThreads) {
            const int i = e / kTile, j = e % kTile;
            const double value = from[i * stride + j];
            C[is_lower ? e : j * kTile + i] = value;
            columns.data()[at + (is_lower ? e : j * kTile + i)] = value;
        }
        block.wait();
        TileThread::Square sum = {};
        for (int l = 0; l < kTile; ++l)
            own.for_square(sum, [&](int i, int j, double& s) { s += C[i * kTile + l] * P[l * kTile + j]; });
        own.for_square(sum, [&](int i, int j, double& s) { products.data()[at + i * kTile + j] = s; });
    }

private:
    /// Gauss-Jordan elimination in registers.
    template <typename Block>
    TOILE_HD static void invert(const Block& block, const TileThread& own, TileThread::Square& a,
                                double* pivots)
    {
        constexpr int kSquare = TileThread::kSquare, kSide = TileThread::kSide;
        for (int first = 0; first < kSide; ++first)
            for (int l = 0; l < kSquare; ++l) { // known at compile time, or a leaves the registers
                const int k = first + kSide * l;
                double* const row = pivots + (l & 1) * 2 * kTile; // two of them, by turns
                double* const column = row + kTile;
                for (int b = 0; b < kSquare; ++b) {
                    if (own.i == first)
                        row[own.j + kSide * b] = a[l][b];
                    if (own.j == first)
                        column[own.i + kSide * b] = a[b][l];
                }
                block.wait();
                const double inverse = row[k] > kDependent ? 1.0 / row[k] : 0.0;
                own.for_square(a, [&](int i, int j, double& entry) {
                    const double r = j == k ? 1.0 : row[j];
                    if (i == k)
                        entry = r * inverse;
                    else
                        entry = (j == k ? 0.0 : entry) - column[i] * inverse * r;
                });
            }
    }
};

/// Sweeps tile k out of a lower tile.
struct SweepTile {
    static constexpr int kThreads = TileThread::kThreads, kTile = MatrixBatch::kTile;
    static constexpr int kDepth = kTile / 2; ///< columns in shared memory at a time
    static constexpr std::size_t kBytes = sizeof(double) * 2 * kTile * (kDepth + 1);

    MatrixBatch batch;
    int k;
    View<const double> products, columns; ///< see SweepColumn
    View<const MatrixTile> tile_pairs;

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        constexpr int kRow = kDepth + 1;
        const MatrixTile tile = tile_pairs[item];
        const int stride = batch.matrices[tile.matrix].stride();
        const int first = batch.matrices[tile.matrix].first_row / kTile;
        double* const A = batch.tile(batch.entries, tile.matrix, tile.row, tile.column);
        const TileThread own(block.thread);
        TileThread::Square square;
        if (tile.row == k || tile.column == k) {
            const int other = tile.row == k ? tile.column : tile.row;
            const double* const W = product_of(first + other);
            const bool is_transposed = tile.row == k;
            const double sign = tile.row == tile.column ? -1.0 : 1.0;
            own.for_square(square, [&](int i, int j, double&) {
                A[i * stride + j] = sign * W[is_transposed ? j * kTile + i : i * kTile + j];
            });
            return;
        }
        double* const W = static_cast<double*>(block.memory);
        double* const C = W + kTile * kRow;
        const double* const from_W = product_of(first + tile.row);
        const double* const from_C =
            columns.data() + std::size_t(first + tile.column) * MatrixBatch::kTileSize;
        own.for_square(square, [&](int i, int j, double& a) { a = A[i * stride + j]; });
        for (int part = 0; part < kTile; part += kDepth) {
            for (int e = block.thread; e < kTile * kDepth; e += kThreads) {
                const int i = e / kDepth, l = e % kDepth;
                W[i * kRow + l] = from_W[i * kTile + part + l];
                C[i * kRow + l] = from_C[i * kTile + part + l];
            }
            block.wait();
            for (int l = 0; l < kDepth; ++l)
                own.for_square(square,
                               [&](int i, int j, double& a) { a -= W[i * kRow + l] * C[j * kRow + l]; });
            block.wait();
        }
        own.for_square(square, [&](int i, int j, double& a) { A[i * stride + j] = a; });
    }

private:
    TOILE_HD const double* product_of(int tile_row) const
    {
        return products.data() + std::size_t(tile_row) * MatrixBatch::kTileSize;
    }
};

/// Writes a lower tile of the inverse, and its transpose.
struct StoreInverse {
    static constexpr int kThreads = TileThread::kThreads;

    MatrixBatch batch;
    View<const double> scales;
    View<const MatrixTile> tile_pairs;

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        const MatrixTile tile = tile_pairs[item];
        const MatrixBatch::Matrix& m = batch.matrices[tile.matrix];
        for_lower_entries(tile, block.thread, [&](int i, int j) {
            const double scaled = -batch.entry(tile.matrix, i, j);
            const float value = float(scaled * scales[m.first_row + i] * scales[m.first_row + j]);
            batch.inverses[m.first_entry + i * m.stride() + j] = value;
            batch.inverses[m.first_entry + j * m.stride() + i] = value;
        });
    }
};

} // namespace toile
