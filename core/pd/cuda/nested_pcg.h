#pragma once

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/report.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/linear/cuda/solver.h"
#include "core/linear/pcg.h"
#include "core/pd/cuda/nested_pcg_kernels.h"
#include "core/pd/energy/system.h"

namespace toile {

class DeviceQuadratureSolver;

/// NestedPcg with BlockInverse on a GPU: an approximation of (H + dH)^-1 while contact is active.
class DeviceNestedPcg {
public:
    /// @param space  borrowed
    DeviceNestedPcg(const CudaSpace& space, int vertex_count, const Pcg::Settings& settings);

    /// Takes another H, its diagonal and the fixed vertices. @param solver  H^-1, borrowed
    void prepare(const System& system, DeviceSolver& solver);

    /// Computes z = (H + dH)^-1 g in at least one iteration. Each iteration reports before its end whether it
    /// is the last, so that the next is enqueued in time. z is valid in stream order.
    /// @param active  has frozen dH with at least one list
    /// @param g, z    [vertices] on the device [N], [m]
    Pcg::Outcome solve(DeviceActiveSet& active, View<const Vec3> g, View<Vec3> z);

private:
    PcgFields fields(View<Vec3> x);
    SystemRows rows() const;
    template <typename Source>
    void begin_inverse(const Source& source);
    template <typename Sink>
    void end_inverse(const Sink& sink);

    const CudaSpace& space_;
    Pcg::Settings settings_;
    DeviceSolver* solver_ = nullptr;
    DeviceQuadratureSolver* quadrature_ = nullptr; ///< solver_ if it is one: its kernels then include ours
    DeviceArray<int> first_;                       ///< see WholeRows
    DeviceArray<RowEntry> entries_;
    DeviceArray<float> sum_;
    DeviceArray<double> diagonal_;
    DeviceArray<unsigned char> fixed_;
    DeviceArray<Mat3> inverse_; ///< [lists]
    DeviceArray<PaddedVec3> r_, r_previous_, z_, p_, Kz_, Kp_;
    DeviceArray<Vec3> solver_b_, solver_x_; ///< [vertices] for other solvers, else empty
    DeviceArray<PcgScalars> scalars_;
    DeviceReport<PcgScalars> progress_;
    RecordScratch sums_;
};

} // namespace toile
