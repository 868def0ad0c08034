#include "core/pd/preconditioner/affine_space.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/quadrature/clusters/cluster_basis.h"

namespace toile {

namespace {

/// Level of the cluster tree: leaves of 8 vertices, doubled three times.
constexpr int kLevel = 3;

/// Values of the functions of the cluster of level `level` that contains a slot.
Eigen::Vector3d functions_at(const ClusterBasis& basis, int slot, int level)
{
    using Transfer = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    const int leaf = slot / ClusterTree::kLeaf;
    Eigen::Vector3d values = Eigen::Map<const Eigen::Vector3d>(basis.leaves().data() + 3 * size_t(slot));
    for (int k = 0; k < level; ++k) {
        const int id = basis.tree().first_of_level(k) + (leaf >> k);
        values = Transfer(basis.transfers().data() + 9 * size_t(id)).transpose() * values;
    }
    return values;
}

/// Components of the free vertices that entries of K connect, each ascending.
std::vector<std::vector<int>> components_of(const HessianParts& K)
{
    const int n = K.fixed.size();
    std::vector<unsigned char> seen(K.fixed.begin(), K.fixed.end());
    std::vector<std::vector<int>> components;
    for (int start = 0; start < n; ++start) {
        if (seen[start])
            continue;
        std::vector<int> found{start};
        seen[start] = 1;
        const auto add = [&](int j) {
            if (!seen[j])
                found.push_back(j);
            seen[j] = 1;
        };
        for (size_t k = 0; k < found.size(); ++k) {
            for (const int j : K.blocks.columns(found[k]))
                add(j);
            for (SparseMatrix::InnerIterator entry(K.constant, found[k]); entry; ++entry)
                add(int(entry.col()));
        }
        std::sort(found.begin(), found.end());
        components.push_back(std::move(found));
    }
    return components;
}

void insert_sorted(std::vector<int>& list, int value)
{
    const auto at = std::lower_bound(list.begin(), list.end(), value);
    if (at == list.end() || *at != value)
        list.insert(at, value);
}

} // namespace

bool AffineSpace::update(const HessianParts& K)
{
    const StageScope stage("newton/coarse");
    const bool is_new = !std::equal(K.fixed.begin(), K.fixed.end(), fixed_.begin(), fixed_.end());
    if (is_new) {
        find_clusters(K);
        find_couplings(K);
    }
    is_factored_ = false;
    if (cluster_count() == 0)
        return true;
    find_terms(K.terms);
    if (add_couplings_of_terms() || is_new)
        build_pattern();
    parallel_for(
        kCpu, "newton/coarse_matrix", cluster_count(), [&](int c) { assemble(K, c); }, 1);
    try {
        if (factor_)
            factor_->refactor(matrix_);
        else
            factor_.emplace(matrix_);
    } catch (const InvalidInput&) { // by rounding
        factor_.reset();
        return false;
    }
    is_factored_ = true;
    return true;
}

void AffineSpace::find_clusters(const HessianParts& K)
{
    fixed_.assign(K.fixed.begin(), K.fixed.end());
    TOILE_ASSERT(points_.size() == fixed_.size());
    cluster_of_.assign(points_.size(), -1);
    functions_.assign(points_.size(), Functions::Zero());
    vertices_.clear();
    first_of_cluster_.assign(1, 0);
    for (std::vector<int>& component : components_of(K))
        if (int(component.size()) >= ClusterTree::kLeaf)
            add_component(std::move(component));
}

void AffineSpace::add_component(std::vector<int> vertices)
{
    const ClusterTree tree(points_, std::move(vertices));
    const ClusterBasis basis(tree, points_);
    const int level = std::min(kLevel, tree.level_count() - 1);
    const int slots = ClusterTree::kLeaf << level;
    for (int c = 0; c < tree.level_size(level); ++c) {
        for (int slot = c * slots; slot < std::min((c + 1) * slots, tree.nodes().size()); ++slot) {
            const int v = tree.nodes()[slot];
            if (v < 0)
                continue;
            cluster_of_[v] = cluster_count();
            functions_[v] = functions_at(basis, slot, level);
            vertices_.push_back(v);
        }
        first_of_cluster_.push_back(int(vertices_.size()));
    }
}

void AffineSpace::find_couplings(const HessianParts& K)
{
    couplings_.assign(cluster_count(), {});
    for (int c = 0; c < cluster_count(); ++c) {
        insert_sorted(couplings_[c], c);
        for (int k = first_of_cluster_[c]; k < first_of_cluster_[c + 1]; ++k) {
            const int i = vertices_[k];
            for (const int j : K.blocks.columns(i))
                if (cluster_of_[j] >= 0)
                    insert_sorted(couplings_[c], cluster_of_[j]);
            for (SparseMatrix::InnerIterator entry(K.constant, i); entry; ++entry)
                if (cluster_of_[entry.col()] >= 0)
                    insert_sorted(couplings_[c], cluster_of_[entry.col()]);
        }
    }
}

void AffineSpace::find_terms(const std::vector<FrozenTerm>& terms)
{
    terms_.clear();
    terms_of_.assign(cluster_count(), {});
    for (const FrozenTerm& term : terms) {
        CoarseTerm coarse;
        coarse.stiffness = term.stiffness;
        int count = 0;
        for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k) {
            const int c = cluster_of_[term.vertex[k]];
            if (c < 0)
                continue;
            const int slot = int(std::find(coarse.cluster.begin(), coarse.cluster.begin() + count, c) -
                                 coarse.cluster.begin());
            if (slot == count) {
                coarse.cluster[count] = c;
                coarse.weight[count++] = Functions::Zero();
            }
            coarse.weight[slot] += term.weight[k] * functions_[term.vertex[k]];
        }
        for (int k = 0; k < count; ++k)
            terms_of_[coarse.cluster[k]].push_back(4 * int(terms_.size()) + k);
        if (count > 0)
            terms_.push_back(coarse);
    }
}

