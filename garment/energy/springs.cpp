#include "garment/energy/springs.h"

namespace toile {

Springs::Springs(std::vector<Spring> springs)
    : springs_(std::move(springs)), targets_(springs_.size(), Vec3::Zero())
{
}

void Springs::add_hessian(Triplets& H) const
{
    for (const Spring& spring : springs_)
        H.emplace_back(spring.vertex, spring.vertex, spring.stiffness);
}

double Springs::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    double value = 0.0;
    for (size_t j = 0; j < springs_.size(); ++j) {
        const Vec3 stretch = x[springs_[j].vertex] - targets_[j];
        gradient[springs_[j].vertex] += springs_[j].stiffness * stretch;
        value += 0.5 * springs_[j].stiffness * stretch.squaredNorm();
    }
    return value;
}

void Springs::add_curvature(View<const Vec3>, Definiteness, BlockWindow K)
{
    for (const Spring& spring : springs_)
        K.block(spring.vertex, spring.vertex).diagonal().array() += spring.stiffness;
}

} // namespace toile
