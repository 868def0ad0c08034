#pragma once

#include <functional>

#include "core/backend/cuda/array.h"
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

    /// z = (H + dH)^-1 g. Waits to see whether that is enough when it has enqueued as many iterations as the
    /// solve before took, and then after each; what is too much changes nothing. Takes at least
    /// one.
    /// @param g, z  [vertices] on the device [N], [m]
    /// @param then  enqueues what is to be known of z beside it, before each wait: the last time counts
    Pcg::Outcome solve(View<const Vec3> g, View<Vec3> z, const std::function<void()>& then);

private:
    PcgFields fields(View<Vec3> x);
    BlocksInverse blocks_inverse() const;
    SystemRows rows() const;
    void iterate(const PcgFields& fields);
    const PcgScalars& read_back();

    const CudaSpace& space_;
    Pcg::Settings settings_;
    DeviceSolver* solver_ = nullptr;
    DeviceActiveSet* active_ = nullptr;
    DeviceArray<int> first_, column_;
    DeviceArray<float> value_, sum_;
    DeviceArray<double> diagonal_;
    DeviceArray<unsigned char> fixed_;
    DeviceArray<Mat3> inverse_; ///< [lists]
    DeviceArray<PaddedVec3> r_, r_previous_, z_, p_, Kz_, Kp_;
    DeviceArray<Vec3> scaled_, solved_;
    DeviceArray<PcgScalars> scalars_;
    PinnedArray<PcgScalars> on_host_;
    int expected_iterations_ = 1;
    RecordScratch sums_;
};

} // namespace toile