/// True if terms couple clusters that nothing coupled before. Couplings are kept: cloth that touches tends to
/// touch again, and a known pattern needs no new ordering.
bool AffineSpace::add_couplings_of_terms()
{
    bool is_new = false;
    for (const CoarseTerm& term : terms_)
        for (int k = 0; k < 4 && term.cluster[k] >= 0; ++k)
            for (int l = 0; l < 4 && term.cluster[l] >= 0; ++l) {
                std::vector<int>& row = couplings_[term.cluster[k]];
                if (std::binary_search(row.begin(), row.end(), term.cluster[l]))
                    continue;
                insert_sorted(row, term.cluster[l]);
                is_new = true;
            }
    return is_new;
}

void AffineSpace::build_pattern()
{
    const int n = kUnknowns * cluster_count();
    factor_.reset();
    coarse_.assign(n, Vec3::Zero());
    matrix_.resize(n, n);
    std::vector<int> entries_of_row(n);
    for (int row = 0; row < n; ++row)
        entries_of_row[row] = kUnknowns * int(couplings_[row / kUnknowns].size());
    matrix_.reserve(entries_of_row);
    for (int row = 0; row < n; ++row)
        for (const int c : couplings_[row / kUnknowns])
            for (int k = 0; k < kUnknowns; ++k)
                matrix_.insert(row, kUnknowns * c + k) = 0.0;
    matrix_.makeCompressed();
}

