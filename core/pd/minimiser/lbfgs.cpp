#include "core/pd/minimiser/lbfgs.h"

#include <cmath>
#include <iterator>
#include <utility>

#include "core/linear/field.h"

namespace toile {

Lbfgs::Lbfgs(int history) : history_(history) { TOILE_ASSERT(history > 0); }

void Lbfgs::begin(int) { fall_back(); }

/// Drops the pairs, which leaves plain local/global.
bool Lbfgs::fall_back()
{
    const bool had_pairs = !pairs_.empty();
    std::move(pairs_.begin(), pairs_.end(), std::back_inserter(spare_));
    pairs_.clear();
    return had_pairs;
}

/// Applies the two-loop recursion to -gradient; each pass updates and computes the next product together.
void Lbfgs::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    const int count = int(pairs_.size());
    alpha_.resize(count);
    const View<Vec3> q = here.scratch;
    parallel_for(
        kCpu, "lbfgs/negate", q.size(), [&](int i) { q[i] = -here.gradient[i]; }, kFieldGrain);
    double product = count > 0 ? dot(pairs_[count - 1].s, q) : 0.0;
    for (int i = count - 1; i >= 0; --i) {
        alpha_[i] = pairs_[i].rho * product;
        if (i > 0)
            product = axpy_dot(-alpha_[i], pairs_[i].y, q, pairs_[i - 1].s);
        else
            axpy(-alpha_[i], pairs_[i].y, q);
    }

    objective.precondition(q, direction);
    product = count > 0 ? dot(pairs_[0].y, direction) : 0.0;
    for (int i = 0; i < count; ++i) {
        const double factor = alpha_[i] - pairs_[i].rho * product;
        if (i + 1 < count)
            product = axpy_dot(factor, pairs_[i].s, direction, pairs_[i + 1].y);
        else
            axpy(factor, pairs_[i].s, direction);
    }
}

/// Stores the accepted step and the change of the gradient.
void Lbfgs::update_history(const Step& step)
{
    while (int(pairs_.size()) >= history_) {
        spare_.push_back(std::move(pairs_.front()));
        pairs_.erase(pairs_.begin());
    }
    Pair pair;
    if (!spare_.empty()) {
        pair = std::move(spare_.back());
        spare_.pop_back();
    }
    const int n = step.gradient.size();
    pair.s.resize(n);
    pair.y.resize(n);
    // Compute s.y, s.s and y.y in one pass.
    const Vec3 products = parallel_sum(kCpu, n, Vec3(Vec3::Zero()), [&](int i) {
        pair.s[i] = step.length * step.direction[i];
        pair.y[i] = step.new_gradient[i] - step.gradient[i];
        return Vec3(pair.s[i].dot(pair.y[i]), pair.s[i].squaredNorm(), pair.y[i].squaredNorm());
    });

    const double curvature = products[0];
    const double scale = std::sqrt(products[1] * products[2]);
    if (curvature > kMinCurvature * scale) {
        pair.rho = 1.0 / curvature;
        pairs_.push_back(std::move(pair));
    } else {
        spare_.push_back(std::move(pair));
    }
}

} // namespace toile
