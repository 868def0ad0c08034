#include "garment/seam/elastics.h"

#include "core/base/error.h"

namespace toile::garment {

Elastics::Elastics(std::vector<Spring> springs) : springs_(std::move(springs))
{
    for (const Spring& spring : springs_)
        if (!(spring.rest_length > 0.0) || !(spring.stiffness > 0.0))
            throw InvalidInput("elastics: rest lengths and stiffnesses must be positive");
}

void Elastics::add_hessian(Triplets& H) const
{
    for (const auto& [a, b, rest_length, stiffness] : springs_) {
        const double k = stiffness / rest_length;
        H.emplace_back(a, a, k);
        H.emplace_back(b, b, k);
        H.emplace_back(a, b, -k);
        H.emplace_back(b, a, -k);
    }
}

double Elastics::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    double value = 0.0;
    for (const auto& [a, b, rest_length, stiffness] : springs_) {
        const Vec3 edge = x[a] - x[b];
        const double length = edge.norm();
        if (length <= rest_length)
            continue;
        const double strain = length / rest_length - 1.0;
        const Vec3 force = (stiffness * strain / length) * edge;
        gradient[a] += force;
        gradient[b] -= force;
        value += 0.5 * stiffness * rest_length * strain * strain;
    }
    return value;
}

void Elastics::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    for (const Spring& spring : springs_)
        couplings.emplace_back(spring.a, spring.b);
}

/// Stretching meets k / l, rotation the tension over the length. Both are positive where it pulls.
void Elastics::add_curvature(View<const Vec3> x, Definiteness, BlockWindow K)
{
    for (const auto& [a, b, rest_length, stiffness] : springs_) {
        const Vec3 edge = x[a] - x[b];
        const double length = edge.norm();
        if (length <= rest_length)
            continue;
        const Vec3 direction = edge / length;
        const Mat3 along = direction * direction.transpose();
        const double tension = stiffness * (length / rest_length - 1.0);
        const Mat3 block = stiffness / rest_length * along + tension / length * (Mat3::Identity() - along);
        K.block(a, a) += block;
        K.block(b, b) += block;
        K.block(a, b) -= block;
        K.block(b, a) -= block;
    }
}

} // namespace toile::garment
