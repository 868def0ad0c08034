#include "core/pd/device/device_nested_pcg.h"

#include <numeric>
#include <vector>

#include "core/backend/cuda/record_sum.cuh"

namespace toile {

namespace {

std::vector<float> row_sums(const SparseMatrix& H)
{
    std::vector<float> sums(H.rows());
    for (int i = 0; i < int(sums.size()); ++i) {
        const double* values = H.valuePtr();
        sums[i] =
            float(std::accumulate(values + H.outerIndexPtr()[i], values + H.outerIndexPtr()[i + 1], 0.0));
    }
    return sums;
}

} // namespace

DeviceNestedPcg::DeviceNestedPcg(const CudaSpace& space, int n, const Pcg::Settings& settings)
    : space_(space), settings_(settings), first_(space, "pcg/first"), entries_(space, "pcg/entries"),
      sum_(space, "pcg/sum"), diagonal_(space, "pcg/diagonal"), fixed_(space, "pcg/fixed"),
      inverse_(space, "pcg/inverse"), r_(space, "pcg/r", n), r_previous_(space, "pcg/r_previous", n),
      z_(space, "pcg/z", n), p_(space, "pcg/p", n), Kz_(space, "pcg/Kz", n), Kp_(space, "pcg/Kp", n),
      scaled_(space, "pcg/scaled", n), solved_(space, "pcg/solved", n), scalars_(space, "pcg/scalars", 1),
      progress_(space, "pcg/progress"), sums_(space)
{
}

void DeviceNestedPcg::prepare(const System& system, DeviceSolver& solver)
{
    const SparseMatrix& H = system.matrix();
    solver_ = &solver;
    const auto rows = sliced_rows_of<WholeRows>(H);
    first_.upload(rows.first);
    entries_.upload(rows.entries);
    sum_.upload(row_sums(H));
    diagonal_.upload(system.diagonal());
    fixed_.upload(system.fixed());
}

void DeviceNestedPcg::update(DeviceActiveSet& active)
{
    active_ = &active;
    const DeviceActiveSet::Frozen frozen = active.frozen();
    if (inverse_.size() < frozen.blocks.size())
        inverse_.resize(frozen.blocks.size());
    parallel_for(space_, "pcg/invert_blocks", frozen.blocks.size(),
                 InvertBlock{frozen.vertices, frozen.blocks, diagonal_.view(), inverse_.view()});
}

PcgFields DeviceNestedPcg::fields(View<Vec3> x)
{
    return {x,          r_.view(),  r_previous_.view(), z_.view(),     p_.view(),
            Kz_.view(), Kp_.view(), scaled_.view(),     solved_.view()};
}

BlocksInverse DeviceNestedPcg::blocks_inverse() const
{
    return {active_->frozen().list_of, inverse_.view(), diagonal_.view()};
}

SystemRows DeviceNestedPcg::rows() const
{
    return {first_.view(), entries_.view(), sum_.view(), fixed_.view()};
}

Pcg::Outcome DeviceNestedPcg::solve(View<const Vec3> g, View<Vec3> z)
{
    const StageScope stage("pd/pcg");
    const PcgFields fields = this->fields(z);
    parallel_for(space_, "pcg/begin", g.size(), BeginPcg{g, fields, blocks_inverse(), scalars_.view()});
    PcgScalars now;
    while (!now.is_over) {
        iterate(fields);
        now = progress_.await();
    }
    return {now.iterations, now.residual};
}

void DeviceNestedPcg::iterate(const PcgFields& fields)
{
    const int n = fields.x.size();
    solver_->solve_there(fields.scaled, fields.solved);
    parallel_for(space_, "pcg/precondition", n, FinishPrecondition{fields, blocks_inverse()});
    TOILE_ASSERT(active_->frozen().vertices.size() > 0); // else the next kernel would come too early
    active_->multiply(fields.z);
    parallel_sum_record_then<PcgSums>(
        space_, "pcg/multiply", n,
        MultiplySystem{fields, rows(), active_->frozen().list_of, active_->frozen().product},
        FindStepAndReport{{scalars_.view(), settings_}, progress_.next()}, sums_);
    parallel_for(space_, "pcg/step", n, TakeStep{fields, blocks_inverse(), scalars_.view()});
}

} // namespace toile
