#pragma once

#include "core/backend/lanes.h"
#include "core/linear/sliced_rows.h"
#include "garment/rivals/device_rival.h"
#include "garment/rivals/particle.h"
#include "garment/rivals/sweep_table.h"

namespace toile {

struct ClothModel;

/// VertexBlockDescent on a GPU: the same colours in the same order, a kernel a colour, a team of threads a
/// vertex [Chen et al. 2024, section 4].
/// @tparam T  arithmetic of a vertex's Newton step, float or double; places are double
template <typename T>
class DeviceVertexBlockDescent : public DeviceRival {
public:
    struct Settings {
        int max_sweeps = 50; ///< all of them are done
        double rho = 0.0;    ///< [-] as VertexBlockDescent's
        bool adaptive_start = true;

        /// Bending acts by its gradient at the start of a sweep, with the sizes of a row of K added up as its
        /// Hessian, which bounds K: a sweep has a third of the colours, and bending lags. Ours, not the
        /// paper's.
        bool lags_bending = false;
    };

    /// Colours the vertices. O(vertices).
    /// @throws InvalidInput as VertexBlockDescent, DeviceError where memory is too little
    DeviceVertexBlockDescent(const CudaSpace& space, const std::vector<Vec3>& positions,
                             const ClothModel& cloth, const Settings& settings);

    int colour_count() const { return int(colours_.size()); }

    /// Velocities at the start of the step before, which the adaptive start compares with: for steps that do
    /// not follow on the last one [m/s].
    void set_last_velocities(View<const Vec3> v) { v_before_.upload(v); }

private:
    DeviceVertexBlockDescent(const CudaSpace& space, const std::vector<Vec3>& positions,
                             const SweepTable<T>& table, const Settings& settings);
    void enqueue(double dt, const Fields& fields) override;
    int iterations() const override { return settings_.max_sweeps; }
    void enqueue_sweep(double dt);

    Settings settings_;
    MembraneWeights weights_;
    std::vector<BlockRange> colours_;
    DeviceArray<SweepItem<T>> items_;
    DeviceArray<SweepTriangle<T>> triangles_;
    DeviceArray<SweepBend<T>> bends_;
    DeviceArray<int> first_entry_;  ///< of SlicedRows, where bending is lagged
    DeviceArray<RowEntry> bending_; ///< K [N/m]
    DeviceArray<PaddedVec3> lagged_;
    DeviceArray<Particle> particles_;
    DeviceArray<Vec3> prediction_, v_before_;
    DeviceArray<Vec3> last_, before_last_; ///< iterates of the Chebyshev recurrence
};

extern template class DeviceVertexBlockDescent<float>;
extern template class DeviceVertexBlockDescent<double>;

} // namespace toile
