#include "apps/toile/maps/vertex_map.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/toile/cloth/strain.h"
#include "apps/toile/cloth/vertex_values.h"
#include "collision/geometry/surface_proximity.h"
#include "core/compute/parallel.h"
#include "garment/energy/membrane.h"
#include "garment/energy/strain_limit/stretch_tension.h"

namespace toile::app {

namespace {

/// Fraction of the vertices that colours of tension and strain tell apart: few at seams are far above.
constexpr double kColoured = 0.99;

/// Next number from 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten.
double rounded_up(double value)
{
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double digits : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (digits * power >= value * (1.0 - 1e-9))
            return digits * power;
    return 10.0 * power;
}

/// From 0 to kColoured of the values, at least to `least`.
preview::ColourScale scale_of(const std::vector<double>& values, double least)
{
    return {preview::ColourMap::Turbo, 0.0, rounded_up(std::max(quantile(values, kColoured), least))};
}

/// Elasticity of a fabric in its plane.
struct Elasticity {
    garment::MembraneWeights weights;
    double allowed = 1.0; ///< [-] stretch at the strain limit
    double beyond = 0.0;  ///< [N/m] stiffness beyond it

    /// @param stiffest  largest factor of tension()
    Elasticity(const std::shared_ptr<const garment::RestShape>& rest, const garment::Fabric& fabric,
               double stiffest)
        : weights(
              garment::Membrane(rest, {fabric.stretch_warp, fabric.stretch_weft, fabric.shear}, fabric.name)
                  .weights()),
          allowed(1.0 + fabric.strain_limit),
          beyond(garment::StretchTension::Settings::elastic(
                     fabric.strain_limit, stiffest * std::max(fabric.stretch_warp, fabric.stretch_weft), 0.0)
                     .stiffness)
    {
    }

    /// Derivative of the energy per area at rest by the deformation gradient F [N/m].
    /// @param stiffness  factor on the fabric's [-]
    Mat32 stress(const garment::RestShape& rest, int t, const Mat32& F, double stiffness) const
    {
        // Gradients at the corners are A P B^-T, with rest edges B and the area A at rest.
        const double area = rest.areas[size_t(t)];
        const garment::MembraneResponse<double> response =
            garment::project_membrane<double>(F, rest.edges_inv[size_t(t)], area, weights);
        Mat32 P = stiffness * response.corner_gradient * rest.edges[size_t(t)].transpose() / area;
        if (!rest.is_sliver(t))
            P += beyond * garment::stretch_excess(F, allowed);
        return P;
    }
};

/// Larger eigenvalue of the Biot stress of P at F [N/m].
double larger_principal(const Mat32& P, const Mat32& F)
{
    const Mat2 biot = garment::closest_isometry<double>(F).transpose() * P;
    const double shear = 0.5 * (biot(0, 1) + biot(1, 0));
    return 0.5 * (biot(0, 0) + biot(1, 1)) + std::hypot(0.5 * (biot(0, 0) - biot(1, 1)), shear);
}

/// Stress in each triangle of a garment.
class GarmentStress {
public:
    explicit GarmentStress(const FittedGarment& garment)
        : garment_(garment), rest_(std::make_shared<const garment::RestShape>(garment::rest_shape_of_panels(
                                 garment.mesh, garment.rest, 0.0, garment.name)))
    {
        const std::vector<double>& painted = garment.stiffness;
        const double stiffest = painted.empty() ? 1.0 : *std::max_element(painted.begin(), painted.end());
        for (const garment::Fabric& fabric : garment.fabrics)
            fabrics_.emplace_back(rest_, fabric, stiffest);
    }

