#pragma once

#include "core/compute/cuda/report.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/pd/cuda/active_set.h"
#include "core/pd/cuda/newton/hessian.h"
#include "core/pd/cuda/newton/hierarchy.h"
#include "core/pd/cuda/newton/solver_kernels.h"
#include "core/pd/newton/newton_space.h"

namespace toile {

/// HessianSolver on a GPU, with a DeviceHierarchy as the coarse part of its preconditioner.
class DeviceHessianSolver {
public:
    /// Iterations that the matrices of the hierarchy cost, about: 30 to 35 on an H200.
    static constexpr int kPriceOfCoarse = 35;

    /// @param space, energies  borrowed
    /// @param points  [vertices] undeformed positions
    /// @param blocks, isotropic  pattern of the Hessian, see HessianPattern
    /// @param extent  of the points
    DeviceHessianSolver(const CudaSpace& space, View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                        const SparseMatrix& isotropic, Extent extent, DeviceEnergies& energies);

    /// Takes other fixed vertices.
    void set_fixed(const std::vector<unsigned char>& fixed);

    /// Takes the Hessian at x, with the frozen terms of `active`, which may be null. Enqueued.
    /// @param with_coarse  also for the coarse part, which may be older
    void update(View<const Vec3> x, View<const double> inertia, DeviceActiveSet* active, bool with_coarse);

    /// Takes other frozen terms of the active set; the rest stays. Enqueued.
    void update_active_set(DeviceActiveSet* active);

    /// Solves K d = -g; see HessianSolver::solve. Waits.
    HessianSolver::Outcome solve(View<const Vec3> g, const HessianSolver::Stop& stop);

    SlicedHessian hessian() { return hessian_.view(); } ///< without frozen terms

    View<const PaddedVec3> direction() const { return x_.view(); } ///< d [vertices] [m]

private:
    void precondition();
    void multiply(const HessianSolver::Stop& stop);
    FrozenTerms terms() const;
    NewtonPcgFields fields();

    const CudaSpace& space_;
    DeviceHessian hessian_;
    DeviceHierarchy hierarchy_;
    DeviceActiveSet* active_ = nullptr; ///< null: no frozen terms
    DeviceArray<unsigned char> fixed_;
    DeviceArray<Floats<4>> first_part_; ///< see InvertDiagonal
    DeviceArray<Floats<2>> second_part_;
    DeviceArray<PaddedVec3> x_, r_, z_, p_, Kz_, Kp_;
    DeviceArray<NewtonPcgState> state_;
    DeviceReport<NewtonPcgState> reports_[2];
    RecordScratch sums_;
};

} // namespace toile
