#include "core/linear/cuda/batched_inverses.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "core/compute/cuda/teams.cuh"

namespace toile {

BatchedInverses::BatchedInverses(const CudaSpace& space, const std::vector<int>& sizes)
    : space_(space), matrices_on_host_(sizes.size()), matrices_(space, "inverses/matrices"),
      tile_rows_(space, "inverses/tile_rows"), tile_pairs_(space, "inverses/tile_pairs"),
      entries_(space, "inverses/entries"), scales_(space, "inverses/scales"),
      products_(space, "inverses/products"), columns_(space, "inverses/columns"),
      inverses_(space, "inverses/inverses")
{
    std::vector<int> order(sizes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sizes[a] > sizes[b]; });

    std::vector<MatrixTile> tile_rows, tile_pairs;
    long entries = 0;
    for (const int m : order) {
        const int tiles = block_count(sizes[m], MatrixBatch::kTile);
        matrices_on_host_[m] = {int(entries), MatrixBatch::kTile * int(tile_rows.size()), tiles};
        entries += long(tiles) * tiles * MatrixBatch::kTileSize;
        if (entries > std::numeric_limits<int>::max())
            throw DeviceError("inverses: " + std::to_string(sizes.size()) +
                              " matrices have 2^31 entries or more; simulate fewer vertices");
        tile_row_counts_.resize(std::max(int(tile_row_counts_.size()), tiles));
        tile_pair_counts_.resize(tile_row_counts_.size());
        for (int i = 0; i < tiles; ++i) {
            tile_rows.push_back({m, i, i});
            for (int j = 0; j <= i; ++j)
                tile_pairs.push_back({m, i, j});
        }
        for (int k = 0; k < tiles; ++k) {
            tile_row_counts_[k] = int(tile_rows.size());
            tile_pair_counts_[k] = int(tile_pairs.size());
        }
    }
    matrices_.upload(matrices_on_host_);
    tile_rows_.upload(tile_rows);
    tile_pairs_.upload(tile_pairs);
    entries_.resize(int(entries));
    inverses_.resize(int(entries));
    scales_.resize(MatrixBatch::kTile * tile_rows_.size());
    products_.resize(MatrixBatch::kTileSize * tile_rows_.size());
    columns_.resize(MatrixBatch::kTileSize * tile_rows_.size());
}

MatrixBatch BatchedInverses::view()
{
    return {matrices_.view(), tile_rows_.view(), entries_.view(), inverses_.view()};
}

void BatchedInverses::invert()
{
    const MatrixBatch batch = view();
    parallel_for(space_, "inverses/scales", scales_.size(), FindScales{batch, scales_.view()});
    parallel_for_blocks<ScaleTile::kThreads>(space_, "inverses/scale", tile_pairs_.size(), 0,
                                             ScaleTile{batch, scales_.view(), tile_pairs_.view()});
    for (int k = 0; k < int(tile_row_counts_.size()); ++k) {
        parallel_for_blocks<SweepColumn::kThreads>(space_, "inverses/sweep_column", tile_row_counts_[k],
                                                   SweepColumn::kBytes,
                                                   SweepColumn{batch, k, products_.view(), columns_.view()});
        parallel_for_blocks<SweepTile::kThreads>(
            space_, "inverses/sweep", tile_pair_counts_[k], SweepTile::kBytes,
            SweepTile{batch, k, products_.view(), columns_.view(), tile_pairs_.view()});
    }
    parallel_for_blocks<StoreInverse::kThreads>(space_, "inverses/store", tile_pairs_.size(), 0,
                                                StoreInverse{batch, scales_.view(), tile_pairs_.view()});
}

} // namespace toile
