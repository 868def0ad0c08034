#include "research/paper_rule/far_clusters.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace toile::research {

namespace {

/// Max number of Lloyd iterations: they have nearly always converged before.
constexpr int kMaxIterations = 50;

/// Component of each voxel: covered voxels outside of the box that are connected over their faces; -1
/// elsewhere.
template <int Dim>
std::vector<int> label_components(const VoxelisedMesh<Dim>& mesh, const VoxelBox<Dim>& middle,
                                  int& component_count)
{
    const VoxelGrid<Dim>& grid = mesh.grid();
    std::vector<int> label(grid.count(), -1), queue;
    const auto visit = [&](const Voxel<Dim>& voxel) {
        if (!grid.contains(voxel))
            return;
        const int index = grid.index(voxel);
        if (label[index] >= 0 || !mesh.is_covered()[index] || middle.contains(voxel))
            return;
        label[index] = component_count;
        queue.push_back(index);
    };

    // Search breadth first from every voxel that no component has reached yet.
    component_count = 0;
    for (int start = 0; start < grid.count(); ++start) {
        queue.clear();
        visit(grid.at(start));
        for (size_t next = 0; next < queue.size(); ++next) {
            const Voxel<Dim> voxel = grid.at(queue[next]);
            for (int axis = 0; axis < Dim; ++axis)
                for (const int step : {-1, +1}) {
                    Voxel<Dim> neighbour = voxel;
                    neighbour[axis] += step;
                    visit(neighbour);
                }
        }
        component_count += !queue.empty();
    }
    return label;
}

/// Weighted k-means++ on some vertices of a mesh.
template <int Dim>
class KMeans {
public:
    KMeans(const VoxelisedMesh<Dim>& mesh, const std::vector<int>& vertices, View<const double> u)
        : mesh_(mesh), vertices_(vertices), nearest_(vertices.size(), 0)
    {
        for (const int vertex : vertices)
            weight_.push_back(std::abs(u[vertex]));
    }

    std::vector<FarCluster> run(int count, std::mt19937& random)
    {
        choose_first_centers(count, random);
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            const bool is_changed = assign();
            if (!is_changed && iteration > 0)
                break;
            move_centers();
        }
        return clusters();
    }

private:
    const Point<Dim>& position(int k) const { return mesh_.position(vertices_[k]); }

    void choose_first_centers(int count, std::mt19937& random)
    {
        const auto heaviest = std::max_element(weight_.begin(), weight_.end()) - weight_.begin();
        centers_.assign(1, position(int(heaviest)));
        std::vector<double> squared(vertices_.size(), 1e300), sums(vertices_.size());
        while (int(centers_.size()) < count) {
            double sum = 0.0;
            for (size_t k = 0; k < vertices_.size(); ++k) {
                squared[k] = std::min(squared[k], (position(int(k)) - centers_.back()).squaredNorm());
                sums[k] = sum += weight_[k] * squared[k];
            }
            if (!(sum > 0.0))
                return;
            // Not std::uniform_real_distribution, whose numbers differ between platforms.
            const double draw = sum * (double(random()) / 4294967296.0);
            const auto chosen = std::upper_bound(sums.begin(), sums.end(), draw) - sums.begin();
            centers_.push_back(position(int(std::min<long>(chosen, long(sums.size()) - 1))));
        }
    }

    bool assign()
    {
        bool is_changed = false;
        for (size_t k = 0; k < vertices_.size(); ++k) {
            int nearest = 0;
            for (int c = 1; c < int(centers_.size()); ++c)
                if ((position(int(k)) - centers_[c]).squaredNorm() <
                    (position(int(k)) - centers_[nearest]).squaredNorm())
                    nearest = c;
            is_changed |= nearest != nearest_[k];
            nearest_[k] = nearest;
        }
        return is_changed;
    }

    void move_centers()
    {
        std::vector<Point<Dim>> sum(centers_.size(), Point<Dim>::Zero());
        std::vector<double> weight(centers_.size(), 0.0);
        for (size_t k = 0; k < vertices_.size(); ++k) {
            sum[nearest_[k]] += weight_[k] * position(int(k));
            weight[nearest_[k]] += weight_[k];
        }
        for (size_t c = 0; c < centers_.size(); ++c)
            if (weight[c] > 0.0)
                centers_[c] = sum[c] / weight[c];
    }

    std::vector<FarCluster> clusters() const
    {
        std::vector<FarCluster> result(centers_.size());
        std::vector<double> closest(centers_.size(), 1e300);
        for (size_t k = 0; k < vertices_.size(); ++k) {
            const int c = nearest_[k];
            result[c].volume += mesh_.volume(vertices_[k]);
            const double squared = (position(int(k)) - centers_[c]).squaredNorm();
            if (squared < closest[c]) {
                closest[c] = squared;
                result[c].vertex = vertices_[k];
            }
        }
        std::erase_if(result, [](const FarCluster& cluster) { return !(cluster.volume > 0.0); });
        return result;
    }

    const VoxelisedMesh<Dim>& mesh_;
    const std::vector<int>& vertices_;
    std::vector<double> weight_;
    std::vector<int> nearest_; ///< centre of each vertex
    std::vector<Point<Dim>> centers_;
};

/// Number of clusters per component: one, and the rest by largest remaining volume per cluster.
std::vector<int> apportion(const std::vector<double>& volumes, int count)
{
    std::vector<int> counts(volumes.size(), 1);
    for (int given = int(volumes.size()); given < count; ++given) {
        int neediest = 0;
        for (int c = 1; c < int(volumes.size()); ++c)
            if (volumes[c] / counts[c] > volumes[neediest] / counts[neediest])
                neediest = c;
        ++counts[neediest];
    }
    return counts;
}

} // namespace

template <int Dim>
std::vector<FarCluster> far_clusters(const VoxelisedMesh<Dim>& mesh, const VoxelBox<Dim>& middle,
                                     View<const double> u, int count, unsigned seed)
{
    // Collect vertices and volumes of the components that matter.
    int component_count = 0;
    const std::vector<int> label = label_components(mesh, middle, component_count);
    std::vector<std::vector<int>> vertices(component_count);
    for (int k = 0; k < mesh.vertex_count(); ++k)
        if (const int component = label[mesh.grid().index(mesh.voxel_of(k))]; component >= 0)
            vertices[component].push_back(k);
    std::erase_if(vertices, [&](const std::vector<int>& component) {
        return std::all_of(component.begin(), component.end(), [&](int k) { return u[k] == 0.0; });
    });
    if (vertices.empty())
        return {};
    std::vector<double> volumes;
    for (const std::vector<int>& component : vertices) {
        volumes.push_back(0.0);
        for (const int k : component)
            volumes.back() += mesh.volume(k);
    }

    // Cluster each component on its own.
    std::mt19937 random(seed);
    const std::vector<int> counts = apportion(volumes, count);
    std::vector<FarCluster> clusters;
    for (size_t c = 0; c < vertices.size(); ++c) {
        const std::vector<FarCluster> found = KMeans<Dim>(mesh, vertices[c], u).run(counts[c], random);
        clusters.insert(clusters.end(), found.begin(), found.end());
    }
    return clusters;
}

template std::vector<FarCluster> far_clusters(const VoxelisedMesh<2>&, const VoxelBox<2>&, View<const double>,
                                              int, unsigned);
template std::vector<FarCluster> far_clusters(const VoxelisedMesh<3>&, const VoxelBox<3>&, View<const double>,
                                              int, unsigned);

} // namespace toile::research
