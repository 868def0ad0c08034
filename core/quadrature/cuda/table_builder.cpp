#include "core/quadrature/cuda/table_builder.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/stages.h"
#include "core/quadrature/solve_costs.h"

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;
constexpr int kMultiple = DeviceInverseColumns::kColumnMultiple;

/// Memory reserved for the table relative to the expected size [-]: stiff cloth has longer lists.
constexpr double kTableReserve = 2.0;

/// Fraction of the memory beyond factor and table that a block may take.
constexpr double kBlockFraction = 0.8;

/// Capacity of the table's arrays relative to the size extrapolated from the finished blocks [-], so that
/// they grow once or twice.
constexpr double kGrowthReserve = 1.2;

constexpr int kMaxNumbers = std::numeric_limits<int>::max();

/// Maximum number of rows in the fronts of a block.
int max_front_rows(const InvertedFactor& factor, const ClusterTree& tree, int columns)
{
    std::vector<int> row_of(factor.size());
    for (int k = 0; k < factor.size(); ++k)
        row_of[factor.permutation()[k]] = k;
    int max_rows = 0;
    for (int first = 0; first < tree.nodes().size(); first += columns) {
        std::vector<int> rows;
        for (int slot = first; slot < std::min(first + columns, tree.nodes().size()); ++slot)
            rows.push_back(tree.nodes()[slot] >= 0 ? row_of[tree.nodes()[slot]] : -1);
        max_rows = std::max(max_rows, plan_forward(factor, rows).front_rows);
    }
    return max_rows;
}

/// Device memory per column [bytes].
std::size_t column_bytes(const InvertedFactor& factor, const ClusterBasis& basis, int front_rows)
{
    const std::size_t clusters = (basis.rank() + 1) * std::size_t(basis.tree().cluster_count());
    const std::size_t found = std::size_t(basis.tree().leaf_count() + FoundEntries::kMax) / kLeaf;
    return DeviceInverseColumns::column_bytes(factor, front_rows) + clusters * sizeof(double) +
           3 * found * sizeof(int);
}

/// Grows to `needed` items, or to the size extrapolated from the finished fraction of the table.
template <typename T>
void grow(DeviceArray<T>& array, std::size_t needed, double fraction)
{
    if (needed > std::size_t(kMaxNumbers))
        throw InvalidInput("quadrature tables are too large: one has " + std::to_string(needed) +
                           " numbers and more, 2^31 - 1 are the most; raise the tolerance");
    if (needed > std::size_t(array.size())) {
        const double expected = kGrowthReserve * double(needed) / fraction;
        array.resize_keeping(std::max(int(needed), int(std::min(expected, double(kMaxNumbers)))));
    }
}

} // namespace

/// Largest block within the requested columns, the free memory, and the range of int for its numbers.
DeviceTableBuilder::BlockSize DeviceTableBuilder::choose_block(const CudaSpace& space,
                                                               const InvertedFactor& factor,
                                                               const ClusterBasis& basis, int max_columns)
{
    TOILE_ASSERT(max_columns > 0 && max_columns % kMultiple == 0);
    const int n = factor.size(), slots = basis.tree().nodes().size();
    const std::string who = "quadrature tables of " + std::to_string(n) + " nodes";
    const int wanted = std::min(max_columns, (slots / kMultiple + 1) * kMultiple);
    const int front_rows = max_front_rows(factor, basis.tree(), wanted);
    const int max_rows = std::max({n, front_rows, basis.rank() * basis.tree().cluster_count(), 1});
    const int countable = kMaxNumbers / max_rows / kMultiple * kMultiple;
    if (countable == 0)
        throw InvalidInput(who + " are too large for a GPU");

    const std::size_t of_column = column_bytes(factor, basis, front_rows);
    const double table = kTableReserve * sizeof(float) * n * expected_gathers(std::max(n, 1));
    const std::size_t fixed = DeviceInverseColumns::fixed_bytes(factor) + std::size_t(table);
    space.require_memory(fixed + kMultiple * of_column, who + " need about");
    const double left = kBlockFraction * double(space.free_memory() - fixed) / double(of_column);
    const int fitting = int(std::min(left, double(wanted))) / kMultiple * kMultiple;
    return {std::max(std::min(fitting, countable), kMultiple), front_rows};
}

