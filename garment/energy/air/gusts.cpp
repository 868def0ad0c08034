#include "garment/energy/air/gusts.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "core/compute/parallel.h"

namespace toile::garment {

namespace {

/// Eddy turnover rate over sqrt(k^3 E(k)) [-]. [Fung et al. 1992, section 2]
constexpr double kUnsteadiness = 0.5;

/// Uniform in [0, 1) with the same bits on every platform, which the standard distributions do not guarantee.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed) : bits_(seed) {}
    double operator()() { return double(bits_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 bits_;
};

/// A rotation from the uniform distribution. [Shoemake 1992, Uniform random rotations]
Mat3 random_rotation(Uniform& uniform)
{
    const double along = uniform(), a = 2.0 * std::numbers::pi * uniform(),
                 b = 2.0 * std::numbers::pi * uniform();
    const double r = std::sqrt(1.0 - along), s = std::sqrt(along);
    return Eigen::Quaterniond(s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b))
        .toRotationMatrix();
}

} // namespace

Gusts::Gusts(const Vec3& mean, const Settings& settings)
{
    const double deviation = settings.intensity * mean.norm(); // [m/s] of each component
    if (!(deviation > 0.0))
        return;
    Uniform uniform(settings.seed);
    double total = 0.0;
    for (int octave = 0; octave < settings.octaves; ++octave)
        total += std::exp2(-2.0 / 3.0 * octave);
    for (int octave = 0; octave < settings.octaves; ++octave) {
        // An octave has the integral of k^(-5/3), so k^(-2/3) of the variance; cos^2 halves it.
        const double k = 2.0 * std::numbers::pi * std::exp2(octave) / settings.longest;
        const double variance = deviation * deviation * std::exp2(-2.0 / 3.0 * octave) / total;
        const double amplitude = std::sqrt(2.0 * variance);

        // k E(k) = energy of the octave over ln 2.
        const double turn_over = kUnsteadiness * k * std::sqrt(1.5 * variance / std::numbers::ln2);
        const Mat3 axes = random_rotation(uniform);
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 wave = k * axes.col(axis);
            modes_.push_back({wave, amplitude * axes.col((axis + 1) % 3), turn_over - wave.dot(mean),
                              2.0 * std::numbers::pi * uniform()});
        }
    }
}

void Gusts::sample(View<const Vec3> x, double t, View<Vec3> out) const
{
    parallel_for(kCpu, "garment/gusts", x.size(), SampleGusts{modes_, x, t, out});
}

} // namespace toile::garment
