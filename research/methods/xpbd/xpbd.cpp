#include "research/methods/xpbd/xpbd.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/linear/field.h"
#include "garment/energy/membrane.h"
#include "research/methods/bending_forces.h"

namespace toile::research {

namespace {

/// Blocks of eight constraints per task: 10 to 50 us of work.
constexpr int kBlocksPerTask = 32;

/// (K x)_i; rows sum to zero, so differences replace positions.
Vec3 bending_gradient(const SparseMatrix& K, int i, View<const Vec3> x)
{
    Vec3 sum = Vec3::Zero();
    for (SparseMatrix::InnerIterator entry(K, i); entry; ++entry)
        sum += entry.value() * (x[int(entry.col())] - x[i]);
    return sum;
}

} // namespace

Xpbd::Xpbd(std::vector<Vec3> positions, garment::ClothModel cloth, Settings settings)
    : BaselineMethod(std::move(positions), std::move(cloth)), settings_(settings),
      weights_(garment::Membrane(cloth_.rest, cloth_.stretch, "Xpbd").weights()),
      bending_(garment::Bending(cloth_.rest, cloth_.bending, "Xpbd").matrix()),
      fastest_(fastest_bending(bending_, cloth_.masses)), layout_(lay_out_constraints(cloth_)),
      inverse_masses_(x_.size()), before_(x_.size())
{
    if (settings.substeps < 1)
        throw InvalidInput("Xpbd: substeps = " + std::to_string(settings.substeps) +
                           "; it must be 1 or more");
}

StepReport Xpbd::advance(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                         View<const Vec3> targets)
{
    StepReport report;
    report.steps = 1;
    report.status = StepReport::Status::IterationLimit;
    x_t1_ = x_;
    for (size_t i = 0; i < x_.size(); ++i)
        inverse_masses_[i] = fixed[i] ? 0.0 : 1.0 / cloth_.masses[i];

    const double h = dt / settings_.substeps;
    for (int s = 1; s <= settings_.substeps; ++s, ++report.iterations) {
        predict(h, double(s) / settings_.substeps, acceleration, targets);
        project(h);
        if (s == settings_.substeps)
            for (size_t i = 0; i < x_.size(); ++i)
                report.displacement =
                    std::max(report.displacement, (x_t1_[i] - before_[i] - h * v_[i]).norm());
        parallel_for(
            kCpu, "xpbd/finish", int(x_.size()), [&](int i) { v_[i] = (x_t1_[i] - before_[i]) / h; },
            kFieldGrain);
    }
    if (!std::isfinite(max_norm(x_t1_))) {
        report.status = StepReport::Status::NonFinite;
        report.message = "XPBD: a position is not finite";
    }
    return report;
}

bool Xpbd::bends_by_forces(double h) const
{
    return settings_.bend_by_forces && allows_bending_forces(fastest_, h);
}

/// Predicts a substep. Free vertices move with their velocity and forces, fixed ones on a straight line to
/// their target.
/// @param end  end of the substep as a fraction of the step [-]
void Xpbd::predict(double h, double end, View<const Vec3> acceleration, View<const Vec3> targets)
{
    const bool has_forces = bends_by_forces(h);
    before_.swap(x_t1_);
    parallel_for(kCpu, "xpbd/predict", int(x_.size()), [&](int i) {
        if (inverse_masses_[i] == 0.0) {
            x_t1_[i] = x_[i] + end * (targets[i] - x_[i]);
            v_[i] = (x_t1_[i] - before_[i]) / h;
            return;
        }
        v_[i] += h * acceleration[i];
        if (has_forces)
            v_[i] -= h * inverse_masses_[i] * bending_gradient(bending_, i, before_);
        x_t1_[i] = before_[i] + h * v_[i];
    });
}

/// Makes one pass over the constraints, the stiff ones last.
void Xpbd::project(double h)
{
    const ProjectCurvatures bend{layout_.curvatures, layout_.entries, h, inverse_masses_, x_t1_};
    if (!bends_by_forces(h))
        for (const BlockRange& colour : layout_.curvature_colours)
            parallel_for(
                kCpu, "xpbd/curvatures", colour.count, [&](int k) { bend(colour.first + k); },
                kBlocksPerTask);
    const ProjectStrains stretch{layout_.strains, weights_, h, inverse_masses_, x_t1_};
    for (const BlockRange& colour : layout_.strain_colours)
        parallel_for(
            kCpu, "xpbd/strains", colour.count, [&](int k) { stretch(colour.first + k); }, kBlocksPerTask);
}

} // namespace toile::research