DeviceTableBuilder::DeviceTableBuilder(const CudaSpace& space, const InvertedFactor& factor,
                                       View<const double> diagonal, const ClusterBasis& basis,
                                       const KernelTable::Settings& settings, int max_columns)
    : space_(space), basis_(basis), size_(choose_block(space, factor, basis, max_columns)),
      inverse_(space, factor), tree_(basis.view()), table_(space, basis.rank(), basis.tree().leaf_count()),
      leaves_(space, "tables/leaves"), transfers_(space, "tables/transfers"),
      diagonal_(space, "tables/diagonal"), limits_(space, "tables/limits"), nodes_(space, "tables/nodes"),
      row_of_slot_(space, "tables/row_of_slot"), moments_(space, "tables/moments"),
      squares_(space, "tables/squares"), found_(space, "tables/found"),
      near_counts_(space, "tables/near_counts"), far_counts_(space, "tables/far_counts"),
      totals_(space, "tables/totals", 2), near_sums_(space, "tables/near_sums"),
      far_sums_(space, "tables/far_sums"), scratch_(space, "tables/scratch"),
      totals_on_host_(space, "tables/totals", 2)
{
    const ClusterTree& tree = basis.tree();
    inverse_.reserve(size_.columns, size_.front_rows);
    upload_tree(diagonal, settings.tolerance);
    moments_.resize(basis.rank() * tree.cluster_count() * size_.columns);
    squares_.resize(tree.cluster_count() * size_.columns);

    block_.part_level = std::min(FoundEntries::kLevel, tree.level_count() - 1);
    block_.parts = tree.level_size(block_.part_level);
    const int parts = size_.columns / kLeaf * block_.parts;
    found_.resize(parts * FoundEntries::kMax);
    for (DeviceArray<int>* counts : {&near_counts_, &far_counts_}) {
        counts->resize(parts + 1);
        counts->fill_zero(); // the last item, for the total, is no part
    }
    for (DeviceArray<long>* sums : {&near_sums_, &far_sums_})
        sums->resize(parts + 1);
}

void DeviceTableBuilder::upload_tree(View<const double> diagonal, double tolerance)
{
    const ClusterTree& tree = basis_.tree();
    leaves_.upload(basis_.leaves());
    transfers_.upload(basis_.transfers());
    tree_.leaves = leaves_.view();
    tree_.transfers = transfers_.view();
    diagonal_.upload(diagonal);
    limits_.upload(far_limits(tree, diagonal, tolerance));
    nodes_.upload(tree.nodes());
    std::vector<int> row_of_slot;
    for (const int v : tree.nodes())
        row_of_slot.push_back(v >= 0 ? inverse_.row_of(v) : -1);
    row_of_slot_.upload(row_of_slot);
}

int DeviceTableBuilder::block_count() const
{
    return (basis_.tree().nodes().size() + size_.columns - 1) / size_.columns;
}

View<const int> DeviceTableBuilder::targets() const
{
    return basis_.tree().nodes().subview(block_.first * kLeaf, block_.count * kLeaf);
}

void DeviceTableBuilder::solve(int block)
{
    block_.first = block * (size_.columns / kLeaf);
    block_.count = std::min(size_.columns / kLeaf, basis_.tree().leaf_count() - block_.first);
    inverse_.solve(targets());
}

void DeviceTableBuilder::append_lists()
{
    find_entries();
    count_entries();
    space_.synchronise();
    const int near_count = totals_on_host_[0], far_count = totals_on_host_[1];
    grow_table(near_count, far_count);
    write_lists(near_count, far_count);
    near_entries_ += near_count;
    far_entries_ += far_count;
}

void DeviceTableBuilder::grow_table(int near_count, int far_count)
{
    const double fraction = double(block_.first + block_.count) / basis_.tree().leaf_count();
    const std::size_t near = std::size_t(near_entries_) + near_count;
    const std::size_t far = std::size_t(far_entries_) + far_count;
    grow(table_.near_weights, near * KernelTable::kNearWeights, fraction);
    grow(table_.near_leaf, near, fraction);
    grow(table_.far_weights, far * table_.rank * KernelTable::kTargets, fraction);
    grow(table_.far_cluster, far, fraction);
}

DeviceKernelTable DeviceTableBuilder::take()
{
    table_.near_leaf.resize_keeping(near_entries_);
    table_.near_weights.resize_keeping(near_entries_ * KernelTable::kNearWeights);
    table_.far_cluster.resize_keeping(far_entries_);
    table_.far_weights.resize_keeping(far_entries_ * table_.rank * KernelTable::kTargets);
    return std::move(table_);
}

ClusterColumns DeviceTableBuilder::clusters()
{
    return {basis_.rank(), {moments_.view().data(), size_.columns}, {squares_.view().data(), size_.columns}};
}

SlotColumns DeviceTableBuilder::slots() { return {row_of_slot_.view(), inverse_.rows()}; }

FoundEntries DeviceTableBuilder::entries()
{
    return {found_.view(), near_counts_.view(), far_counts_.view()};
}

EntryOffsets DeviceTableBuilder::offsets() const
{
    return {near_sums_.view().subview(0, parts() + 1), far_sums_.view().subview(0, parts() + 1),
            near_entries_, far_entries_};
}

std::optional<DeviceKernelTable> build_kernel_table(const CudaSpace& space, const SupernodalFactor& factor,
                                                    View<const double> diagonal, const ClusterBasis& basis,
                                                    const KernelTable::Settings& settings,
                                                    const BuildProgress& progress)
{
    const StageScope stage("quadrature/build");
    const InvertedFactor inverted(factor);
    DeviceTableBuilder builder(space, inverted, diagonal, basis, settings);
    for (int block = 0; block < builder.block_count(); ++block) {
        builder.solve(block);
        builder.gather_moments();
        builder.append_lists();
        if (progress && !progress(double(block + 1) / builder.block_count()))
            return std::nullopt;
    }
    return builder.take();
}

} // namespace toile
