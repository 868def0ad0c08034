#include "garment/energy/springs.h"

#include "garment/energy/cuda/springs.h"

namespace toile::garment {

Springs::Springs(const std::vector<Spring>& springs)
{
    for (const Spring& spring : springs) {
        springs_.push_back({spring.vertex, spring.stiffness});
        stiffness_.push_back(spring.stiffness);
    }
}

void Springs::add_hessian(Triplets& H) const
{
    for (size_t i = 0; i < springs_.size(); ++i)
        H.emplace_back(springs_[i].vertex, springs_[i].vertex, stiffness_[i]);
}

double Springs::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    double value = 0.0;
    for (const AnchorSpring& spring : springs_)
        value += spring.pull(x, gradient);
    return value;
}

void Springs::add_curvature(View<const Vec3>, Definiteness, BlockWindow K)
{
    for (const AnchorSpring& spring : springs_)
        K.block(spring.vertex, spring.vertex).diagonal().array() += spring.stiffness;
}

bool Springs::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceSprings>().add(*this, first_vertex);
    return true;
}

} // namespace toile::garment
