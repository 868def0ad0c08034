#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/quadrature/device_kernel_table.h"
#include "core/quadrature/device_kernels.h"
#include "core/quadrature/device_packing.h"
#include "core/quadrature/quadrature_tables.h"

namespace toile {

/// QuadratureOperator on a GPU: the same lists and sums, in single precision throughout and in another order;
/// the same bits in every run. Weights are bytes where the accuracy asked for allows it, which changes the
/// operator a little, and so as single numbers as the CPU's where it says nothing. Its tables stay on the
/// device and serve any number of equal bodies at once.
class DeviceQuadrature {
public:
    /// @param space   borrowed, as what the tables are copied to
    /// @param tables  of one body, not needed afterwards
    /// @param node_count  of one body
    /// @param first   [bodies] where the nodes of each begin among those of all
    /// @param packing  which weights may be bytes
    /// @throws DeviceError where the device has not the memory
    DeviceQuadrature(const CudaSpace& space, const QuadratureTables& tables, int node_count,
                     const std::vector<int>& first = {0}, const PackingAccuracy& packing = {});

    /// The same from a table that was built on the device.
    /// @param basis  that the table was built with, not needed afterwards
    DeviceQuadrature(const CudaSpace& space, const ClusterBasis& basis, DeviceKernelTable kernel,
                     int node_count, const std::vector<int>& first = {0},
                     const PackingAccuracy& packing = {});

    /// Operators of one space that are applied side by side, each to nodes of its own.
    using Operators = View<DeviceQuadrature>;

    /// Enqueues x = H^-1 b, nearly, for every body; x = b, rounded, at fixed nodes.
    /// @param b, x  [nodes of all] on the device; not the same array
    static void solve(Operators all, View<const Vec3> b, View<Vec3> x);
    void solve(View<const Vec3> b, View<Vec3> x) { solve({this, 1}, b, x); }

    /// Its two passes, for whoever times them: moments of b, then the sums of every leaf.
    void gather_moments(View<const Vec3> b);
    void gather(View<Vec3> x);

    /// The passes where b is found, and x used, by the kernels themselves (device_quadrature.cuh).
    /// @param source  source(i, source.early(i)) is b at node i of all bodies, called once for each; what
    ///                early() may load see launch.cuh
    /// @param sink    sink(i, x) takes x at node i, called once for each; for none, mostly, where
    ///                sink.is_wanted() is false, which may not depend on the launch directly before
    template <typename Source>
    static void begin_solve(Operators all, const Source& source);
    template <typename Sink>
    static void end_solve(Operators all, const Sink& sink);

    /// What solve() must read of the tables [bytes].
    std::size_t table_bytes() const;

private:
    template <int Rank, typename Source>
    static void climb(Operators all, const Source& source);
    template <int Rank, typename Sink>
    static void gather_leaves(Operators all, const Sink& sink);
    template <int Rank>
    static int most_leaves(Operators all);
    template <int Rank>
    MomentsOfBodies<Rank> moments();

    const CudaSpace& space_;
    BasisView<float> basis_;
    PackedTable kernel_;
    DeviceArray<float> leaves_, transfers_;
    DeviceArray<int> nodes_; ///< [slots] those of leaves, then nodes that are in none
    DeviceArray<int> first_;
    DeviceArray<PaddedVec3> sources_, moments_;
};

} // namespace toile
