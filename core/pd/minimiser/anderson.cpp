#include "core/pd/minimiser/anderson.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>

#include "core/linear/field.h"

namespace toile {

namespace {

/// Relative addition to the diagonal of the normal equations [-]: nearly parallel displacements stay
/// solvable.
constexpr double kRegularisation = 1e-9;

} // namespace

Anderson::Anderson(int window) : window_(window) { TOILE_ASSERT(window > 0); }

void Anderson::begin(int vertex_count)
{
    fall_back();
    plain_.resize(vertex_count);
    previous_.resize(vertex_count);
    is_current_ = false;
}

bool Anderson::fall_back()
{
    const bool had_columns = !columns_.empty();
    std::move(columns_.begin(), columns_.end(), std::back_inserter(spare_));
    columns_.clear();
    products_.resize(0, 0);
    return had_columns;
}

/// One trial of the accelerated point suffices: the plain displacement costs no further solve.
int Anderson::max_trials() const { return columns_.empty() ? OuterLoop::max_trials() : 1; }

void Anderson::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    // Compute the plain displacement, unless it is current because the accelerated one has just been
    // rejected.
    if (!is_current_) {
        objective.precondition(here.gradient, plain_);
        parallel_for(
            kCpu, "anderson/negate", direction.size(), [&](int i) { plain_[i] = -plain_[i]; }, kFieldGrain);
        is_current_ = true;
        if (!columns_.empty())
            complete_newest();
    }

    std::copy(plain_.begin(), plain_.end(), direction.begin());
    if (columns_.empty())
        return;
    const Eigen::VectorXd theta = weights(here.gradient);
    if (!theta.allFinite())
        return;
    parallel_for(
        kCpu, "anderson/combine", direction.size(),
        [&](int i) {
            for (size_t j = 0; j < columns_.size(); ++j)
                direction[i] -= theta[long(j)] * (columns_[j].s[i] + columns_[j].df[i]);
        },
        kFieldGrain);
}

/// theta from the normal equations of the H-inner product, <df_j, f> = -df_j . g. After equally many
/// iterations the error is 1 to 8 % smaller than with the Euclidean product.
Eigen::VectorXd Anderson::weights(View<const Vec3> gradient) const
{
    const int count = int(columns_.size());
    Eigen::VectorXd right(count);
    for (int j = 0; j < count; ++j)
        right[j] = -dot(columns_[j].df, gradient);
    Eigen::MatrixXd normal = products_;
    normal.diagonal() *= 1.0 + kRegularisation;
    return normal.ldlt().solve(right);
}

/// Completes the newest displacement by the change of the plain one. Its products are symmetrised:
/// approximate inverses need not be symmetric, and H + dH changes with the contacts.
void Anderson::complete_newest()
{
    Column& newest = columns_.back();
    parallel_for(
        kCpu, "anderson/change", int(plain_.size()), [&](int i) { newest.df[i] = plain_[i] - previous_[i]; },
        kFieldGrain);

    const int count = int(columns_.size());
    Eigen::MatrixXd products(count, count);
    const int known = count - 1;
    products.topLeftCorner(known, known) = products_.bottomRightCorner(known, known);
    for (int j = 0; j < count; ++j) {
        const Column& other = columns_[j];
        const double twice = parallel_sum(kCpu, int(plain_.size()), 0.0, [&](int i) {
            return -other.df[i].dot(newest.dg[i]) - newest.df[i].dot(other.dg[i]);
        });
        products(j, known) = products(known, j) = 0.5 * twice;
    }
    products_ = std::move(products);
}

void Anderson::update_history(const Step& step)
{
    while (int(columns_.size()) >= window_) {
        spare_.push_back(std::move(columns_.front()));
        columns_.erase(columns_.begin());
    }
    Column column;
    if (!spare_.empty()) {
        column = std::move(spare_.back());
        spare_.pop_back();
    }
    const int n = step.gradient.size();
    for (std::vector<Vec3>* field : {&column.s, &column.df, &column.dg})
        field->resize(n);
    parallel_for(
        kCpu, "anderson/remember", n,
        [&](int i) {
            column.s[i] = step.length * step.direction[i];
            column.dg[i] = step.new_gradient[i] - step.gradient[i];
        },
        kFieldGrain);
    columns_.push_back(std::move(column));
    previous_.swap(plain_);
    is_current_ = false;
}

} // namespace toile
