#pragma once

#include "core/linear/sliced_rows.h"
#include "research/methods/cuda/baseline_method.h"
#include "research/methods/particle.h"
#include "research/methods/xpbd/constraint_table.h"

namespace toile::research {

/// Xpbd on a GPU: the same constraints in the same order, one kernel per colour, one thread per constraint.
/// The end of a substep and the start of the next are one kernel.
/// @tparam T  arithmetic of the constraints, float or double; positions are double
template <typename T>
class DeviceXpbd : public DeviceBaselineMethod {
public:
    struct Settings {
        int substeps = 20;          ///< per step, at least 1
        bool bend_by_forces = true; ///< as in Xpbd
    };

    /// Colours the constraints. O(triangles).
    /// @throws InvalidInput as Xpbd, DeviceError if memory is insufficient
    DeviceXpbd(const CudaSpace& space, const std::vector<Vec3>& positions, const garment::ClothModel& cloth,
               const Settings& settings);

private:
    DeviceXpbd(const CudaSpace& space, const std::vector<Vec3>& positions, ConstraintTable<T> table,
               const Settings& settings);
    void enqueue(double dt, const Fields& fields) override;
    int iterations() const override { return settings_.substeps; }
    void enqueue_constraints(double h, bool bends_by_forces, View<Particle> after);

    Settings settings_;
    ConstraintTable<T> table_;
    DeviceArray<int> first_entry_;  ///< of SlicedRows
    DeviceArray<RowEntry> bending_; ///< K [N/m]
    DeviceArray<StrainItem<T>> strains_;
    DeviceArray<CurvatureItem<T>> curvatures_;
    DeviceArray<CurvatureItemEntry<T>> entries_;
    DeviceArray<Particle> particles_[2];
};

extern template class DeviceXpbd<float>;
extern template class DeviceXpbd<double>;

} // namespace toile::research
