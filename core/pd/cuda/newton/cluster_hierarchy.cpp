#include "core/pd/cuda/newton/cluster_hierarchy.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "core/quadrature/clusters/orthonormalise.h"

namespace toile {

namespace {

/// Levels of a ClusterTree from clusters to blocks.
constexpr int kBlockLevels = 4;
static_assert(1 << kBlockLevels == ClusterHierarchy::kBlockClusters);

/// Clusters of a component.
struct Component {
    Links links;
    std::vector<int> numbers; ///< [clusters] in the level of the component's tree
};

Component component_of_clusters(const Links& links, const Groups& clusters, int first, int end)
{
    Component component;
    for (int c = first; c < end; ++c) {
        for (const int d : links.of(c))
            component.links.to.push_back(d - first);
        component.links.first.push_back(int(component.links.to.size()));
        component.numbers.push_back(clusters.label[c]);
    }
    return component;
}

/// Connected items of one number, once this is divided by 2^levels.
Groups groups_by(int levels, const Links& links, std::vector<int> numbers, View<const int> weights,
                 int smallest)
{
    for (int& number : numbers)
        number >>= levels;
    return connected_groups(links, numbers, weights, smallest, ClusterHierarchy::kBlockClusters);
}

/// Clusters of a block that joins no other.
constexpr int kSmallestBlock = ClusterHierarchy::kBlockClusters / 4;

/// Regions and blocks of a component, one of which consist of the other.
struct Nested {
    std::vector<int> region, block; ///< [clusters]
    int region_count;
    std::vector<int> order; ///< clusters, those of a region and of a block one after the other
};

std::vector<int> order_by(const std::vector<int>& coarser, const std::vector<int>& finer)
{
    std::vector<int> order(finer.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return std::tie(coarser[a], finer[a], a) < std::tie(coarser[b], finer[b], b);
    });
    return order;
}

/// @param levels  of the tree from clusters to regions
Nested regions_in_blocks(const Component& component, int levels, int max_regions)
{
    const std::vector<int> ones(component.numbers.size(), 1);
    const Groups regions = joined_groups(
        component.links,
        groups_by(levels, component.links, component.numbers, ones, std::max(2, (1 << levels) / 4)), ones,
        max_regions, ClusterHierarchy::kBlockClusters);
    const Groups blocks = groups_by(kBlockLevels - levels, links_between(component.links, regions),
                                    regions.label, sums_of(regions, ones), kSmallestBlock);
    std::vector<int> block;
    for (const int region : regions.of)
        block.push_back(blocks.of[region]);
    return {regions.of, block, regions.count(), order_by(block, regions.of)};
}

Nested regions_of_blocks(const Component& component, int max_regions)
{
    const std::vector<int> ones(component.numbers.size(), 1);
    const Groups blocks = groups_by(kBlockLevels, component.links, component.numbers, ones, kSmallestBlock);
    const Groups regions = joined_groups(component.links, blocks, ones, max_regions, int(ones.size()));
    return {regions.of, blocks.of, regions.count(), order_by(regions.of, blocks.of)};
}

/// Those with as many regions as is possible.
Nested finest_groups(const Component& component, int max_regions)
{
    for (int levels = 1; levels < kBlockLevels; ++levels)
        if (Nested nested = regions_in_blocks(component, levels, max_regions);
            nested.region_count <= max_regions)
            return nested;
    return regions_of_blocks(component, max_regions);
}

} // namespace

ClusterHierarchy::ClusterHierarchy(View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                                   const SparseMatrix& isotropic, Extent extent)
    : extent_(extent), cluster_of_(points.size(), -1), functions_(points.size(), PaddedVec3(0.0F))
{
    const std::vector<unsigned char> none(points.size(), 0);
    const Links links = links_of(blocks, isotropic, none);
    const ConnectedClusters clusters(points, links, none, extent);
    const Links between = links_between(links, clusters.groups);
    const std::vector<std::vector<int>> vertices = clusters.vertices();
    const std::vector<int>& first = clusters.first_of_component;
    for (size_t k = 0; k + 1 < first.size(); ++k) {
        const View<const std::vector<int>> own(vertices.data() + first[k], first[k + 1] - first[k]);
        if (own.size() > kBlockClusters) {
            const Component component =
                component_of_clusters(between, clusters.groups, first[k], first[k + 1]);
            const Nested nested = finest_groups(component, kMaxUnknowns / unknown_count());
            add_component(points, own, nested.order, nested.region, nested.block);
        } else {
            for (const std::vector<int>& cluster : own) // one block
                add_cluster(points, cluster);
            first_of_block_.push_back(cluster_count());
        }
    }
    add_others(clusters.others);

    // From ranges to the number of each of their items.
    component_of_.resize(region_count());
    for (int k = 0; k < component_count(); ++k)
        std::fill(component_of_.begin() + first_region_[k], component_of_.begin() + first_region_[k + 1], k);
    region_of_.assign(cluster_count(), -1);
    transfers_.resize(cluster_count());
    for (int r = 0; r < region_count(); ++r)
        find_transfers(points, r);
    find_neighbours(blocks, isotropic);
    find_members();
}

