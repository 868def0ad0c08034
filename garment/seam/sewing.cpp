#include "garment/seam/sewing.h"

#include "core/base/error.h"

namespace toile::garment {

Sewing::Sewing(std::vector<Thread> threads, const Settings& settings)
    : threads_(std::move(threads)), settings_(settings)
{
    if (!(settings.stiffness > 0.0) || !(settings.max_force > 0.0))
        throw InvalidInput("sewing: stiffness and max_force must be positive");
}

void Sewing::add_hessian(Triplets& H) const
{
    const double k = settings_.stiffness;
    for (const auto& [a, b] : threads_) {
        H.emplace_back(a, a, k);
        H.emplace_back(b, b, k);
        H.emplace_back(a, b, -k);
        H.emplace_back(b, a, -k);
    }
}

double Sewing::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const double k = settings_.stiffness, bend = settings_.max_force / k;
    double value = 0.0;
    for (const auto& [a, b] : threads_) {
        const Vec3 gap = x[a] - x[b];
        const double length = gap.norm();
        const Vec3 force = (length <= bend ? k : settings_.max_force / length) * gap;
        gradient[a] += force;
        gradient[b] -= force;
        value += length <= bend ? 0.5 * k * length * length : settings_.max_force * (length - 0.5 * bend);
    }
    return value;
}

void Sewing::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    for (const auto& [a, b] : threads_)
        couplings.emplace_back(a, b);
}

/// A bounded thread resists rotation alone. Both forms are positive semi-definite.
void Sewing::add_curvature(View<const Vec3> x, Definiteness, BlockWindow K)
{
    const double bend = settings_.max_force / settings_.stiffness;
    for (const auto& [a, b] : threads_) {
        const Vec3 gap = x[a] - x[b];
        const double length = gap.norm();
        Mat3 block = settings_.stiffness * Mat3::Identity();
        if (length > bend) {
            const Vec3 direction = gap / length;
            block = settings_.max_force / length * (Mat3::Identity() - direction * direction.transpose());
        }
        K.block(a, a) += block;
        K.block(b, b) += block;
        K.block(a, b) -= block;
        K.block(b, a) -= block;
    }
}

SeamGaps gaps_of(const std::vector<Sewing::Thread>& threads, View<const Vec3> x)
{
    SeamGaps gaps;
    for (size_t i = 0; i < threads.size(); ++i) {
        const double gap = (x[threads[i].a] - x[threads[i].b]).norm();
        gaps.mean += gap / double(threads.size());
        if (gaps.widest < 0 || gap > gaps.max) {
            gaps.max = gap;
            gaps.widest = int(i);
        }
    }
    return gaps;
}

} // namespace toile::garment
