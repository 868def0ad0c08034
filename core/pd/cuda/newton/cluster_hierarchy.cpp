#include "core/pd/cuda/newton/cluster_hierarchy.h"

#include <algorithm>
#include <utility>

#include "core/pd/newton/components.h"
#include "core/quadrature/clusters/cluster_basis.h"

namespace toile {

namespace {

/// Levels of a ClusterTree from leaves to clusters, and from these to parents of blocks.
constexpr int kClusterLevel = 3, kBlockLevels = 4;
static_assert(ClusterTree::kLeaf << kClusterLevel == ClusterHierarchy::kClusterSize);
static_assert(1 << kBlockLevels == ClusterHierarchy::kBlockClusters);

constexpr int kMaxFunctions = ClusterHierarchy::kMaxFunctions;

/// Of as many rows and columns as a cluster has functions.
using Matrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxFunctions, kMaxFunctions>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxFunctions, 1>;

/// Functions of cluster c of a tree level as combinations of those of its ancestor `rise` levels above.
Matrix transfer_of(const ClusterBasis& basis, int tree_level, int c, int rise)
{
    using Stored = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
    const int rank = basis.rank();
    Matrix product = Matrix::Identity(rank, rank);
    for (int k = 0; k < rise; ++k) {
        const int id = basis.tree().first_of_level(tree_level + k) + (c >> k);
        product = product * Stored(basis.transfers().data() + size_t(rank * rank) * size_t(id), rank, rank);
    }
    return product;
}

} // namespace

ClusterHierarchy::ClusterHierarchy(View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                                   const SparseMatrix& isotropic, Extent extent)
    : extent_(extent), cluster_of_(points.size(), -1), functions_(points.size(), PaddedVec3(0.0F))
{
    std::vector<int> others;
    const std::vector<unsigned char> none(points.size(), 0);
    for (std::vector<int>& component : connected_components(blocks, isotropic, none))
        if (int(component.size()) >= ClusterTree::kLeaf)
            add_component(points, std::move(component));
        else
            others.insert(others.end(), component.begin(), component.end());
    add_others(others);
    find_neighbours(blocks, isotropic);
}

void ClusterHierarchy::add_component(View<const EmbeddedPoint> points, std::vector<int> vertices)
{
    const ClusterTree tree(points, std::move(vertices), extent_);
    const ClusterBasis basis(tree, points);
    const int level = std::min(kClusterLevel, tree.level_count() - 1);
    const int first_cluster = cluster_count(), count = tree.level_size(level);
    const int slots = ClusterTree::kLeaf << level;
    for (int c = 0; c < count; ++c) {
        for (int slot = c * slots; slot < std::min((c + 1) * slots, tree.nodes().size()); ++slot) {
            const int v = tree.nodes()[slot];
            if (v < 0)
                continue;
            const Eigen::Map<const Eigen::VectorXd> of_leaf(
                basis.leaves().data() + size_t(function_count()) * size_t(slot), function_count());
            const Vector values =
                transfer_of(basis, 0, slot / ClusterTree::kLeaf, level).transpose() * of_leaf;
            for (int a = 0; a < function_count(); ++a)
                functions_[v].value[a] = float(values[a]);
            cluster_of_[v] = cluster_count();
            vertices_.push_back(v);
        }
        first_vertex_.push_back(int(vertices_.size()));
        block_of_.push_back(block_count() + c / kBlockClusters);
    }
    for (int c = 0; c < count; c += kBlockClusters)
        first_of_block_.push_back(first_cluster + std::min(c + kBlockClusters, count));
    region_of_.resize(cluster_count(), -1);
    transfers_.resize(cluster_count());
    if (count <= kBlockClusters)
        return;

    int rise = 1;
    while (tree.level_size(level + rise) * unknown_count() > kMaxUnknowns)
        ++rise;
    for (int c = 0; c < count; ++c) {
        const int cluster = first_cluster + c;
        if (c % (1 << rise) == 0)
            clusters_of_region_.push_back({cluster, cluster});
        ++clusters_of_region_.back().end;
        region_of_[cluster] = region_count() - 1;
        const Matrix transfer = transfer_of(basis, level, c, rise);
        for (int a = 0; a < function_count(); ++a)
            for (int b = 0; b < function_count(); ++b)
                transfers_[cluster].entry[a][b] = float(transfer(a, b));
    }
    component_of_.resize(region_count(), component_count());
    first_region_.push_back(region_count());
}

void ClusterHierarchy::add_others(const std::vector<int>& vertices)
{
    for (size_t begin = 0; begin < vertices.size(); begin += kClusterSize) {
        const size_t end = std::min(begin + kClusterSize, vertices.size());
        for (size_t k = begin; k < end; ++k) {
            cluster_of_[vertices[k]] = cluster_count();
            vertices_.push_back(vertices[k]);
        }
        first_vertex_.push_back(int(vertices_.size()));
    }
    block_of_.resize(cluster_count(), -1);
    region_of_.resize(cluster_count(), -1);
    transfers_.resize(cluster_count());
}

void ClusterHierarchy::find_neighbours(const BlockMatrix& blocks, const SparseMatrix& isotropic)
{
    first_neighbour_.assign(1, 0);
    for (int c = 0; c < cluster_count(); ++c) {
        std::vector<int> found(block_of_[c] >= 0 ? 1 : 0, c);
        for (int k = first_vertex_[c]; block_of_[c] >= 0 && k < first_vertex_[c + 1]; ++k) {
            const int i = vertices_[k];
            for (const int j : blocks.columns(i))
                found.push_back(cluster_of_[j]);
            for (SparseMatrix::InnerIterator entry(isotropic, i); entry; ++entry)
                found.push_back(cluster_of_[int(entry.col())]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        neighbours_.insert(neighbours_.end(), found.begin(), found.end());
        first_neighbour_.push_back(int(neighbours_.size()));
    }
}

} // namespace toile