void ClusterHierarchy::add_cluster(View<const EmbeddedPoint> points, const std::vector<int>& vertices)
{
    const Eigen::MatrixXd functions = affine_functions(points, vertices, extent_);
    for (size_t k = 0; k < vertices.size(); ++k) {
        for (int a = 0; a < function_count(); ++a)
            functions_[vertices[k]].value[a] = float(functions(Eigen::Index(k), a));
        cluster_of_[vertices[k]] = cluster_count();
    }
    vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
    first_vertex_.push_back(int(vertices_.size()));
}

void ClusterHierarchy::add_component(View<const EmbeddedPoint> points, View<const std::vector<int>> clusters,
                                     const std::vector<int>& order, const std::vector<int>& region,
                                     const std::vector<int>& block)
{
    int before = -1;
    for (const int c : order) {
        if (before >= 0 && block[c] != block[before])
            first_of_block_.push_back(cluster_count());
        if (before < 0 || region[c] != region[before])
            clusters_of_region_.push_back({cluster_count(), cluster_count()});
        add_cluster(points, clusters[c]);
        ++clusters_of_region_.back().end;
        before = c;
    }
    first_of_block_.push_back(cluster_count());
    first_region_.push_back(region_count());
}

void ClusterHierarchy::find_transfers(View<const EmbeddedPoint> points, int region)
{
    const Range range = clusters_of_region_[region];
    const int first = first_vertex_[range.first], rank = function_count();
    const View<const int> vertices(vertices_.data() + first, first_vertex_[range.end] - first);
    const Eigen::MatrixXd of_region = affine_functions(points, vertices, extent_);
    Eigen::MatrixXd transfers = Eigen::MatrixXd::Zero(rank * (range.end - range.first), rank);
    for (int k = 0; k < vertices.size(); ++k) {
        const int c = cluster_of_[vertices[k]] - range.first;
        for (int a = 0; a < rank; ++a)
            transfers.row(rank * c + a) += double(functions_[vertices[k]].value[a]) * of_region.row(k);
    }
    orthonormalise(transfers);
    for (int c = range.first; c < range.end; ++c) {
        region_of_[c] = region;
        for (int a = 0; a < rank; ++a)
            for (int b = 0; b < rank; ++b)
                transfers_[c].entry[a][b] = float(transfers(rank * (c - range.first) + a, b));
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
}

void ClusterHierarchy::find_neighbours(const BlockMatrix& blocks, const SparseMatrix& isotropic)
{
    first_neighbour_.assign(1, 0);
    for (int c = 0; c < first_of_block_.back(); ++c) {
        std::vector<int> found(1, c);
        for (int k = first_vertex_[c]; k < first_vertex_[c + 1]; ++k) {
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
    first_neighbour_.resize(cluster_count() + 1, int(neighbours_.size()));
}

bool ClusterHierarchy::is_part_of_region(int first_cluster, int end_cluster) const
{
    const int region = region_of_[first_cluster];
    if (region < 0)
        return false;
    const Range range = clusters_of_region_[region];
    return range.first <= first_cluster && end_cluster <= range.end &&
           end_cluster - first_cluster < range.end - range.first;
}

void ClusterHierarchy::find_members()
{
    std::vector<std::vector<Copy>> copies(cluster_count());
    for (size_t b = 0; b + 1 < first_of_block_.size(); ++b) {
        const int begin = first_of_block_[b], end = first_of_block_[b + 1];
        std::vector<int> clusters(end - begin);
        std::iota(clusters.begin(), clusters.end(), begin);
        if (is_part_of_region(begin, end)) {
            const std::set<int> near(neighbours_.begin() + first_neighbour_[begin],
                                     neighbours_.begin() + first_neighbour_[end]);
            if (int(near.size()) <= kMaxBlockClusters)
                clusters.assign(near.begin(), near.end());
        }
        for (size_t place = 0; place < clusters.size(); ++place) {
            members_.push_back({clusters[place], -1});
            copies[clusters[place]].push_back({int(b), int(place)});
        }
        first_member_.push_back(int(members_.size()));
    }
    for (const std::vector<Copy>& of_cluster : copies) {
        for (const Copy& copy : of_cluster) {
            members_[first_member_[copy.block] + copy.place].copy = int(copies_.size());
            copies_.push_back(copy);
        }
        first_copy_.push_back(int(copies_.size()));
    }
}

} // namespace toile
