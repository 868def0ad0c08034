#include "core/pd/newton/connected_clusters.h"

#include <algorithm>

#include "core/quadrature/clusters/orthonormalise.h"

namespace toile {

namespace {

/// Level of a ClusterTree: leaves of 8 vertices, doubled three times.
constexpr int kLevel = 3;
static_assert(ClusterTree::kLeaf << kLevel == ConnectedClusters::kSize);

/// Vertices of a piece that is a cluster of its own. Trees took as many iterations with 8.
constexpr int kSmallest = ConnectedClusters::kSize / 4;

} // namespace

ConnectedClusters::ConnectedClusters(View<const EmbeddedPoint> points, const Links& links,
                                     View<const unsigned char> excluded, Extent extent)
{
    std::vector<int> labels(points.size(), -1), first_label{0};
    for (std::vector<int>& component : connected_components(links, excluded)) {
        if (int(component.size()) < ClusterTree::kLeaf) {
            others.insert(others.end(), component.begin(), component.end());
            continue;
        }
        const ClusterTree tree(points, std::move(component), extent);
        const int level = std::min(kLevel, tree.level_count() - 1);
        for (int slot = 0; slot < tree.nodes().size(); ++slot)
            if (const int v = tree.nodes()[slot]; v >= 0)
                labels[v] = first_label.back() + ((slot / ClusterTree::kLeaf) >> level);
        first_label.push_back(first_label.back() + tree.level_size(level));
    }
    groups = connected_groups(links, labels, std::vector<int>(points.size(), 1), kSmallest, kSize);
    for (size_t k = 1; k < first_label.size(); ++k) {
        const auto end = std::lower_bound(groups.label.begin(), groups.label.end(), first_label[k]);
        first_of_component.push_back(int(end - groups.label.begin()));
    }
    for (size_t k = 0; k + 1 < first_label.size(); ++k)
        for (int c = first_of_component[k]; c < first_of_component[k + 1]; ++c)
            groups.label[c] -= first_label[k];
}

std::vector<std::vector<int>> ConnectedClusters::vertices() const
{
    std::vector<std::vector<int>> vertices(count());
    for (int v = 0; v < int(groups.of.size()); ++v)
        if (groups.of[v] >= 0)
            vertices[groups.of[v]].push_back(v);
    return vertices;
}

Eigen::MatrixXd affine_functions(View<const EmbeddedPoint> points, View<const int> vertices, Extent extent)
{
    const ClusterTree::Cluster cluster = ClusterTree::measure(points, vertices, extent);
    Eigen::MatrixXd functions(vertices.size(), rank_of(extent));
    for (int k = 0; k < vertices.size(); ++k) {
        const EmbeddedPoint away = points[vertices[k]] - cluster.center;
        functions(k, 0) = 1.0;
        for (int a = 1; a < rank_of(extent); ++a)
            functions(k, a) = cluster.axes.col(a - 1).dot(away);
    }
    orthonormalise(functions);
    return functions;
}

} // namespace toile
