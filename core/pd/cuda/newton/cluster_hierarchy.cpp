#include "core/pd/cuda/newton/cluster_hierarchy.h"

#include <algorithm>
#include <utility>

#include "core/pd/newton/components.h"
#include "core/quadrature/clusters/cluster_basis.h"

namespace toile {

namespace {

/// Level of a ClusterTree with clusters of kClusterSize, and the distance of levels of kChildren.
constexpr int kFirstTreeLevel = 3, kTreeLevels = 4;
static_assert(ClusterTree::kLeaf << kFirstTreeLevel == ClusterHierarchy::kClusterSize);
static_assert(1 << kTreeLevels == ClusterHierarchy::kChildren);

using Matrix = Eigen::Matrix<double, ClusterHierarchy::kFunctions, ClusterHierarchy::kFunctions>;

/// Functions of cluster c of a tree level as combinations of those of its ancestor `rise` levels above.
Matrix transfer_of(const ClusterBasis& basis, int tree_level, int c, int rise)
{
    using Stored = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    Matrix product = Matrix::Identity();
    for (int k = 0; k < rise; ++k) {
        const int id = basis.tree().first_of_level(tree_level + k) + (c >> k);
        product = product * Stored(basis.transfers().data() + 9 * size_t(id));
    }
    return product;
}

} // namespace

ClusterHierarchy::ClusterHierarchy(View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                                   const SparseMatrix& isotropic)
    : cluster_of_(points.size(), -1), functions_(points.size(), PaddedVec3(0.0F)), levels_(1)
{
    std::vector<int> others;
    const std::vector<unsigned char> none(points.size(), 0);
    for (std::vector<int>& component : connected_components(blocks, isotropic, none))
        if (int(component.size()) >= ClusterTree::kLeaf)
            add_component(points, std::move(component));
        else
            others.insert(others.end(), component.begin(), component.end());
    add_others(others);
    for (int level = 0; level < int(levels_.size()); ++level)
        find_blocks(level);
}

void ClusterHierarchy::add_component(View<const EmbeddedPoint> points, std::vector<int> vertices)
{
    const ClusterTree tree(points, std::move(vertices));
    const ClusterBasis basis(tree, points);
    const int base = std::min(kFirstTreeLevel, tree.level_count() - 1);
    const int first_cluster = cluster_count(), slots = ClusterTree::kLeaf << base;
    for (int c = 0; c < tree.level_size(base); ++c) {
        for (int slot = c * slots; slot < std::min((c + 1) * slots, tree.nodes().size()); ++slot) {
            const int v = tree.nodes()[slot];
            if (v < 0)
                continue;
            const int leaf = slot / ClusterTree::kLeaf;
            const Eigen::Map<const Eigen::Vector3d> of_leaf(basis.leaves().data() + 3 * size_t(slot));
            functions_[v] = padded(Vec3(transfer_of(basis, 0, leaf, base).transpose() * of_leaf));
            cluster_of_[v] = cluster_count();
            vertices_.push_back(v);
        }
        first_vertex_.push_back(int(vertices_.size()));
    }

    for (int level = 0, tree_level = base;; ++level, tree_level += kTreeLevels) {
        if (level == int(levels_.size()))
            levels_.emplace_back();
        Level& to = levels_[level];
        to.cluster_of.resize(first_cluster, -1); // of components with fewer levels
        to.transfer.resize(first_cluster);
        for (int c = 0; c < tree.level_size(base); ++c) {
            const Matrix transfer = transfer_of(basis, base, c, tree_level - base);
            Transfer stored;
            for (int a = 0; a < kFunctions; ++a)
                for (int b = 0; b < kFunctions; ++b)
                    stored.entry[a][b] = float(transfer(a, b));
            to.transfer.push_back(stored);
            to.cluster_of.push_back(to.cluster_count + (c >> (tree_level - base)));
        }
        to.cluster_count += tree.level_size(tree_level);
        if (tree.level_size(tree_level) <= kChildren || level + 1 == kMaxLevels)
            break;
    }
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
    for (Level& level : levels_) {
        level.cluster_of.resize(cluster_count(), -1);
        level.transfer.resize(cluster_count());
    }
}

/// Groups the clusters of a level: those of one parent, and those without any.
void ClusterHierarchy::find_blocks(int level)
{
    Level& of = levels_[level];
    of.first_of_cluster.assign(of.cluster_count, -1);
    of.end_of_cluster.assign(of.cluster_count, 0);
    std::vector<int> parent(of.cluster_count, -1);
    for (int c = 0; c < cluster_count(); ++c) {
        const int cluster = of.cluster_of[c];
        if (cluster < 0)
            continue;
        if (of.first_of_cluster[cluster] < 0)
            of.first_of_cluster[cluster] = c;
        of.end_of_cluster[cluster] = c + 1;
        if (level + 1 < int(levels_.size()))
            parent[cluster] = levels_[level + 1].cluster_of[c];
    }
    for (int k = 0; k < of.cluster_count; ++k) {
        const bool begins = k == 0 || parent[k] != parent[k - 1] || of.slot_of.back() + 1 == kChildren;
        if (begins)
            of.first_of_block.push_back(k);
        of.block_of.push_back(int(of.first_of_block.size()) - 1);
        of.slot_of.push_back(k - of.first_of_block.back());
    }
    of.first_of_block.push_back(of.cluster_count);
}

} // namespace toile