    const garment::RestShape& rest() const { return *rest_; }
    Mat32 gradient(int t) const { return rest_->deformation_gradient(t, garment_.mesh.positions); }
    Mat32 operator()(int t) const
    {
        const Elasticity& fabric = fabrics_[size_t(garment_.fabric_of_triangle[size_t(t)])];
        return fabric.stress(*rest_, t, gradient(t),
                             garment_.stiffness.empty() ? 1.0 : garment_.stiffness[size_t(t)]);
    }

private:
    const FittedGarment& garment_;
    std::shared_ptr<const garment::RestShape> rest_;
    std::vector<Elasticity> fabrics_;
};

/// Forces that the cloth's tension exerts on what holds its vertices [N].
std::vector<Vec3> tension_forces(const FittedGarment& garment, const GarmentStress& stress)
{
    std::vector<Vec3> force(garment.mesh.positions.size(), Vec3::Zero());
    for (int t = 0; t < garment.mesh.triangle_count(); ++t) {
        const garment::RestShape& rest = stress.rest();
        const Mat32 corner = rest.areas[size_t(t)] * stress(t) * rest.edges_inv[size_t(t)].transpose();
        const Triangle& v = garment.mesh.triangles[size_t(t)];
        force[size_t(v[1])] -= corner.col(0);
        force[size_t(v[2])] -= corner.col(1);
        force[size_t(v[0])] += corner.col(0) + corner.col(1);
    }
    return force;
}

/// Thirds of the triangles around each vertex as they are [m^2].
std::vector<double> vertex_areas(const TriangleMesh& mesh)
{
    std::vector<double> area(mesh.positions.size(), 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions[size_t(t[1])] - mesh.positions[size_t(t[0])],
                   b = mesh.positions[size_t(t[2])] - mesh.positions[size_t(t[0])];
        for (const int v : t)
            area[size_t(v)] += a.cross(b).norm() / 6.0;
    }
    return area;
}

} // namespace

double quantile(std::vector<double> values, double fraction)
{
    if (values.empty())
        return 0.0;
    const auto at = values.begin() + long(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

VertexMap tension_map(const FittedGarment& garment)
{
    const GarmentStress stress(garment);
    std::vector<double> tension;
    for (int t = 0; t < garment.mesh.triangle_count(); ++t)
        tension.push_back(std::max(larger_principal(stress(t), stress.gradient(t)), 0.0));
    VertexMap map{
        "tension",
        "N/m",
        mean_at_vertices(garment.mesh.triangles, garment.mesh.vertex_count(), tension, stress.rest().areas),
        {},
        "N/m",
        1.0};
    map.scale = scale_of(map.values, 1.0);
    return map;
}

VertexMap strain_map(const FittedGarment& garment)
{
    const VertexStrain strain(StrainMeter(garment.rest, garment.mesh.triangles), garment.mesh.triangles);
    VertexMap map{"strain", "", strain.at(garment.mesh.positions), {}, "%", 100.0};
    map.scale = scale_of(map.values, 0.01);
    return map;
}

VertexMap gap_map(const FittedGarment& garment, const TriangleMesh& body)
{
    SkinDistance skin(body.triangles);
    skin.move(body.positions);
    VertexMap map{"gap", "m", skin.at(garment.mesh.positions), {}, "mm", 1000.0};
    map.scale = {preview::ColourMap::Viridis, 0.0, kWidestGap};
    return map;
}

VertexMap pressure_map(const FittedGarment& garment, const TriangleMesh& body)
{
    const GarmentStress stress(garment);
    const std::vector<Vec3> force = tension_forces(garment, stress);
    const std::vector<double> area = vertex_areas(garment.mesh);
    const collision::SurfaceProximity skin(body.triangles, body.positions);
    std::vector<double> push(force.size(), 0.0); // [N] into the skin
    parallel_for(kCpu, "maps/pressure", garment.mesh.vertex_count(), [&](int v) {
        const collision::SurfacePoint at = skin.closest(garment.mesh.positions[size_t(v)]).value();
        if (at.signed_distance < kTouching)
            push[size_t(v)] = std::max(-force[size_t(v)].dot(at.normal), 0.0);
    });
    std::vector<double> pressure;
    for (const Triangle& t : garment.mesh.triangles) {
        double pushed = 0.0, on = 0.0;
        for (const int v : t) {
            pushed += push[size_t(v)];
            on += area[size_t(v)];
        }
        pressure.push_back(on > 0.0 ? pushed / on : 0.0);
    }
    VertexMap map{
        "pressure",
        "Pa",
        mean_at_vertices(garment.mesh.triangles, garment.mesh.vertex_count(), pressure, stress.rest().areas),
        {},
        "Pa",
        1.0};
    map.scale = scale_of(map.values, 1.0);
    return map;
}

VertexMap map_of(MapKind kind, const FittedGarment& garment, const TriangleMesh& body)
{
    switch (kind) {
    case MapKind::Tension:
        return tension_map(garment);
    case MapKind::Gap:
        return gap_map(garment, body);
    case MapKind::Pressure:
        return pressure_map(garment, body);
    case MapKind::Strain:
        break;
    }
    return strain_map(garment);
}

} // namespace toile::app
