#include "core/pd/system.h"

#include <utility>

#include <Eigen/LU>

#include "core/linear/field.h"
#include "core/pd/step_error.h"

namespace toile {

namespace {

/// Rows and columns of fixed vertices become the identity's; the pattern stays, so that refactoring can reuse
/// the ordering.
void eliminate(SparseMatrix& H, View<const unsigned char> fixed)
{
    for (int row = 0; row < H.outerSize(); ++row)
        for (SparseMatrix::InnerIterator entry(H, row); entry; ++entry)
            if (fixed[row] || fixed[int(entry.col())])
                entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
}

} // namespace

System::System(std::vector<double> masses, std::vector<std::shared_ptr<Energy>> energies,
               std::unique_ptr<GlobalSolver> solver)
    : masses_(std::move(masses)), energies_(std::move(energies)), solver_(std::move(solver))
{
    const int n = vertex_count();
    Triplets entries;
    for (int i = 0; i < n; ++i) // the diagonal exists even where no energy acts
        entries.emplace_back(i, i, 0.0);
    for (const auto& energy : energies_)
        energy->add_hessian(entries);
    elastic_.resize(n, n);
    elastic_.setFromTriplets(entries.begin(), entries.end());
}

void System::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    if (dt != dt_ || fixed != fixed_)
        update(dt, fixed);
    solver_->begin_step();
}

void System::update(double dt, const std::vector<unsigned char>& fixed)
{
    dt_ = 0.0; // not prepared, should the solver refuse H
    fixed_ = fixed;
    H_ = elastic_;
    diagonal_.resize(masses_.size());
    for (int i = 0; i < vertex_count(); ++i) {
        H_.coeffRef(i, i) += masses_[i] / (dt * dt);
        diagonal_[i] = H_.coeff(i, i);
    }
    eliminate(H_, fixed_);
    solver_->update(H_, fixed_);
    dt_ = dt;
}

double System::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    double value = 0.0;
    for (const auto& energy : energies_) {
        const StageScope stage(energy->name());
        value += energy->add_gradient(x, gradient);
    }
    return value;
}

Curvature& System::curvature() const
{
    if (!curvature_)
        curvature_ = std::make_unique<Curvature>(vertex_count(), energies_);
    return *curvature_;
}

StepObjective::StepObjective(const System& system, const StepStart& start, ActiveSetEnergy* active,
                             const Pcg::Settings& linear)
    : system_(system), start_(start), active_(active), linear_(linear), scratch_(start.prediction.size())
{
    linear_.is_flexible = !system.solver().is_symmetric();
}

double StepObjective::evaluate(View<const Vec3> x, View<Vec3> gradient)
{
    const double inverse_dt2 = 1.0 / (start_.dt * start_.dt);
    const View<const double> masses = system_.masses();
    double value = parallel_sum(kCpu, x.size(), 0.0, [&](int i) {
        const Vec3 away = x[i] - start_.prediction[i];
        gradient[i] = masses[i] * inverse_dt2 * away;
        return 0.5 * gradient[i].dot(away);
    });
    value += system_.add_gradient(x, gradient);
    if (active_)
        value += active_->add_gradient(x, gradient);
    const View<const unsigned char> fixed = system_.fixed();
    for (int i = 0; i < x.size(); ++i)
        if (fixed[i])
            gradient[i].setZero();
    return value;
}

void StepObjective::accept(View<const Vec3> x)
{
    has_active_set_ = active_ && active_->activate(x);
    if (!has_active_set_)
        return;

    // E = (D + dH)^-1, block by block.
    const View<const Mat3> blocks = active_->diagonal_blocks();
    const View<const double> D = system_.diagonal();
    E_.resize(x.size());
    parallel_for(kCpu, "pd/contact_blocks", x.size(), [&](int i) {
        if (blocks[i].isZero(0.0))
            E_[i] = Mat3::Identity() / D[i];
        else
            E_[i] = (blocks[i] + D[i] * Mat3::Identity()).inverse();
    });
}

Hessian* StepObjective::hessian()
{
    if (!hessian_)
        hessian_.emplace(system_.curvature(), system_.masses(), system_.fixed(), start_.dt);
    hessian_->set_active(has_active_set_ ? active_ : nullptr);
    return &*hessian_;
}

bool StepObjective::is_minimiser(View<const Vec3> gradient, View<const Vec3> move, double tolerance) const
{
    const StepError error(system_.masses(), system_.fixed(), start_.x, start_.prediction, start_.dt);
    return error.is_within(tolerance, gradient, move);
}

void StepObjective::precondition(View<const Vec3> g, View<Vec3> z)
{
    if (has_active_set_)
        solve_with_active_set(g, z);
    else
        system_.solver().solve(g, z);
}

/// (H + dH) z = g by PCG. The preconditioner is the paper's nesting of collision projection and
/// collision-free solve, symmetrised so that it converges (docs/core/pd.md):
///
///   P r = E r + E D H^-1 D E r
void StepObjective::solve_with_active_set(View<const Vec3> g, View<Vec3> z)
{
    const StageScope stage("pd/pcg");
    const SparseMatrix& H = system_.matrix();
    const View<const double> D = system_.diagonal();
    const View<const unsigned char> fixed = system_.fixed();
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) {
        parallel_for(kCpu, "pd/multiply", p.size(), [&](int i) { out[i] = row_times(H, i, p); });
        active_->add_hessian_product(p, out);
        for (int i = 0; i < p.size(); ++i)
            if (fixed[i])
                out[i] = p[i];
    };
    const auto precondition = [&](View<const Vec3> r, View<Vec3> out) {
        parallel_for(kCpu, "pd/nested", r.size(), [&](int i) { scratch_[i] = D[i] * (E_[i] * r[i]); });
        system_.solver().solve(scratch_, scratch_);
        parallel_for(kCpu, "pd/nested", r.size(),
                     [&](int i) { out[i] = E_[i] * (r[i] + D[i] * scratch_[i]); });
    };
    linear_iterations_ += pcg_.solve(multiply, precondition, g, z, linear_).iterations;
}

} // namespace toile
