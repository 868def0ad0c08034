#include "core/pd/cuda/newton/solver.h"

#include "core/compute/cuda/record_sum.cuh"
#include "core/compute/cuda/teams.cuh"

namespace toile {

DeviceHessianSolver::DeviceHessianSolver(const CudaSpace& space, View<const EmbeddedPoint> points,
                                         const BlockMatrix& blocks, const SparseMatrix& isotropic,
                                         Extent extent, DeviceEnergies& energies)
    : space_(space), hessian_(space, HessianPattern(blocks, isotropic), energies),
      hierarchy_(space, ClusterHierarchy(points, blocks, isotropic, extent)), fixed_(space, "newton/fixed"),
      first_part_(space, "newton/first_part", points.size()),
      second_part_(space, "newton/second_part", points.size()), x_(space, "newton/x", points.size()),
      r_(space, "newton/r", points.size()), z_(space, "newton/z", points.size()),
      p_(space, "newton/p", points.size()), Kz_(space, "newton/Kz", points.size()),
      Kp_(space, "newton/Kp", points.size()),
      state_(space, "newton/state", 1), reports_{{space, "newton/report"}, {space, "newton/report"}},
      sums_(space)
{
}

void DeviceHessianSolver::set_fixed(const std::vector<unsigned char>& fixed)
{
    fixed_.upload(fixed);
    hierarchy_.set_fixed(fixed);
}

NewtonPcgFields DeviceHessianSolver::fields()
{
    return {x_.view(), r_.view(), z_.view(), p_.view(), Kz_.view(), Kp_.view()};
}

FrozenTerms DeviceHessianSolver::terms() const
{
    return active_ ? FrozenTerms::of(active_->frozen()) : FrozenTerms{};
}

void DeviceHessianSolver::update(View<const Vec3> x, View<const double> inertia, DeviceActiveSet* active,
                                 bool with_coarse)
{
    hessian_.linearise(x, inertia);
    update_active_set(active);
    if (with_coarse)
        hierarchy_.update(hessian_.view(), terms());
}

void DeviceHessianSolver::update_active_set(DeviceActiveSet* active)
{
    active_ = active;
    parallel_for(
        space_, "newton/invert_diagonal", x_.size(),
        InvertDiagonal{hessian_.view(), terms(), fixed_.view(), first_part_.view(), second_part_.view()});
}

HessianSolver::Outcome DeviceHessianSolver::solve(View<const Vec3> g, const HessianSolver::Stop& stop)
{
    const StageScope stage("newton/pcg");
    parallel_for_blocks<ClusterFields::kThreads>(
        space_, "newton/begin", hierarchy_.cluster_count(), ClusterFields::kBytes,
        BeginNewtonPcg{g, fixed_.view(), fields(), hierarchy_.fields(), state_.view()});
    NewtonPcgState now;
    for (int iteration = 0; !now.is_over; ++iteration) {
        precondition();
        multiply(stop);
        parallel_for_blocks<ClusterFields::kThreads>(
            space_, "newton/advance", hierarchy_.cluster_count(), ClusterFields::kBytes,
            AdvanceNewtonPcg{fields(), hierarchy_.fields(), state_.view(), reports_[iteration % 2].next()});
        // The device is an iteration ahead, so that it never waits. That one does nothing after the last.
        if (iteration > 0)
            now = reports_[(iteration - 1) % 2].await();
    }
    return now.outcome;
}

void DeviceHessianSolver::precondition()
{
    hierarchy_.solve();
    parallel_for_blocks<ClusterFields::kThreads>(
        space_, "newton/precondition", hierarchy_.cluster_count(), 0,
        Precondition{fields(), hierarchy_.fields(), first_part_.view(), second_part_.view()});
}

void DeviceHessianSolver::multiply(const HessianSolver::Stop& stop)
{
    constexpr int kTeam = 4;
    const MultiplyHessian multiply{fields(), hessian_.view(), terms(), fixed_.view()};
    if (active_) {
        active_->multiply(z_.view());
        parallel_for_teams<kTeam>(space_, "newton/multiply", x_.size(), MultiplyBesideTerms{multiply});
    } else {
        parallel_for_teams<kTeam>(space_, "newton/multiply", x_.size(), multiply);
    }
    parallel_sum_record_then<NewtonPcgSums>(space_, "newton/measure_iteration", x_.size(),
                                            MeasureIteration{fields()}, FindNewtonStep{state_.view(), stop},
                                            sums_);
}

} // namespace toile
