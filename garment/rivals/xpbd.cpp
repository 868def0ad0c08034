#include "garment/rivals/xpbd.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"

namespace toile {

namespace {

/// Blocks of eight constraints per task: 10 to 50 us of work.
constexpr int kBlocksPerTask = 32;

} // namespace

Xpbd::Xpbd(std::vector<Vec3> positions, ClothModel cloth, Settings settings)
    : Rival(std::move(positions), std::move(cloth)), settings_(settings),
      weights_(Membrane(cloth_.rest, cloth_.stretch, "Xpbd").weights()), layout_(lay_out_constraints(cloth_)),
      inverse_masses_(x_.size()), x_t0_(x_.size()), before_(x_.size())
{
}

StepReport Xpbd::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                      View<const Vec3> targets)
{
    StepReport report;
    report.steps = 1;
    report.status = StepReport::Status::IterationLimit;
    x_t0_ = x_;
    for (size_t i = 0; i < x_.size(); ++i)
        inverse_masses_[i] = fixed[i] ? 0.0 : 1.0 / cloth_.masses[i];

    const double h = dt / settings_.substeps;
    for (int s = 1; s <= settings_.substeps; ++s, ++report.iterations) {
        predict(h, double(s) / settings_.substeps, acceleration, targets);
        project(h);
        if (s == settings_.substeps)
            for (size_t i = 0; i < x_.size(); ++i)
                report.displacement = std::max(report.displacement, (x_[i] - before_[i] - h * v_[i]).norm());
        parallel_for(
            kCpu, "xpbd/finish", int(x_.size()), [&](int i) { v_[i] = (x_[i] - before_[i]) / h; },
            kFieldGrain);
    }
    if (!std::isfinite(max_norm(x_))) {
        report.status = StepReport::Status::NonFinite;
        report.message = "XPBD: a position is not finite";
    }
    return report;
}

/// Free vertices fly on; fixed ones go their straight way to the target.
/// @param end  of the substep, as a share of the step [-]
void Xpbd::predict(double h, double end, View<const Vec3> acceleration, View<const Vec3> targets)
{
    parallel_for(
        kCpu, "xpbd/predict", int(x_.size()),
        [&](int i) {
            before_[i] = x_[i];
            const bool is_free = inverse_masses_[i] > 0.0;
            v_[i] = is_free ? Vec3(v_[i] + h * acceleration[i])
                            : Vec3((x_t0_[i] + end * (targets[i] - x_t0_[i]) - x_[i]) / h);
            x_[i] = is_free ? Vec3(x_[i] + h * v_[i]) : Vec3(x_t0_[i] + end * (targets[i] - x_t0_[i]));
        },
        kFieldGrain);
}

/// One pass, the stiff constraints last.
void Xpbd::project(double h)
{
    const ProjectCurvatures bend{layout_.curvatures, layout_.entries, h, inverse_masses_, x_};
    for (const BlockRange& colour : layout_.curvature_colours)
        parallel_for(
            kCpu, "xpbd/curvatures", colour.count, [&](int k) { bend(colour.first + k); }, kBlocksPerTask);
    const ProjectStrains stretch{layout_.strains, weights_, h, inverse_masses_, x_};
    for (const BlockRange& colour : layout_.strain_colours)
        parallel_for(
            kCpu, "xpbd/strains", colour.count, [&](int k) { stretch(colour.first + k); }, kBlocksPerTask);
}

} // namespace toile
