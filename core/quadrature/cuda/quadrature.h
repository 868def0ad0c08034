#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/quadrature/cuda/kernel_table.h"
#include "core/quadrature/cuda/kernels.h"
#include "core/quadrature/cuda/packing.h"
#include "core/quadrature/tables/quadrature_tables.h"

namespace toile {

/// QuadratureOperator on a GPU, for any number of equal bodies at once. It has the same lists and sums, in
/// single precision and in another order; every run gives the same bits. Weights are bytes if the given
/// accuracy allows it, which changes the operator slightly. Without an accuracy they are single numbers, as
/// on the CPU. The tables stay on the device.
class DeviceQuadrature {
public:
    /// @param space   borrowed; device of the tables
    /// @param tables  of one body, not needed afterwards
    /// @param rows    [bodies][nodes of one] place of every node among those of all bodies
    /// @param packing  accuracy that decides which weights may be bytes
    /// @throws DeviceError if the device has too little memory
    DeviceQuadrature(const CudaSpace& space, const QuadratureTables& tables,
                     const std::vector<std::vector<int>>& rows, const PackingAccuracy& packing = {});

    /// Takes a table that was built on the device.
    /// @param basis  basis of that table, not needed afterwards
    DeviceQuadrature(const CudaSpace& space, const ClusterBasis& basis, DeviceKernelTable kernel,
                     const std::vector<std::vector<int>>& rows, const PackingAccuracy& packing = {});

    /// Operators of one space that are applied together, each to its own nodes.
    using Operators = View<DeviceQuadrature>;

    /// Enqueues x = H^-1 b, approximately, for every body; x = b, rounded, at fixed nodes.
    /// @param b, x  [nodes of all bodies] on the device; not the same array
    static void solve(Operators all, View<const Vec3> b, View<Vec3> x);
    void solve(View<const Vec3> b, View<Vec3> x) { solve({this, 1}, b, x); }

    /// The two passes, for separate timings: moments of b, then the sums of every leaf.
    void gather_moments(View<const Vec3> b);
    void gather(View<Vec3> x);

    /// Passes whose kernels compute b and consume x themselves (see quadrature.cuh).
    /// @param source  source(i, source.prologue(i)) is b at node i of all bodies, called once per node;
    ///                core/compute/cuda/launch.cuh says what prologue() may load
    /// @param sink    sink(i, x) receives x at node i, called once per node. If sink.is_wanted() is false,
    ///                most calls are omitted; is_wanted() must not depend on the previous launch.
    template <typename Source>
    static void begin_solve(Operators all, const Source& source);
    template <typename Sink>
    static void end_solve(Operators all, const Sink& sink);

    /// Size of the tables that solve() reads [bytes].
    std::size_t table_bytes() const;

private:
    template <int Rank, typename Source>
    static void upward_pass(Operators all, const Source& source);
    template <int Rank, typename Sink>
    static void gather_leaves(Operators all, const Sink& sink);
    template <int Rank>
    static int max_leaves(Operators all);
    template <int Rank>
    MomentsOfBodies<Rank> moments();
    SlotsOfBodies slots() const { return {rows_.view(), rows_.size() / bodies_}; }

    const CudaSpace& space_;
    BasisView<float> basis_;
    PackedTable kernel_;
    DeviceArray<float> leaves_, transfers_;
    int bodies_;
    DeviceArray<int> rows_; ///< see SlotsOfBodies
    DeviceArray<PaddedVec3> sources_, moments_;
};

} // namespace toile
