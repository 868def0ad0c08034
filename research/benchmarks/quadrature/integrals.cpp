#include "research/benchmarks/quadrature/integrals.h"

#include <algorithm>
#include <cmath>

#include "research/paper_rule/gauss_legendre.h"

namespace toile::research {

namespace {

constexpr double kPenalty = 100.0; // mu of eq. 17
constexpr int kSamples = 8;        // |S_i|

/// Mirror images to either side: with a decay length below 1 further ones add less than 1e-10.
constexpr int kImages = 6;

/// Points per axis among which farthest point sampling chooses, and steps of growing intervals.
constexpr int kCandidates = 65;
constexpr double kGrowth = 1e-3;

/// Cells of the midpoint sum for integrals without closed form: accurate to 1e-6, measured on one with a
/// closed form.
constexpr int kCells = 4000;

/// Farthest point sampling on a grid of points of the box.
template <int Dim>
std::vector<Point<Dim>> spread_samples(const Point<Dim>& first, const Box<Dim>& box, int count)
{
    std::vector<Point<Dim>> candidates(1, box.min());
    for (int a = 0; a < Dim; ++a) {
        std::vector<Point<Dim>> more;
        for (const Point<Dim>& candidate : candidates)
            for (int k = 0; k < kCandidates; ++k) {
                more.push_back(candidate);
                more.back()[a] += box.sizes()[a] * k / (kCandidates - 1);
            }
        candidates = std::move(more);
    }
    std::vector<Point<Dim>> samples(1, first);
    std::vector<double> squared(candidates.size(), 1e300);
    while (int(samples.size()) < count) {
        for (size_t k = 0; k < candidates.size(); ++k)
            squared[k] = std::min(squared[k], (candidates[k] - samples.back()).squaredNorm());
        samples.push_back(candidates[std::max_element(squared.begin(), squared.end()) - squared.begin()]);
    }
    return samples;
}

/// Errors of all rules on one function.
template <int Dim, typename Phi>
IntegrationErrors compare(const Phi& phi, double exact, const Box<Dim>& middle, const GaussianFits<Dim>& fits)
{
    const auto error = [&](double value) { return std::abs(value / exact - 1.0); };
    const std::vector<QuadraturePoint<Dim>> three = gauss_legendre(middle, 3),
                                            four = gauss_legendre(middle, 4);
    IntegrationErrors errors;
    errors.gauss_legendre_3 = error(weighted_sum(phi, three));
    errors.gauss_legendre_4 = error(weighted_sum(phi, four));
    errors.gaussian_alone = error(fits.no_penalty.integral(middle));
    errors.stacked_no_penalty = error(stacked_integral(phi, fits.no_penalty, fits.near, three));
    errors.stacked = error(stacked_integral(phi, fits.penalty, fits.near, three));
    return errors;
}

template <int Dim, typename Phi>
GaussianFits<Dim> fit(const Phi& phi, const Point<Dim>& peak, const Box<Dim>& near)
{
    GaussianTarget<Dim> target;
    target.samples = spread_samples(peak, near, kSamples);
    for (const Point<Dim>& sample : target.samples)
        target.values.push_back(phi(sample));
    target.faces = face_centers(near);
    target.penalty = 0.0;
    GaussianFits<Dim> fits{near, fit_gaussian<Dim>(peak, near, target), {}};
    target.penalty = kPenalty;
    fits.penalty = fit_gaussian<Dim>(peak, near, target);
    return fits;
}

} // namespace

YukawaLine::YukawaLine(double peak, double lambda, double epsilon)
    : peak_(peak), lambda_(lambda), epsilon_(epsilon)
{
    at_peak_ = in_free_space_and_images(peak);
}

double YukawaLine::in_free_space_and_images(double x) const
{
    // The hat is the second difference of the second antiderivative F of exp(-|x| / lambda).
    const auto F = [&](double r) {
        return lambda_ * std::abs(r) + lambda_ * lambda_ * std::exp(-std::abs(r) / lambda_);
    };
    const auto G = [&](double r) {
        return (F(r + epsilon_) - 2.0 * F(r) + F(r - epsilon_)) / (epsilon_ * epsilon_);
    };
    double sum = 0.0;
    for (int image = -kImages; image <= kImages; ++image)
        sum += G(x - 4.0 * image - peak_) + G(x - (4.0 * image + 2.0) + peak_);
    return sum;
}

Box<1> YukawaLine::near_box(double fraction) const
{
    double lower = peak_, upper = peak_, covered = 0.0;
    while (covered < fraction * integral() && (lower > -1.0 || upper < 1.0)) {
        const double up = std::min(kGrowth, 1.0 - upper), down = std::min(kGrowth, 1.0 + lower);
        covered += up * (*this)(upper + 0.5 * up) + down * (*this)(lower - 0.5 * down);
        upper += up;
        lower -= down;
    }
    return {Point<1>(lower), Point<1>(upper)};
}

GaussianFits<1> fits_on_line(const YukawaLine& target, double near_fraction)
{
    return fit<1>([&](const Point<1>& x) { return target(x[0]); }, Point<1>(target.peak()),
                  target.near_box(near_fraction));
}

IntegrationErrors errors_on_line(const YukawaLine& target, double near_fraction)
{
    const Box<1> middle{Point<1>(-1.0), Point<1>(1.0)};
    return compare([&](const Point<1>& x) { return target(x[0]); }, target.integral(), middle,
                   fits_on_line(target, near_fraction));
}

IntegrationErrors errors_on_wave(const YukawaLine& target, double omega, double near_fraction)
{
    const auto phi = [&](const Point<1>& x) {
        return target(x[0]) * std::cos(omega * (x[0] - target.peak()));
    };
    double exact = 0.0;
    for (int cell = 0; cell < kCells; ++cell)
        exact += 2.0 / kCells * phi(Point<1>(-1.0 + 2.0 * (cell + 0.5) / kCells));
    const Box<1> middle{Point<1>(-1.0), Point<1>(1.0)};
    return compare(phi, exact, middle, fit<1>(phi, Point<1>(target.peak()), target.near_box(near_fraction)));
}

IntegrationErrors errors_on_square(const YukawaLine& target_x, const YukawaLine& target_y,
                                   double near_fraction)
{
    const Box<1> near_x = target_x.near_box(near_fraction), near_y = target_y.near_box(near_fraction);
    const Box<2> near(Vec2(near_x.min()[0], near_y.min()[0]), Vec2(near_x.max()[0], near_y.max()[0]));
    const Box<2> middle(Vec2(-1, -1), Vec2(1, 1));
    const auto phi = [&](const Vec2& x) { return target_x(x[0]) * target_y(x[1]); };
    return compare(phi, target_x.integral() * target_y.integral(), middle,
                   fit<2>(phi, {target_x.peak(), target_y.peak()}, near));
}

IntegrationErrors errors_on_sheet(const VoxelisedMesh<2>& mesh, int vertex, View<const double> u,
                                  View<const double> b, const RuleSettings& settings)
{
    const auto density = [&](int k) { return u[k] * b[k] / mesh.volume(k); };
    const auto phi = [&](const Vec2& x) {
        const auto located = mesh.locate(x);
        double value = 0.0;
        for (int corner = 0; located && corner < 3; ++corner)
            value += located->weight[corner] * density(located->vertex[corner]);
        return value;
    };

    // Widths from u, the amplitude from phi.
    const auto gaussian = [&](double penalty) {
        RuleSettings with_penalty = settings;
        with_penalty.penalty = penalty;
        NearField<2> field = near_field(mesh, vertex, u, with_penalty);
        const std::vector<double> weights = amplitude_weights(field.gaussian, field.target);
        field.gaussian.amplitude = 0.0;
        for (size_t s = 0; s < weights.size(); ++s)
            field.gaussian.amplitude += weights[s] * density(field.samples[s]);
        return field.gaussian;
    };

    // Integral of the interpolant over the voxels of the middle box.
    const NearField<2> field = near_field(mesh, vertex, u, settings);
    double exact = 0.0;
    for (int voxel = 0; voxel < mesh.grid().count(); ++voxel)
        if (field.domains.middle.contains(mesh.grid().at(voxel)))
            for (SparseMatrix::InnerIterator entry(mesh.coverage(), voxel); entry; ++entry)
                exact += entry.value() * density(int(entry.col()));
    return compare(phi, exact, field.middle,
                   GaussianFits<2>{field.near, gaussian(0.0), gaussian(settings.penalty)});
}

IntegrationErrors mean(const std::vector<IntegrationErrors>& errors)
{
    IntegrationErrors result;
    for (const auto member : {&IntegrationErrors::gauss_legendre_3, &IntegrationErrors::gauss_legendre_4,
                              &IntegrationErrors::gaussian_alone, &IntegrationErrors::stacked_no_penalty,
                              &IntegrationErrors::stacked}) {
        for (const IntegrationErrors& error : errors)
            result.*member += error.*member;
        result.*member /= double(errors.size());
    }
    return result;
}

} // namespace toile::research
