#include "garment/seam/sewing.h"

#include "core/base/error.h"

namespace toile::garment {

Sewing::Sewing(std::vector<Thread> threads, const Settings& settings)
    : threads_(std::move(threads)), lengths_(threads_.size(), 0.0), settings_(settings)
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

/// [N/m]
double Sewing::tension_over_distance(double distance, double length) const
{
    const double stretch = distance - length;
    if (stretch > settings_.max_force / settings_.stiffness)
        return settings_.max_force / distance;
    return length == 0.0 ? settings_.stiffness : settings_.stiffness * stretch / distance;
}

double Sewing::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const double k = settings_.stiffness, bend = settings_.max_force / k;
    double value = 0.0;
    for (size_t j = 0; j < threads_.size(); ++j) {
        const auto& [a, b] = threads_[j];
        const Vec3 gap = x[a] - x[b];
        const double distance = gap.norm(), stretch = distance - lengths_[j];
        if (stretch < 0.0)
            continue;
        const Vec3 force = tension_over_distance(distance, lengths_[j]) * gap;
        gradient[a] += force;
        gradient[b] -= force;
        value += stretch <= bend ? 0.5 * k * stretch * stretch : settings_.max_force * (stretch - 0.5 * bend);
    }
    return value;
}

void Sewing::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    for (const auto& [a, b] : threads_)
        couplings.emplace_back(a, b);
}

/// A thread resists stretch below its bound, and rotation by its tension. Both are positive semi-definite.
void Sewing::add_curvature(View<const Vec3> x, Definiteness, BlockWindow K)
{
    const double k = settings_.stiffness, bend = settings_.max_force / k;
    for (size_t j = 0; j < threads_.size(); ++j) {
        const auto& [a, b] = threads_[j];
        const Vec3 gap = x[a] - x[b];
        const double distance = gap.norm(), stretch = distance - lengths_[j];
        if (stretch < 0.0)
            continue;
        Mat3 block = k * Mat3::Identity();
        if (stretch > bend || lengths_[j] > 0.0) {
            const Vec3 direction = gap / distance;
            const Mat3 along = direction * direction.transpose();
            block = tension_over_distance(distance, lengths_[j]) * (Mat3::Identity() - along);
            if (stretch <= bend)
                block += k * along;
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
