#include "core/pd/cuda/nested_pcg.h"

#include <numeric>
#include <vector>

#include "core/compute/cuda/record_sum.cuh"
#include "core/quadrature/cuda/quadrature.cuh"
#include "core/quadrature/cuda/quadrature_solver.h"

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
      solver_b_(space, "pcg/solver_b"), solver_x_(space, "pcg/solver_x"), scalars_(space, "pcg/scalars", 1),
      progress_(space, "pcg/progress"), sums_(space)
{
}

void DeviceNestedPcg::prepare(const System& system, DeviceSolver& solver)
{
    const SparseMatrix& H = system.matrix();
    solver_ = &solver;
    quadrature_ = solver.as_quadrature();
    const auto rows = sliced_rows_of<WholeRows>(H);
    first_.upload(rows.first);
    entries_.upload(rows.entries);
    sum_.upload(row_sums(H));
    diagonal_.upload(system.diagonal());
    fixed_.upload(system.fixed());
}

PcgFields DeviceNestedPcg::fields(View<Vec3> x)
{
    return {x, r_.view(), r_previous_.view(), z_.view(), p_.view(), Kz_.view(), Kp_.view()};
}

SystemRows DeviceNestedPcg::rows() const
{
    return {first_.view(), entries_.view(), sum_.view(), fixed_.view()};
}

Pcg::Outcome DeviceNestedPcg::solve(DeviceActiveSet& active, View<const Vec3> g, View<Vec3> z)
{
    const StageScope stage("pd/pcg");
    const DeviceActiveSet::Frozen frozen = active.frozen();
    TOILE_ASSERT(frozen.vertices.size() > 0); // otherwise the kernel after its product would start too early
    if (inverse_.size() < frozen.vertices.size())
        inverse_.resize(frozen.vertices.size());
    const PcgFields fields = this->fields(z);
    const BlocksInverse E{frozen.list_of, inverse_.view(), diagonal_.view()};
    const FinishPrecondition finish{fields, E, scalars_.view()};

    begin_inverse(BeginPcg{g, fields, {frozen, diagonal_.view(), inverse_.view()}, scalars_.view()});
    end_inverse(finish);
    PcgScalars now;
    while (!now.is_over) {
        active.multiply(fields.z);
        parallel_sum_record_then<PcgSums>(space_, "pcg/multiply", g.size(),
                                          MultiplySystem{fields, rows(), frozen.list_of, frozen.product},
                                          FindStep{scalars_.view(), settings_}, sums_);
        begin_inverse(TakeStep{fields, E, scalars_.view(), progress_.next()});
        end_inverse(finish); // redundant after the last step, but then the device idles
        now = progress_.await();
    }
    return {now.iterations, now.residual};
}

/// Enqueues the part of H^-1 that precedes the solution.
template <typename Source>
void DeviceNestedPcg::begin_inverse(const Source& source)
{
    if (quadrature_ != nullptr)
        return quadrature_->begin_solve(source);
    const int n = r_.size();
    solver_b_.resize(n);
    parallel_for(space_, "pcg/give", n, StoreSource<Source>{source, solver_b_.view()});
}

template <typename Sink>
void DeviceNestedPcg::end_inverse(const Sink& sink)
{
    if (quadrature_ != nullptr)
        return quadrature_->end_solve(sink);
    const int n = r_.size();
    solver_x_.resize(n);
    solver_->solve_on_device(solver_b_.view(), solver_x_.view());
    parallel_for(space_, "pcg/take", n, PassToSink<Sink>{solver_x_.view(), sink});
}

} // namespace toile
