#include "apps/toile/cloth/vertex_values.h"

#include <utility>

#include "core/compute/parallel.h"

namespace toile::app {

std::vector<double> mean_at_vertices(View<const Triangle> triangles, int vertex_count,
                                     const std::vector<double>& of_triangle, const std::vector<double>& area)
{
    std::vector<double> sum(size_t(vertex_count), 0.0), weight(size_t(vertex_count), 0.0);
    for (int t = 0; t < triangles.size(); ++t)
        for (const int v : triangles[t]) {
            sum[size_t(v)] += area[size_t(t)] * of_triangle[size_t(t)];
            weight[size_t(v)] += area[size_t(t)];
        }
    for (size_t v = 0; v < sum.size(); ++v)
        sum[v] /= weight[v] > 0.0 ? weight[v] : 1.0;
    return sum;
}

VertexStrain::VertexStrain(StrainMeter meter, std::vector<Triangle> triangles)
    : meter_(std::move(meter)), triangles_(std::move(triangles))
{
    for (int t = 0; t < meter_.triangle_count(); ++t)
        areas_.push_back(meter_.rest_area(t));
}

std::vector<double> VertexStrain::at(View<const Vec3> x) const
{
    std::vector<double> strain(triangles_.size());
    parallel_for(kCpu, "maps/strain", int(strain.size()),
                 [&](int t) { strain[size_t(t)] = meter_.stretches(x, t).larger - 1.0; });
    return mean_at_vertices(triangles_, x.size(), strain, areas_);
}

void SkinDistance::move(View<const Vec3> skin)
{
    if (skin_)
        skin_->update(skin);
    else
        skin_.emplace(triangles_, skin);
}

std::vector<double> SkinDistance::at(View<const Vec3> x) const
{
    std::vector<double> distance(size_t(x.size()));
    parallel_for(kCpu, "maps/gap", x.size(),
                 [&](int v) { distance[size_t(v)] = skin_->closest(x[v]).value().signed_distance; });
    return distance;
}

} // namespace toile::app
