#include "core/quadrature/quadrature_solver.h"

#include <utility>

#include "core/backend/parallel.h"
#include "core/quadrature/gather_leaf.h"

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;
constexpr int kRank = ClusterBasis::kRank;

/// Leaves or clusters per task: small enough to balance, a few microseconds each.
constexpr int kLeafGrain = 16;

} // namespace

QuadratureSolver::QuadratureSolver(std::vector<Place> places, Settings settings)
    : places_(std::move(places)), settings_(settings)
{
}

void QuadratureSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    TOILE_ASSERT(H.rows() == long(places_.size()));
    std::vector<int> nodes;
    for (int v = 0; v < fixed.size(); ++v)
        if (!fixed[v])
            nodes.push_back(v);
    if (nodes.empty()) {
        tables_.reset();
        return;
    }
    auto tables = std::make_unique<Tables>(places_, std::move(nodes));
    const Cholesky cholesky(H);
    const Eigen::VectorXd diagonal = H.diagonal();
    tables->kernel = *build_kernel_table(cholesky.factor(), {diagonal.data(), int(diagonal.size())},
                                         tables->basis, settings_, nullptr);
    tables_ = std::move(tables);
}

/// P_C^T b for all clusters, leaves first.
void QuadratureSolver::gather_moments(View<const Vec3> b, View<Vec3f> moments) const
{
    const auto value = [&](int slot) {
        const int v = tables_->tree.nodes()[slot];
        return v >= 0 ? b[v] : Vec3(Vec3::Zero());
    };
    thread_local std::vector<Vec3> sums;
    sums.resize(size_t(kRank) * tables_->tree.cluster_count());
    const View<Vec3> out(sums);
    for (int level = 0; level < tables_->tree.level_count(); ++level)
        parallel_for(
            kCpu, "quadrature/moments", tables_->tree.level_size(level),
            [&](int c) { tables_->basis.gather(level, c, Vec3(Vec3::Zero()), value, out); }, kLeafGrain);
    for (int i = 0; i < moments.size(); ++i)
        moments[i] = sums[i].cast<float>();
}

void QuadratureSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    const StageScope stage("quadrature/solve");
    if (x.data() != b.data())
        std::copy(b.begin(), b.end(), x.begin());
    if (tables_)
        parallel_isolated(kCpu, [&] { apply(b, x); });
}

void QuadratureSolver::apply(View<const Vec3> b, View<Vec3> x) const
{
    thread_local std::vector<Vec3f> moments, sources;
    moments.resize(size_t(kRank) * tables_->tree.cluster_count());
    sources.resize(tables_->tree.nodes().size());
    gather_moments(b, moments);
    for (int slot = 0; slot < int(sources.size()); ++slot) {
        const int v = tables_->tree.nodes()[slot];
        sources[slot] = v >= 0 ? Vec3f(b[v].cast<float>()) : Vec3f(Vec3f::Zero());
    }
    const GatherLeaf gather{tables_->kernel, sources, moments, tables_->tree.nodes(), x};
    parallel_for(kCpu, "quadrature/gather", tables_->tree.leaf_count(), gather, kLeafGrain);
}

} // namespace toile
