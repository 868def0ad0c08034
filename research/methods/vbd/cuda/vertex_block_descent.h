#pragma once

#include "core/compute/lanes.h"
#include "core/linear/sliced_rows.h"
#include "research/methods/cuda/baseline_method.h"
#include "research/methods/particle.h"
#include "research/methods/vbd/sweep_table.h"

namespace toile::research {

/// VertexBlockDescent on a GPU: the same colours in the same order, one kernel per colour, a team of threads
/// per vertex [Chen et al. 2024, section 4].
/// @tparam T  arithmetic of a vertex's Newton step, float or double; positions are double
template <typename T>
class DeviceVertexBlockDescent : public DeviceBaselineMethod {
public:
    struct Settings {
        int max_sweeps = 50; ///< number of sweeps; all of them are done
        double rho = 0.0;    ///< [-] as in VertexBlockDescent
        bool adaptive_start = true;

        /// Applies bending by its gradient at the start of a sweep. Its Hessian is the sum of absolute values
        /// of a row of K, which bounds K. A sweep then has a third of the colours, and bending lags. Our
        /// addition, not the paper's.
        bool lags_bending = false;
    };

    /// Colours the vertices. O(vertices).
    /// @throws InvalidInput as VertexBlockDescent, DeviceError if memory is insufficient
    DeviceVertexBlockDescent(const CudaSpace& space, const std::vector<Vec3>& positions,
                             const garment::ClothModel& cloth, const Settings& settings);

    int colour_count() const { return int(colours_.size()); }

    /// Sets the velocities at the start of the previous step [m/s], for the adaptive start of a step that
    /// does not continue the last one.
    void set_last_velocities(View<const Vec3> v) { v_before_.upload(v); }

private:
    DeviceVertexBlockDescent(const CudaSpace& space, const std::vector<Vec3>& positions,
                             const SweepTable<T>& table, const Settings& settings);
    void enqueue(double dt, const Fields& fields) override;
    int iterations() const override { return settings_.max_sweeps; }
    void enqueue_sweep(double dt);

    Settings settings_;
    garment::MembraneWeights weights_;
    std::vector<BlockRange> colours_;
    DeviceArray<SweepItem<T>> items_;
    DeviceArray<SweepTriangle<T>> triangles_;
    DeviceArray<SweepBend<T>> bends_;
    DeviceArray<int> first_entry_;  ///< of SlicedRows, if bending is lagged
    DeviceArray<RowEntry> bending_; ///< K [N/m]
    DeviceArray<PaddedVec3> lagged_;
    DeviceArray<Particle> particles_;
    DeviceArray<Vec3> prediction_, v_before_;
    DeviceArray<Vec3> last_, before_last_; ///< iterates of the Chebyshev recurrence
};

extern template class DeviceVertexBlockDescent<float>;
extern template class DeviceVertexBlockDescent<double>;

} // namespace toile::research
