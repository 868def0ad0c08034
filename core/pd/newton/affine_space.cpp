#include "core/pd/newton/affine_space.h"

#include <algorithm>
#include <array>

#include "core/compute/parallel.h"
#include "core/pd/newton/block_cholesky.h"
#include "core/pd/newton/connected_clusters.h"

namespace toile {

namespace {

void insert_sorted(std::vector<int>& list, int value)
{
    const auto at = std::lower_bound(list.begin(), list.end(), value);
    if (at == list.end() || *at != value)
        list.insert(at, value);
}

/// @tparam kExtent  of the clusters: their functions are 1 and a coordinate along each of its axes
template <Extent kExtent>
class AffineSpaceOf : public AffineSpace {
public:
    explicit AffineSpaceOf(std::vector<EmbeddedPoint> points) : AffineSpace(std::move(points)) {}

    void find_clusters(const HessianParts& K) override;
    bool update(const HessianParts& K) override;
    void restrict_to(int cluster, View<const PaddedVec3> r) override;
    void solve() override;
    void prolong(int cluster, View<PaddedVec3> z) const override;

private:
    static constexpr int kFunctions = rank_of(kExtent); ///< of a cluster, each for x, y and z
    static constexpr int kUnknowns = 3 * kFunctions;
    using Functions = Eigen::Matrix<double, kFunctions, 1>;
    using Factor = BlockCholesky<kUnknowns>;
    using Block = typename Factor::Block;

    /// Contact term on the coarse unknowns: for each cluster that it touches, sum_k weight_k p_k.
    struct CoarseTerm {
        std::array<int, 4> cluster{-1, -1, -1, -1};
        std::array<Functions, 4> weight;
        Mat3 stiffness;
    };

    void find_terms(const std::vector<FrozenTerm>& terms);
    void find_couplings(const HessianParts& K);
    bool add_couplings_of_terms();
    void assemble(const HessianParts& K, int cluster);

    std::vector<int> cluster_of_;      ///< [vertices] -1: none
    std::vector<Functions> functions_; ///< [vertices] values of the functions of its cluster
    std::vector<Floats<4>> functions_of_row_;
    std::vector<CoarseTerm> terms_;
    std::vector<std::vector<int>> terms_of_;  ///< [clusters] 4 * term + slot
    std::vector<std::vector<int>> couplings_; ///< [clusters] coupled clusters, ascending, itself included
    bool has_new_couplings_ = true;
    Factor factor_;
    std::vector<typename Factor::Vector> coarse_; ///< [clusters] right-hand side, then solution
};

template <Extent kExtent>
void AffineSpaceOf<kExtent>::find_clusters(const HessianParts& K)
{
    functions_.assign(points_.size(), Functions::Zero());
    order_.clear();
    first_of_cluster_.assign(1, 0);
    const ConnectedClusters clusters(points_, links_of(K.blocks, K.isotropic, K.fixed), K.fixed, kExtent);
    cluster_of_ = clusters.groups.of;
    for (const std::vector<int>& vertices : clusters.vertices()) {
        const Eigen::MatrixXd functions = affine_functions(points_, vertices, kExtent);
        for (size_t k = 0; k < vertices.size(); ++k)
            functions_[vertices[k]] = functions.row(Eigen::Index(k));
        order_.insert(order_.end(), vertices.begin(), vertices.end());
        first_of_cluster_.push_back(int(order_.size()));
    }
    order_.insert(order_.end(), clusters.others.begin(), clusters.others.end());
    functions_of_row_.assign(order_.size(), Floats<4>(0.0F));
    for (size_t row = 0; row < order_.size(); ++row)
        for (int a = 0; a < kFunctions; ++a)
            functions_of_row_[row].value[a] = float(functions_[order_[row]][a]);
    find_couplings(K);
    coarse_.resize(cluster_count());
    has_new_couplings_ = true;
}

template <Extent kExtent>
bool AffineSpaceOf<kExtent>::update(const HessianParts& K)
{
    const StageScope stage("newton/coarse");
    find_terms(K.terms);
    if (add_couplings_of_terms() || has_new_couplings_)
        factor_ = Factor(couplings_);
    has_new_couplings_ = false;
    parallel_for(
        kCpu, "newton/coarse_matrix", cluster_count(), [&](int c) { assemble(K, c); }, 1);
    return factor_.factor();
}

template <Extent kExtent>
void AffineSpaceOf<kExtent>::find_couplings(const HessianParts& K)
{
    couplings_.assign(cluster_count(), {});
    for (int c = 0; c < cluster_count(); ++c) {
        insert_sorted(couplings_[c], c);
        for (int k = first_of_cluster_[c]; k < first_of_cluster_[c + 1]; ++k) {
            const int i = order_[k];
            for (const int j : K.blocks.columns(i))
                if (cluster_of_[j] >= 0)
                    insert_sorted(couplings_[c], cluster_of_[j]);
            for (SparseMatrix::InnerIterator entry(K.isotropic, i); entry; ++entry)
                if (cluster_of_[entry.col()] >= 0)
                    insert_sorted(couplings_[c], cluster_of_[entry.col()]);
        }
    }
}

template <Extent kExtent>
void AffineSpaceOf<kExtent>::find_terms(const std::vector<FrozenTerm>& terms)
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
template <Extent kExtent>
bool AffineSpaceOf<kExtent>::add_couplings_of_terms()
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

/// Writes the rows of a cluster: sum_ij (p_i p_j^T) (x) K_ij over its vertices i. Row sums
/// S = sum_j p_j K_ij over the vertices j of another cluster come first, so that each K_ij is multiplied by
/// as many numbers as there are functions, and not by their pairs.
template <Extent kExtent>
void AffineSpaceOf<kExtent>::assemble(const HessianParts& K, int cluster)
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
        const int i = order_[k];
        const View<const int> neighbours = K.blocks.columns(i);
        for (int e = 0; e < neighbours.size(); ++e) {
            const int j = neighbours[e];
            if (cluster_of_[j] < 0)
                continue;
            std::array<Mat3, kFunctions>& sum = sum_of(cluster_of_[j]);
            for (int b = 0; b < kFunctions; ++b)
                sum[b] += functions_[j][b] * K.blocks.blocks(i)[e];
        }
        for (SparseMatrix::InnerIterator entry(K.isotropic, i); entry; ++entry) {
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
                    row[slot].template block<3, 3>(3 * a, 3 * b) += functions_[i][a] * sums[slot][b];
            has_sum[slot] = 0;
        }
    }
    for (const int entry : terms_of_[cluster]) {
        const CoarseTerm& term = terms_[entry / 4];
        for (int l = 0; l < 4 && term.cluster[l] >= 0; ++l) {
            Block& to = row[slot_of(term.cluster[l])];
            for (int a = 0; a < kFunctions; ++a)
                for (int b = 0; b < kFunctions; ++b)
                    to.template block<3, 3>(3 * a, 3 * b) +=
                        term.weight[entry % 4][a] * term.weight[l][b] * term.stiffness;
        }
    }
    // A cluster on a line or in a plane has fewer functions: the others are zero.
    Block& diagonal = row[slot_of(cluster)];
    for (int a = 0; a < kUnknowns; ++a)
        if (diagonal(a, a) == 0.0)
            diagonal(a, a) = 1.0;

