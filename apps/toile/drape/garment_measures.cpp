#include "apps/toile/drape/garment_measures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/toile/cloth/strain.h"

namespace toile::app {

namespace {

/// Fraction of the area whose strain is at most FabricStrain::p99 [-].
constexpr double kP99 = 0.99;

struct StrainedTriangle {
    double strain; ///< [-]
    double area;   ///< [m^2] at rest
    int triangle;
};

Vec3 centroid(const ObjMesh& mesh, int triangle)
{
    Vec3 sum = Vec3::Zero();
    for (const int v : mesh.polygons[size_t(triangle)])
        sum += mesh.positions[size_t(v)];
    return sum / 3.0;
}

/// @param triangles  at least one
FabricStrain strain_of(const std::string& fabric, std::vector<StrainedTriangle> triangles,
                       const ObjMesh& mesh)
{
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const auto& a, const auto& b) { return a.strain < b.strain; });
    double area = 0.0, sum = 0.0;
    for (const StrainedTriangle& at : triangles) {
        area += at.area;
        sum += at.area * at.strain;
    }
    FabricStrain strain;
    strain.fabric = fabric;
    strain.max = triangles.back().strain;
    strain.max_panel = panel_of_triangle(mesh, triangles.back().triangle);
    strain.max_point = centroid(mesh, triangles.back().triangle);
    strain.mean = sum / area;
    double below = 0.0;
    for (const StrainedTriangle& at : triangles) {
        below += at.area;
        strain.p99 = at.strain;
        if (below >= kP99 * area)
            break;
    }
    return strain;
}

UvStretch uv_stretch(const StrainMeter& meter, View<const Vec3> x)
{
    double texture = 0.0, surface = 0.0, squares = 0.0, largest = 0.0;
    for (int t = 0; t < meter.triangle_count(); ++t) {
        const auto [larger, smaller] = meter.stretches(x, t);
        const double area = meter.rest_area(t) * larger * smaller;
        texture += meter.rest_area(t);
        surface += area;
        squares += 0.5 * (larger * larger + smaller * smaller) * area;
        largest = std::max(largest, larger);
    }
    if (!(surface > 0.0))
        return {};
    const double scale = std::sqrt(texture / surface);
    return {std::sqrt(squares / surface) * scale, largest * scale, surface / texture};
}

} // namespace

std::string panel_of_triangle(const ObjMesh& mesh, int triangle)
{
    const auto next =
        std::upper_bound(mesh.groups.begin(), mesh.groups.end(), triangle,
                         [](int polygon, const ObjGroup& group) { return polygon < group.first_polygon; });
    return next == mesh.groups.begin() ? "" : std::prev(next)->name;
}

NearPanel panel_near(const ObjMesh& mesh, const Vec3& point)
{
    NearPanel nearest;
    int triangle = -1;
    for (int t = 0; t < int(mesh.polygons.size()); ++t) {
        const double distance = (centroid(mesh, t) - point).norm();
        if (distance >= nearest.distance)
            continue;
        nearest.distance = distance;
        triangle = t;
    }
    if (triangle >= 0)
        nearest.name = panel_of_triangle(mesh, triangle);
    return nearest;
}

GarmentMeasures measure_garment(const scenes::GarmentSurface& surface, const garment::Pattern& pattern,
                                const std::string& fabric)
{
    std::map<std::string, std::string> fabric_of_panel;
    for (const garment::Panel& panel : pattern.panels)
        fabric_of_panel[panel.name] = panel.fabric.empty() ? fabric : panel.fabric;

    const ObjMesh& mesh = surface.mesh;
    const std::vector<Triangle> triangles = mesh.triangulated().triangles;
    const StrainMeter texture(texture_triangles(mesh), triangles);
    const StrainMeter meter(surface.rest.empty() ? texture : StrainMeter(surface.rest, triangles));
    std::map<std::string, std::vector<StrainedTriangle>> by_fabric;
    for (int t = 0; t < meter.triangle_count(); ++t)
        by_fabric[fabric_of_panel[panel_of_triangle(mesh, t)]].push_back(
            {meter.stretches(mesh.positions, t).larger - 1.0, meter.rest_area(t), t});

    GarmentMeasures measures;
    for (auto& [name, strained] : by_fabric)
        measures.strains.push_back(strain_of(name, std::move(strained), mesh));
    measures.uv = uv_stretch(texture, mesh.positions);
    return measures;
}

} // namespace toile::app
