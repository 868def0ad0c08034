#include "garment/energy/air/pressure.h"

#include <algorithm>
#include <map>

#include "core/base/disjoint_sets.h"
#include "core/compute/parallel.h"

namespace toile::garment {

namespace {

/// Gradient of the volume below a triangle by one of its corners [m^2]: a third of its area along its normal.
Vec3 sixth_of_normal(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a) / 6.0; }

/// Volume of the tetrahedron of a triangle and the origin [m^3].
double volume_below(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) / 6.0; }

} // namespace

Pressure::Pressure(std::shared_ptr<const RestShape> rest) : rest_(std::move(rest)), caps_(caps_of_borders())
{
    corner_gradient_.resize(rest_->triangles.size());
    triangle_volume_.resize(rest_->triangles.size());
}

/// One cap for each set of border edges that meet.
std::vector<Pressure::Cap> Pressure::caps_of_borders() const
{
    DisjointSets sets(rest_->vertex_count());
    for (const Edge& edge : rest_->topology.edges)
        if (edge.is_border())
            sets.join(edge.vertex[0], edge.vertex[1]);
    std::map<int, Cap> caps;
    for (const Edge& edge : rest_->topology.edges)
        if (edge.is_border()) {
            Cap& cap = caps[sets.find(edge.vertex[0])];
            cap.edges.push_back(edge.vertex);
            cap.vertices.insert(cap.vertices.end(), edge.vertex.begin(), edge.vertex.end());
        }
    std::vector<Cap> found;
    for (auto& [set, cap] : caps) {
        std::sort(cap.vertices.begin(), cap.vertices.end());
        cap.vertices.erase(std::unique(cap.vertices.begin(), cap.vertices.end()), cap.vertices.end());
        found.push_back(std::move(cap));
    }
    return found;
}

Vec3 Pressure::Cap::centroid(View<const Vec3> x) const
{
    Vec3 sum = Vec3::Zero();
    for (const int v : vertices)
        sum += x[v];
    return sum / double(vertices.size());
}

double Pressure::cap_volume(const Cap& cap, View<const Vec3> x) const
{
    const Vec3 centre = cap.centroid(x) - origin_;
    double volume = 0.0;
    for (const auto& [from, to] : cap.edges)
        volume += volume_below(x[to] - origin_, x[from] - origin_, centre);
    return volume;
}

/// Calls add(vertex, gradient) for the vertices of a cap; several times for each.
template <typename Add>
void Pressure::for_each_cap_gradient(const Cap& cap, View<const Vec3> x, const Add& add)
{
    const Vec3 centre = cap.centroid(x);
    Vec3 of_centre = Vec3::Zero();
    for (const auto& [from, to] : cap.edges) {
        const Vec3 corner = sixth_of_normal(x[to], x[from], centre);
        add(from, corner);
        add(to, corner);
        of_centre += corner;
    }
    for (const int v : cap.vertices)
        add(v, of_centre / double(cap.vertices.size()));
}

void Pressure::begin_step(View<const Vec3> x, double pressure)
{
    pressure_ = pressure;
    if (pressure == 0.0)
        return;
    origin_ = x[0];
    start_cap_gradient_.assign(caps_.empty() ? 0 : size_t(x.size()), Vec3::Zero());
    for (const Cap& cap : caps_)
        for_each_cap_gradient(cap, x, [&](int v, const Vec3& g) { start_cap_gradient_[v] += g; });
}

double Pressure::volume(View<const Vec3> x)
{
    parallel_for(kCpu, "pressure/triangles", int(triangle_volume_.size()), [&](int t) {
        const Triangle& corner = rest_->triangles[t];
        const Vec3 a = x[corner[0]] - origin_, b = x[corner[1]] - origin_, c = x[corner[2]] - origin_;
        corner_gradient_[t] = sixth_of_normal(a, b, c);
        triangle_volume_[t] = volume_below(a, b, c);
    });
    double volume =
        parallel_sum(kCpu, int(triangle_volume_.size()), 0.0, [&](int t) { return triangle_volume_[t]; });
    for (const Cap& cap : caps_)
        volume += cap_volume(cap, x);
    return volume;
}

double Pressure::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    if (pressure_ == 0.0)
        return 0.0;
    double volume = this->volume(x);
    const Incidence& corners = rest_->topology.corners_of_vertex;
    parallel_for(kCpu, "pressure/vertices", x.size(), [&](int v) {
        for (const int corner : corners.of(v))
            gradient[v] -= pressure_ * corner_gradient_[corner / 3];
    });
    for (const Cap& cap : caps_) {
        for_each_cap_gradient(cap, x, [&](int v, const Vec3& g) { gradient[v] -= pressure_ * g; });
        for (const int v : cap.vertices) {
            gradient[v] += pressure_ * start_cap_gradient_[v];
            volume -= start_cap_gradient_[v].dot(x[v] - origin_);
        }
    }
    return -pressure_ * volume;
}

} // namespace toile::garment
