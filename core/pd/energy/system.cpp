#include "core/pd/energy/system.h"

#include <utility>

#include "core/base/stages.h"

namespace toile {

namespace {

/// Replaces rows and columns of fixed vertices by the identity's; the pattern stays, so that refactoring can
/// reuse the ordering.
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
    for (int i = 0; i < n; ++i) // the diagonal exists even without energies
        entries.emplace_back(i, i, 0.0);
    for (const auto& energy : energies_)
        energy->add_hessian(entries);
    elastic_.resize(n, n);
    elastic_.setFromTriplets(entries.begin(), entries.end());
}

void System::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    prepare_diagonal(dt, fixed);
    if (!has_matrix_)
        update();
    solver_->begin_step();
}

void System::prepare_diagonal(double dt, const std::vector<unsigned char>& fixed)
{
    if (dt == dt_ && fixed == fixed_)
        return;
    dt_ = dt;
    fixed_ = fixed;
    has_matrix_ = false;
    diagonal_.resize(masses_.size());
    for (int i = 0; i < vertex_count(); ++i)
        diagonal_[i] = elastic_.coeff(i, i) + masses_[i] / (dt * dt);
}

void System::update()
{
    H_ = elastic_;
    for (int i = 0; i < vertex_count(); ++i)
        H_.coeffRef(i, i) = diagonal_[i];
    eliminate(H_, fixed_);
    solver_->update(H_, fixed_);
    has_matrix_ = true;
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

} // namespace toile
