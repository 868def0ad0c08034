#include "research/benchmarks/stress/energy_meter.h"

#include <numeric>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"

namespace toile::research::stress {

EnergyMeter::EnergyMeter(const scenes::ClothState& cloth, const Vec3& gravity)
    : gravity_(gravity), unused_gradient_(cloth.positions.size())
{
    const garment::Fabric& fabric = cloth.fabric;
    const auto rest = std::make_shared<const garment::RestShape>(garment::rest_shape_of_surface(
        {cloth.rest.positions, cloth.triangles}, Vec3::UnitX(), 0.0, cloth.name));
    elastic_.push_back(std::make_unique<garment::Membrane>(
        rest, garment::Membrane::Settings{fabric.stretch_warp, fabric.stretch_weft, fabric.shear},
        cloth.name));
    elastic_.push_back(std::make_unique<garment::Bending>(
        rest, garment::Bending::Settings{fabric.bend_warp, fabric.bend_weft}, cloth.name));
    masses_ = rest->vertex_areas();
    for (double& mass : masses_)
        mass *= fabric.areal_density;
    mass_ = std::accumulate(masses_.begin(), masses_.end(), 0.0);
}

double EnergyMeter::measure(View<const Vec3> x, View<const Vec3> v)
{
    double energy = 0.0;
    for (int i = 0; i < x.size(); ++i)
        energy += masses_[i] * (0.5 * v[i].squaredNorm() - gravity_.dot(x[i]));
    for (const auto& term : elastic_)
        energy += term->add_gradient(x, unused_gradient_);
    return energy;
}

} // namespace toile::research::stress
