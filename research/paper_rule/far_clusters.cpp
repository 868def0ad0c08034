#include "research/paper_rule/far_clusters.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace toile::research {

namespace {

/// Max number of Lloyd iterations: they have nearly always converged before.
constexpr int kMaxIterations = 50;

/// Component of each pixel: covered pixels outside of the box that are connected over their sides; -1
/// elsewhere.
std::vector<int> label_components(const UvSurface& surface, const PixelBox& middle, int& component_count)
{
    const PixelGrid& grid = surface.grid();
    std::vector<int> label(grid.count(), -1), queue;
    const auto visit = [&](const Pixel& pixel) {
        if (pixel[0] < 0 || pixel[0] >= grid.size[0] || pixel[1] < 0 || pixel[1] >= grid.size[1])
            return;
        const int index = grid.index(pixel);
        if (label[index] >= 0 || !surface.is_covered()[index] || middle.contains(pixel))
            return;
        label[index] = component_count;
        queue.push_back(index);
    };

    // Search breadth first from every pixel that no component has reached yet.
    component_count = 0;
    for (int start = 0; start < grid.count(); ++start) {
        queue.clear();
        visit(grid.at(start));
        for (size_t next = 0; next < queue.size(); ++next) {
            const Pixel pixel = grid.at(queue[next]);
            for (const int step : {-1, +1}) {
                visit({pixel[0] + step, pixel[1]});
                visit({pixel[0], pixel[1] + step});
            }
        }
        component_count += !queue.empty();
    }
    return label;
}

/// Weighted k-means++ on some vertices of a surface.
class KMeans {
public:
    KMeans(const UvSurface& surface, const std::vector<int>& vertices, View<const double> u)
        : surface_(surface), vertices_(vertices), nearest_(vertices.size(), 0)
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
    const Vec2& uv(int k) const { return surface_.uv(vertices_[k]); }

    void choose_first_centers(int count, std::mt19937& random)
    {
        const auto heaviest = std::max_element(weight_.begin(), weight_.end()) - weight_.begin();
        centers_.assign(1, uv(int(heaviest)));
        std::vector<double> squared(vertices_.size(), 1e300), sums(vertices_.size());
        while (int(centers_.size()) < count) {
            double sum = 0.0;
            for (size_t k = 0; k < vertices_.size(); ++k) {
                squared[k] = std::min(squared[k], (uv(int(k)) - centers_.back()).squaredNorm());
                sums[k] = sum += weight_[k] * squared[k];
            }
            if (!(sum > 0.0))
                return;
            // Not std::uniform_real_distribution, whose numbers differ between platforms.
            const double draw = sum * (double(random()) / 4294967296.0);
            const auto chosen = std::upper_bound(sums.begin(), sums.end(), draw) - sums.begin();
            centers_.push_back(uv(int(std::min<long>(chosen, long(sums.size()) - 1))));
        }
    }

    bool assign()
    {
        bool is_changed = false;
        for (size_t k = 0; k < vertices_.size(); ++k) {
            int nearest = 0;
            for (int c = 1; c < int(centers_.size()); ++c)
                if ((uv(int(k)) - centers_[c]).squaredNorm() < (uv(int(k)) - centers_[nearest]).squaredNorm())
                    nearest = c;
            is_changed |= nearest != nearest_[k];
            nearest_[k] = nearest;
        }
        return is_changed;
    }

    void move_centers()
    {
        std::vector<Vec2> sum(centers_.size(), Vec2::Zero());
        std::vector<double> weight(centers_.size(), 0.0);
        for (size_t k = 0; k < vertices_.size(); ++k) {
            sum[nearest_[k]] += weight_[k] * uv(int(k));
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
            result[c].area += surface_.area(vertices_[k]);
            const double squared = (uv(int(k)) - centers_[c]).squaredNorm();
            if (squared < closest[c]) {
                closest[c] = squared;
                result[c].vertex = vertices_[k];
            }
        }
        std::erase_if(result, [](const FarCluster& cluster) { return !(cluster.area > 0.0); });
        return result;
    }

    const UvSurface& surface_;
    const std::vector<int>& vertices_;
    std::vector<double> weight_;
    std::vector<int> nearest_; ///< centre of each vertex
    std::vector<Vec2> centers_;
};

/// Number of clusters per component: one, and the rest by largest remaining area per cluster.
std::vector<int> apportion(const std::vector<double>& areas, int count)
{
    std::vector<int> counts(areas.size(), 1);
    for (int given = int(areas.size()); given < count; ++given) {
        int neediest = 0;
        for (int c = 1; c < int(areas.size()); ++c)
            if (areas[c] / counts[c] > areas[neediest] / counts[neediest])
                neediest = c;
        ++counts[neediest];
    }
    return counts;
}

} // namespace

std::vector<FarCluster> far_clusters(const UvSurface& surface, const PixelBox& middle, View<const double> u,
                                     int count, unsigned seed)
{
    // Collect vertices and areas of the components that matter.
    int component_count = 0;
    const std::vector<int> label = label_components(surface, middle, component_count);
    std::vector<std::vector<int>> vertices(component_count);
    for (int k = 0; k < surface.vertex_count(); ++k)
        if (const int component = label[surface.grid().index(surface.pixel_of(k))]; component >= 0)
            vertices[component].push_back(k);
    std::erase_if(vertices, [&](const std::vector<int>& component) {
        return std::all_of(component.begin(), component.end(), [&](int k) { return u[k] == 0.0; });
    });
    if (vertices.empty())
        return {};
    std::vector<double> areas;
    for (const std::vector<int>& component : vertices) {
        areas.push_back(0.0);
        for (const int k : component)
            areas.back() += surface.area(k);
    }

    // Cluster each component on its own.
    std::mt19937 random(seed);
    const std::vector<int> counts = apportion(areas, count);
    std::vector<FarCluster> clusters;
    for (size_t c = 0; c < vertices.size(); ++c) {
        const std::vector<FarCluster> found = KMeans(surface, vertices[c], u).run(counts[c], random);
        clusters.insert(clusters.end(), found.begin(), found.end());
    }
    return clusters;
}

} // namespace toile::research