    for (size_t slot = 0; slot < columns.size(); ++slot)
        factor_.entry(cluster, int(slot)) = row[slot];
}

template <Extent kExtent>
void AffineSpaceOf<kExtent>::restrict_to(int cluster, View<const PaddedVec3> r)
{
    PaddedVec3 sum[kFunctions];
    std::fill(std::begin(sum), std::end(sum), PaddedVec3(0.0F));
    for (int row = first_row(cluster); row < first_row(cluster + 1); ++row)
        for (int a = 0; a < kFunctions; ++a)
            sum[a] += functions_of_row_[row][a] * r[row];
    for (int a = 0; a < kFunctions; ++a)
        for (int k = 0; k < 3; ++k)
            coarse_[cluster][3 * a + k] = sum[a][k];
}

template <Extent kExtent>
void AffineSpaceOf<kExtent>::solve()
{
    factor_.solve(coarse_);
}

template <Extent kExtent>
void AffineSpaceOf<kExtent>::prolong(int cluster, View<PaddedVec3> z) const
{
    PaddedVec3 u[kFunctions];
    for (int a = 0; a < kFunctions; ++a)
        u[a] = padded(Vec3(coarse_[cluster].template segment<3>(3 * a).template cast<double>()));
    for (int row = first_row(cluster); row < first_row(cluster + 1); ++row) {
        const Floats<4>& p = functions_of_row_[row];
        for (int k = 0; k < 4; ++k) {
            float sum = p.value[0] * u[0].value[k];
            for (int a = 1; a < kFunctions; ++a)
                sum += p.value[a] * u[a].value[k];
            z[row].value[k] = sum;
        }
    }
}

} // namespace

std::unique_ptr<AffineSpace> AffineSpace::make(std::vector<EmbeddedPoint> points, Extent extent)
{
    if (extent == Extent::Surface)
        return std::make_unique<AffineSpaceOf<Extent::Surface>>(std::move(points));
    return std::make_unique<AffineSpaceOf<Extent::Volume>>(std::move(points));
}

} // namespace toile
