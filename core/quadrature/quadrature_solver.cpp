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
    basis_.reset();
    tree_.reset();
    if (nodes.empty())
        return;
    tree_ = std::make_unique<ClusterTree>(places_, std::move(nodes));
    basis_ = std::make_unique<ClusterBasis>(*tree_, places_);
    const Cholesky cholesky(H);
    const Eigen::VectorXd diagonal = H.diagonal();
    table_ = *build_kernel_table(cholesky.factor(), {diagonal.data(), int(diagonal.size())}, *basis_,
                                 settings_, nullptr);
}

/// P_C^T b for all clusters, leaves first.
void QuadratureSolver::gather_moments(View<const Vec3> b, View<Vec3f> moments) const
{
    const auto value = [&](int slot) {
        const int v = tree_->nodes()[slot];
        return v >= 0 ? b[v] : Vec3(Vec3::Zero());
    };
    thread_local std::vector<Vec3> sums;
    sums.resize(size_t(kRank) * tree_->cluster_count());
    const View<Vec3> out(sums);
    for (int level = 0; level < tree_->level_count(); ++level)
        parallel_for(
            kCpu, "quadrature/moments", tree_->level_size(level),
            [&](int c) { basis_->gather(level, c, Vec3(Vec3::Zero()), value, out); }, kLeafGrain);
    for (int i = 0; i < moments.size(); ++i)
        moments[i] = sums[i].cast<float>();
}

void QuadratureSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    const StageScope stage("quadrature/solve");
    if (x.data() != b.data())
        std::copy(b.begin(), b.end(), x.begin());
    if (!tree_)
        return;
    thread_local std::vector<Vec3f> moments, sources;
    moments.resize(size_t(kRank) * tree_->cluster_count());
    sources.resize(tree_->nodes().size());
    gather_moments(b, moments);
    for (int slot = 0; slot < int(sources.size()); ++slot) {
        const int v = tree_->nodes()[slot];
        sources[slot] = v >= 0 ? Vec3f(b[v].cast<float>()) : Vec3f(Vec3f::Zero());
    }
    const GatherLeaf gather{table_, sources, moments, tree_->nodes(), x};
    parallel_for(kCpu, "quadrature/gather", tree_->leaf_count(), gather, kLeafGrain);
}

} // namespace toile
