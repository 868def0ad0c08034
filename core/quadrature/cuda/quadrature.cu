#include "core/quadrature/cuda/quadrature.cuh"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace toile {

namespace {

std::vector<float> single(View<const double> values) { return {values.begin(), values.end()}; }

/// Slots of the leaves, followed by one slot per node outside all leaves.
std::vector<int> with_others(View<const int> of_leaves, int node_count)
{
    std::vector<unsigned char> is_known(node_count, 0);
    for (const int v : of_leaves)
        if (v >= 0)
            is_known[v] = 1;
    std::vector<int> slots(of_leaves.begin(), of_leaves.end());
    for (int v = 0; v < node_count; ++v)
        if (!is_known[v])
            slots.push_back(v);
    return slots;
}

/// SlotsOfBodies::rows
std::vector<int> rows_of(const std::vector<int>& slots, const std::vector<std::vector<int>>& rows)
{
    std::vector<int> all;
    all.reserve(rows.size() * slots.size());
    for (const std::vector<int>& of_body : rows)
        for (const int v : slots)
            all.push_back(v < 0 ? -1 : of_body[v]);
    return all;
}

} // namespace

DeviceQuadrature::DeviceQuadrature(const CudaSpace& space, const QuadratureTables& tables,
                                   const std::vector<std::vector<int>>& rows, const PackingAccuracy& packing)
    : DeviceQuadrature(space, tables.basis, DeviceKernelTable(space, tables.kernel), rows, packing)
{
}

DeviceQuadrature::DeviceQuadrature(const CudaSpace& space, const ClusterBasis& basis,
                                   DeviceKernelTable kernel, const std::vector<std::vector<int>>& rows,
                                   const PackingAccuracy& packing)
    : space_(space), kernel_(pack_table(space, std::move(kernel), basis.tree(), packing)),
      leaves_(space, "quadrature/leaves"), transfers_(space, "quadrature/transfers"),
      bodies_(int(rows.size())), rows_(space, "quadrature/rows"), sources_(space, "quadrature/sources"),
      moments_(space, "quadrature/moments", bodies_ * basis.rank() * basis.tree().cluster_count())
{
    leaves_.upload(single(basis.leaves()));
    transfers_.upload(single(basis.transfers()));
    rows_.upload(rows_of(with_others(basis.tree().nodes(), int(rows.front().size())), rows));
    sources_.resize(rows_.size());

    const BasisView<double>& view = basis.view();
    basis_.rank = view.rank;
    basis_.leaf_count = view.leaf_count;
    std::copy(std::begin(view.first_of_level), std::end(view.first_of_level),
              std::begin(basis_.first_of_level));
    basis_.leaves = leaves_.view();
    basis_.transfers = transfers_.view();
}

std::size_t DeviceQuadrature::table_bytes() const
{
    return kernel_.packed.bytes() + kernel_.rest.bytes() +
           (std::size_t(leaves_.size()) + transfers_.size()) * sizeof(float);
}

void DeviceQuadrature::solve(Operators all, View<const Vec3> b, View<Vec3> x)
{
    const StageScope stage("quadrature/solve");
    begin_solve(all, LoadField{b});
    end_solve(all, StoreField{x});
}

void DeviceQuadrature::gather_moments(View<const Vec3> b) { begin_solve({this, 1}, LoadField{b}); }

void DeviceQuadrature::gather(View<Vec3> x) { end_solve({this, 1}, StoreField{x}); }

} // namespace toile
