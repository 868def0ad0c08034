#include "research/methods/vbd/vertex_block_descent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"
#include "garment/energy/membrane.h"
#include "research/methods/vbd/followed_acceleration.h"

namespace toile::research {

namespace {

/// Blocks of eight vertices per task: about 50 us of work.
constexpr int kBlocksPerTask = 8;

} // namespace

VertexBlockDescent::VertexBlockDescent(std::vector<Vec3> positions, garment::ClothModel cloth,
                                       Settings settings)
    : BaselineMethod(std::move(positions), std::move(cloth)), settings_(settings),
      weights_(garment::Membrane(cloth_.rest, cloth_.stretch, "VertexBlockDescent").weights()),
      layout_(lay_out_sweep(cloth_,
                            garment::Bending(cloth_.rest, cloth_.bending, "VertexBlockDescent").matrix())),
      prediction_(x_.size()), velocity_before_(v_), moved_(layout_.blocks.size())
{
}

StepReport VertexBlockDescent::advance(double dt, View<const Vec3> acceleration,
                                       const std::vector<unsigned char>& fixed, View<const Vec3> targets)
{
    StepReport report;
    report.steps = 1;
    report.status = StepReport::Status::IterationLimit;
    begin(dt, acceleration, fixed, targets);
    for (int k = 1; k <= settings_.max_sweeps; ++k) {
        report.displacement = sweep(dt, fixed);
        ++report.iterations;
        if (report.displacement < settings_.tolerance) {
            report.status = StepReport::Status::Converged;
            break;
        }
        if (settings_.rho > 0.0)
            accelerate(k);
    }
    if (!std::isfinite(max_norm(x_t1_))) {
        report.status = StepReport::Status::NonFinite;
        report.message = "vertex block descent: a position is not finite";
        return report;
    }

    velocity_before_ = v_;
    parallel_for(kCpu, "vbd/finish", int(x_.size()), [&](int i) { v_[i] = (x_t1_[i] - x_[i]) / dt; });
    return report;
}

/// Computes q* and the initial iterate of the sweeps; fixed vertices move to their targets.
void VertexBlockDescent::begin(double dt, View<const Vec3> acceleration,
                               const std::vector<unsigned char>& fixed, View<const Vec3> targets)
{
    const bool is_adaptive = settings_.start == Start::Adaptive;
    parallel_for(kCpu, "vbd/predict", int(x_.size()), [&](int i) {
        const Vec3 coasting = x_[i] + dt * v_[i];
        prediction_[i] = fixed[i] ? targets[i] : Vec3(coasting + dt * dt * acceleration[i]);
        x_t1_[i] = prediction_[i];
        if (is_adaptive && !fixed[i])
            x_t1_[i] = coasting + dt * dt * followed(acceleration[i], (v_[i] - velocity_before_[i]) / dt);
    });
    if (settings_.rho > 0.0)
        last_ = before_last_ = x_t1_;
}

/// @return maximum displacement of a vertex [m]
double VertexBlockDescent::sweep(double dt, const std::vector<unsigned char>& fixed)
{
    const DescendVertices descend{layout_, weights_, dt, prediction_, fixed, x_t1_, moved_};
    for (const BlockRange& colour : layout_.colours)
        parallel_for(
            kCpu, "vbd/sweep", colour.count, [&](int k) { descend(colour.first + k); }, kBlocksPerTask);
    double max_square = 0.0;
    for (const double move : moved_)
        max_square = std::max(max_square, move);
    return std::sqrt(max_square);
}

/// x^(n) = omega_n (x - x^(n-2)) + x^(n-2)   [Chen et al. 2024, section 3.8]
void VertexBlockDescent::accelerate(int sweep)
{
    const double rho2 = settings_.rho * settings_.rho;
    omega_ = sweep == 1 ? 1.0 : sweep == 2 ? 2.0 / (2.0 - rho2) : 4.0 / (4.0 - rho2 * omega_);
    parallel_for(
        kCpu, "vbd/accelerate", int(x_t1_.size()),
        [&](int i) {
            x_t1_[i] = before_last_[i] + omega_ * (x_t1_[i] - before_last_[i]);
            before_last_[i] = last_[i];
            last_[i] = x_t1_[i];
        },
        kFieldGrain);
}

} // namespace toile::research
