#include "core/pd/newton/hessian_solver.h"

#include <algorithm>
#include <numeric>

#include "core/compute/parallel.h"

namespace toile {

namespace {

/// Rows of a task: whole clusters.
constexpr int kRowsOfChunk = 256;

/// y += factor x
void add(PaddedVec3& y, float factor, const PaddedVec3& x)
{
    for (int k = 0; k < 4; ++k)
        y.value[k] += factor * x.value[k];
}

} // namespace

void HessianSolver::update(const HessianParts& K, bool with_coarse)
{
    if (!std::equal(K.fixed.begin(), K.fixed.end(), fixed_.begin(), fixed_.end())) {
        fixed_.assign(K.fixed.begin(), K.fixed.end());
        coarse_->find_clusters(K);
        rows_.find_pattern(K, coarse_->order());
        first_of_chunk_.assign(1, 0);
        for (int c = 1; c <= coarse_->cluster_count(); ++c)
            if (coarse_->first_row(c) - first_of_chunk_.back() >= kRowsOfChunk)
                first_of_chunk_.push_back(coarse_->first_row(c));
        if (first_of_chunk_.back() < rows_.size())
            first_of_chunk_.push_back(rows_.size());
        for (std::vector<PaddedVec3>* field : {&x_, &r_, &z_, &p_, &product_})
            field->assign(rows_.size(), PaddedVec3(0.0F));
        sums_.resize(first_of_chunk_.size() - 1);
        with_coarse = true;
    }
    whole_set_ = K.whole_set;
    rows_.update(K);
    term_force_.resize(rows_.view().terms.size());
    if (with_coarse)
        has_coarse_ = coarse_->update(K);
}

/// Runs kernel(first, last, sum) for the rows of each chunk, and adds the sums chunk by chunk: the same bits
/// for every thread count.
template <typename Kernel>
double HessianSolver::for_chunks(const char* name, const Kernel& kernel)
{
    parallel_for(
        kCpu, name, int(sums_.size()),
        [&](int chunk) {
            sums_[chunk] = 0.0;
            kernel(first_of_chunk_[chunk], first_of_chunk_[chunk + 1], sums_[chunk]);
        },
        1);
    return std::accumulate(sums_.begin(), sums_.end(), 0.0);
}

HessianSolver::Outcome HessianSolver::solve(View<const Vec3> g, const Stop& stop, View<Vec3> d)
{
    const StageScope stage("newton/pcg");
    const View<const int> order = rows_.order();
    for (int i = 0; i < order.size(); ++i) {
        r_[i] = padded(Vec3(-g[order[i]]));
        x_[i] = p_[i] = PaddedVec3(0.0F);
    }
    Outcome outcome;
    double rz = 0.0;
    while (outcome.iterations < kMaxIterations && !outcome.is_solved) {
        const double previous = rz;
        rz = precondition();
        if (!(rz > 0.0)) {
            outcome.is_solved = rz == 0.0;
            outcome.error = outcome.is_solved ? 0.0 : outcome.error;
            break;
        }
        const double beta = previous > 0.0 ? rz / previous : 0.0;
        for_chunks("newton/direction", [&](int first, int last, double&) {
            for (int i = first; i < last; ++i)
                for (int k = 0; k < 4; ++k)
                    p_[i].value[k] = z_[i].value[k] + float(beta) * p_[i].value[k];
        });
        const double curvature = multiply();
        if (!(curvature > 0.0))
            break;
        const double step = rz / curvature;
        for_chunks("newton/advance", [&](int first, int last, double&) {
            for (int i = first; i < last; ++i) {
                add(x_[i], float(step), p_[i]);
                add(r_[i], -float(step), product_[i]);
            }
        });
        outcome.advance(step, beta, rz, stop);
    }
    std::fill(d.begin(), d.end(), Vec3::Zero());
    for (int i = 0; i < order.size(); ++i)
        d[order[i]] = unpadded(x_[i]);
    return outcome;
}

/// product = K p; returns p . product.
double HessianSolver::multiply()
{
    const HessianRowsView K = rows_.view();
    if (!K.terms.empty())
        parallel_for(kCpu, "newton/term_forces", K.terms.size(),
                     [&](int t) { term_force_[t] = K.force(t, p_); });
    if (whole_set_ == nullptr)
        return for_chunks("newton/multiply", [&](int first, int last, double& sum) {
            for (int i = first; i < last; ++i) {
                product_[i] = K.product(i, p_, term_force_);
                sum += dot(p_[i], product_[i]);
            }
        });
    for_chunks("newton/multiply", [&](int first, int last, double&) {
        for (int i = first; i < last; ++i)
            product_[i] = K.product(i, p_, term_force_);
    });
    add_whole_set();
    return for_chunks("newton/sums", [&](int first, int last, double& sum) {
        for (int i = first; i < last; ++i)
            sum += dot(p_[i], product_[i]);
    });
}

/// product += dH p for an active set that is no sum of terms.
void HessianSolver::add_whole_set()
{
    whole_p_.assign(fixed_.size(), Vec3::Zero());
    whole_product_.assign(fixed_.size(), Vec3::Zero());
    const View<const int> order = rows_.order();
    for (int i = 0; i < order.size(); ++i)
        whole_p_[order[i]] = unpadded(p_[i]);
    whole_set_->add_hessian_product(whole_p_, whole_product_);
    for (int i = 0; i < order.size(); ++i)
        product_[i] += padded(whole_product_[order[i]]);
}

/// z = P r; returns r . z.
double HessianSolver::precondition()
{
    int with_cluster = 0; // rows before all others
    if (has_coarse_) {
        const int clusters = coarse_->cluster_count();
        with_cluster = coarse_->first_row(clusters);
        parallel_for(
            kCpu, "newton/restrict", clusters, [&](int c) { coarse_->restrict_to(c, r_); }, 4);
        coarse_->solve();
        parallel_for(
            kCpu, "newton/prolong", clusters, [&](int c) { coarse_->prolong(c, z_); }, 4);
    }
    const View<const PaddedMat3> inverse = rows_.inverse_diagonal();
    return for_chunks("newton/smooth", [&](int first, int last, double& sum) {
        for (int i = first; i < last; ++i) {
            PaddedVec3 z = inverse[i] * r_[i];
            if (i < with_cluster)
                z += z_[i];
            z_[i] = z;
            sum += dot(r_[i], z);
        }
    });
}

} // namespace toile
