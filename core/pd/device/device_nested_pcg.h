#pragma once

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/report.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/linear/device_solver.h"
#include "core/linear/pcg.h"
#include "core/pd/device/nested_pcg_kernels.h"
#include "core/pd/system.h"

namespace toile {

class DeviceQuadratureSolver;

/// NestedPcg with BlockInverse on a GPU: (H + dH)^-1, or close to it, while contact presses.
class DeviceNestedPcg {
public:
    /// @param space  borrowed
    DeviceNestedPcg(const CudaSpace& space, int vertex_count, const Pcg::Settings& settings);

    /// Takes over H, its diagonal and what is fixed. @param solver  H^-1, borrowed
    void prepare(const System& system, DeviceSolver& solver);

    /// z = (H + dH)^-1 g, at least one iteration. Each reports before it ends whether it is the last, so that
    /// the next comes in time; z itself is there in the stream's turn.
    /// @param active  has frozen dH, and touches something
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
    DeviceQuadratureSolver* quadrature_ = nullptr; ///< the same, where it is one: its kernels do ours too
    DeviceArray<int> first_;                       ///< of WholeRows
    DeviceArray<RowEntry> entries_;
    DeviceArray<float> sum_;
    DeviceArray<double> diagonal_;
    DeviceArray<unsigned char> fixed_;
    DeviceArray<Mat3> inverse_; ///< [lists]
    DeviceArray<PaddedVec3> r_, r_previous_, z_, p_, Kz_, Kp_;
    DeviceArray<Vec3> solver_b_, solver_x_; ///< [vertices] for any other solver, else empty
    DeviceArray<PcgScalars> scalars_;
    DeviceReport<PcgScalars> progress_;
    RecordScratch sums_;
};

} // namespace toile
