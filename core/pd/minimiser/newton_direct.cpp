#include "core/pd/minimiser/newton_direct.h"

#include "core/base/error.h"
#include "core/linear/field.h"

namespace toile {

void NewtonDirect::begin(int vertex_count)
{
    cholesky_.reset();
    numbers_.resize(3 * size_t(vertex_count));
    decrement_ = 0.0;
}

/// Factors the exact Hessian, or the projected one if the exact one is indefinite.
void NewtonDirect::factor(Hessian& hessian, View<const Vec3> x)
{
    hessian.linearise(x, Definiteness::Projected);
    if (!cholesky_)
        cholesky_ = std::make_unique<Cholesky>(hessian.matrix());
    hessian.linearise(x, Definiteness::Exact);
    try {
        cholesky_->refactor(hessian.matrix());
    } catch (const InvalidInput&) { // not positive definite: only factoring detects it
        hessian.linearise(x, Definiteness::Projected);
        cholesky_->refactor(hessian.matrix());
    }
}

void NewtonDirect::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    Hessian* const K = objective.hessian();
    if (K == nullptr)
        throw InvalidInput("newton-direct: the objective has no second derivatives; choose another method");
    factor(*K, here.x);
    const int n = direction.size();
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            numbers_[3 * i + k] = Vec3(-here.gradient[i][k], 0.0, 0.0);
    cholesky_->solve(numbers_, numbers_);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            direction[i][k] = numbers_[3 * i + k].x();
    decrement_ = -dot(here.gradient, direction);
}

} // namespace toile