/// Writes the rows of a cluster: sum_ij (p_i p_j^T) (x) K_ij over its vertices i. Row sums
/// S = sum_j p_j K_ij over the vertices j of another cluster come first, so that each K_ij is multiplied by
/// three numbers and not by nine.
void AffineSpace::assemble(const HessianParts& K, int cluster)
{
    const std::vector<int>& columns = couplings_[cluster];
    std::vector<Block> row(columns.size(), Block::Zero());
    std::vector<std::array<Mat3, kFunctions>> sums(columns.size());
    std::vector<unsigned char> has_sum(columns.size(), 0);
    const auto slot_of = [&](int c) {
        return int(std::lower_bound(columns.begin(), columns.end(), c) - columns.begin());
    };
    const auto sum_of = [&](int c) -> std::array<Mat3, kFunctions>& {
        const int slot = slot_of(c);
        if (!has_sum[slot])
            sums[slot].fill(Mat3::Zero());
        has_sum[slot] = 1;
        return sums[slot];
    };
    for (int k = first_of_cluster_[cluster]; k < first_of_cluster_[cluster + 1]; ++k) {
        const int i = vertices_[k];
        const View<const int> neighbours = K.blocks.columns(i);
        for (int e = 0; e < neighbours.size(); ++e) {
            const int j = neighbours[e];
            if (cluster_of_[j] < 0)
                continue;
            std::array<Mat3, kFunctions>& sum = sum_of(cluster_of_[j]);
            for (int b = 0; b < kFunctions; ++b)
                sum[b] += functions_[j][b] * K.blocks.blocks(i)[e];
        }
        for (SparseMatrix::InnerIterator entry(K.constant, i); entry; ++entry) {
            const int j = int(entry.col());
            if (cluster_of_[j] < 0)
                continue;
            std::array<Mat3, kFunctions>& sum = sum_of(cluster_of_[j]);
            const double value = entry.value() + (i == j ? K.inertia[i] : 0.0);
            for (int b = 0; b < kFunctions; ++b)
                sum[b].diagonal().array() += functions_[j][b] * value;
        }
        for (size_t slot = 0; slot < columns.size(); ++slot) {
            if (!has_sum[slot])
                continue;
            for (int a = 0; a < kFunctions; ++a)
                for (int b = 0; b < kFunctions; ++b)
                    row[slot].block<3, 3>(3 * a, 3 * b) += functions_[i][a] * sums[slot][b];
            has_sum[slot] = 0;
        }
    }
    for (const int entry : terms_of_[cluster]) {
        const CoarseTerm& term = terms_[entry / 4];
        for (int l = 0; l < 4 && term.cluster[l] >= 0; ++l) {
            Block& to = row[slot_of(term.cluster[l])];
            for (int a = 0; a < kFunctions; ++a)
                for (int b = 0; b < kFunctions; ++b)
                    to.block<3, 3>(3 * a, 3 * b) +=
                        term.weight[entry % 4][a] * term.weight[l][b] * term.stiffness;
        }
    }
    // A cluster on a line has fewer functions: the others are zero.
    Block& diagonal = row[slot_of(cluster)];
    for (int a = 0; a < kUnknowns; ++a)
        if (diagonal(a, a) == 0.0)
            diagonal(a, a) = 1.0;

    double* value = matrix_.valuePtr() + matrix_.outerIndexPtr()[kUnknowns * cluster];
    for (int a = 0; a < kUnknowns; ++a)
        for (const Block& block : row)
            for (int b = 0; b < kUnknowns; ++b)
                *value++ = block(a, b);
}

void AffineSpace::correct(View<const Vec3> r, View<Vec3> z)
{
    if (!is_factored_)
        return;
    const StageScope stage("newton/coarse_solve");
    parallel_for(
        kCpu, "newton/restrict", cluster_count(),
        [&](int c) {
            Mat3 sum = Mat3::Zero(); // column a: function a
            for (int k = first_of_cluster_[c]; k < first_of_cluster_[c + 1]; ++k)
                sum += r[vertices_[k]] * functions_[vertices_[k]].transpose();
            for (int a = 0; a < kUnknowns; ++a)
                coarse_[kUnknowns * c + a] = Vec3(sum.data()[a], 0.0, 0.0);
        },
        16);
    factor_->solve(coarse_, coarse_);
    parallel_for(
        kCpu, "newton/prolong", cluster_count(),
        [&](int c) {
            Mat3 sum;
            for (int a = 0; a < kUnknowns; ++a)
                sum.data()[a] = coarse_[kUnknowns * c + a].x();
            for (int k = first_of_cluster_[c]; k < first_of_cluster_[c + 1]; ++k)
                z[vertices_[k]] += sum * functions_[vertices_[k]];
        },
        16);
}

} // namespace toile
