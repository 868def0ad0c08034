#pragma once

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/report.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/linear/device_solver.h"
#include "core/linear/pcg.h"
#include "core/pd/device/nested_pcg_kernels.h"
#include "core/pd/system.h"

namespace toile {

/// NestedPcg with BlockInverse on a GPU: (H + dH)^-1, or close to it, while contact presses.
class DeviceNestedPcg {
public:
    /// @param space  borrowed
    DeviceNestedPcg(const CudaSpace& space, int vertex_count, const Pcg::Settings& settings);

    /// Takes over H, its diagonal and what is fixed. @param solver  H^-1, borrowed
    void prepare(const System& system, DeviceSolver& solver);

    /// Enqueues the inverses of the blocks that were frozen last. @param active  borrowed until the next
    void update(DeviceActiveSet& active);

    /// z = (H + dH)^-1 g, at least one iteration. Each reports before it ends whether it is the last, so that
    /// the next comes in time; z itself is there in the stream's turn.
    /// @param g, z  [vertices] on the device [N], [m]
    Pcg::Outcome solve(View<const Vec3> g, View<Vec3> z);

private:
    PcgFields fields(View<Vec3> x);
    BlocksInverse blocks_inverse() const;
    SystemRows rows() const;
    void iterate(const PcgFields& fields);

    const CudaSpace& space_;
    Pcg::Settings settings_;
    DeviceSolver* solver_ = nullptr;
    DeviceActiveSet* active_ = nullptr;
    DeviceArray<int> first_; ///< of WholeRows
    DeviceArray<RowEntry> entries_;
    DeviceArray<float> sum_;
    DeviceArray<double> diagonal_;
    DeviceArray<unsigned char> fixed_;
    DeviceArray<Mat3> inverse_; ///< [lists]
    DeviceArray<PaddedVec3> r_, r_previous_, z_, p_, Kz_, Kp_;
    DeviceArray<Vec3> scaled_, solved_;
    DeviceArray<PcgScalars> scalars_;
    DeviceReport<PcgScalars> progress_;
    RecordScratch sums_;
};

} // namespace toile
