#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "research/paper_rule/gauss_legendre.h"
#include "research/paper_rule/gaussian_fit.h"

namespace toile::test {

using namespace research;

namespace {

/// Composite Gauss-Legendre on cells^Dim pieces of the box: the oracle.
template <int Dim, typename Phi>
double integrate_finely(const Phi& phi, const Box<Dim>& box, int cells)
{
    double sum = 0.0;
    int pieces = 1;
    for (int a = 0; a < Dim; ++a)
        pieces *= cells;
    for (int piece = 0; piece < pieces; ++piece) {
        Point<Dim> lower = box.min(), size = box.sizes() / cells;
        for (int a = 0, rest = piece; a < Dim; ++a, rest /= cells)
            lower[a] += size[a] * (rest % cells);
        sum += weighted_sum(phi, gauss_legendre(Box<Dim>(lower, lower + size), 4));
    }
    return sum;
}

/// Objective of the fit.
template <int Dim>
double objective(const Gaussian<Dim>& gaussian, const GaussianTarget<Dim>& target)
{
    double sum = 0.0;
    for (size_t s = 0; s < target.samples.size(); ++s)
        sum += std::pow(gaussian.value(target.samples[s]) - target.values[s], 2);
    for (const Point<Dim>& face : target.faces)
        sum += target.penalty * std::pow(gaussian.value(face), 2);
    return sum;
}

/// Non-Gaussian peak, at eight points around it.
GaussianTarget<2> spike(const Vec2& center)
{
    GaussianTarget<2> target;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    target.samples.push_back(center);
    for (int s = 0; s < 7; ++s)
        target.samples.push_back(center + Vec2(value(random), 0.5 * value(random)));
    for (const Vec2& x : target.samples)
        target.values.push_back(std::exp(-4.0 * (x - center).norm()));
    return target;
}

TEST(Gaussian, IntegratesOverAnIntervalLikeFineQuadrature)
{
    const Gaussian<1> gaussian{1.7, Point<1>(0.2), Point<1>(0.35)};
    for (const auto& [lower, upper] : {std::pair(-1.0, 1.5), std::pair(0.2, 0.3), std::pair(0.5, 2.0)}) {
        const Box<1> box{Point<1>(lower), Point<1>(upper)};
        const double exact = integrate_finely([&](const Point<1>& x) { return gaussian.value(x); }, box, 400);
        EXPECT_NEAR(gaussian.integral(box), exact, 1e-13);
    }
}

TEST(Gaussian, IntegratesOverABoxLikeFineQuadrature)
{
    // Around the centre, off it on one side, and away from it.
    const Gaussian<2> gaussian{-2.5, Vec2(0.1, -0.3), Vec2(0.2, 0.6)};
    for (const Box<2>& box : {Box<2>(Vec2(-1, -1), Vec2(0.5, 1)), Box<2>(Vec2(0.1, -0.3), Vec2(0.4, 0.1)),
                              Box<2>(Vec2(0.3, 0.2), Vec2(0.9, 0.5))}) {
        const double exact = integrate_finely([&](const Vec2& x) { return gaussian.value(x); }, box, 60);
        EXPECT_NEAR(gaussian.integral(box), exact, 1e-11);
    }
}

TEST(GaussianFit, FindsTheGaussianThatTheSamplesComeFrom)
{
    const Gaussian<2> truth{0.8, Vec2(0.3, 0.4), Vec2(0.25, 0.5)};
    GaussianTarget<2> target = spike(truth.center);
    for (size_t s = 0; s < target.samples.size(); ++s)
        target.values[s] = truth.value(target.samples[s]);
    const Box<2> near(truth.center - Vec2(1, 0.5), truth.center + Vec2(1, 0.5));
    const Gaussian<2> found = fit_gaussian<2>(truth.center, near, target);
    EXPECT_NEAR(found.amplitude, truth.amplitude, 1e-6);
    EXPECT_LT((found.sigma - truth.sigma).norm(), 1e-6);
}

TEST(GaussianFit, EndsAtALocalMinimum)
{
    const Vec2 center(0.2, 0.1);
    const Box<2> near(center - Vec2(1, 0.5), center + Vec2(1, 0.5));
    for (const double penalty : {0.0, 100.0}) {
        GaussianTarget<2> target = spike(center);
        target.faces = face_centers(near);
        target.penalty = penalty;
        const Gaussian<2> best = fit_gaussian<2>(center, near, target);
        const double min_objective = objective(best, target);
        for (const double change : {-1e-3, 1e-3}) {
            Gaussian<2> other = best;
            other.amplitude *= 1.0 + change;
            EXPECT_GE(objective(other, target), min_objective);
            for (int axis = 0; axis < 2; ++axis) {
                other = best;
                other.sigma[axis] *= 1.0 + change;
                EXPECT_GE(objective(other, target), min_objective * (1.0 - 1e-9)) << penalty << " " << axis;
            }
        }
    }
}

TEST(GaussianFit, VanishesAtTheFacesUnderThePenalty)
{
    const Vec2 center = Vec2::Zero();
    const Box<2> near(Vec2(-1, -0.5), Vec2(1, 0.5));
    GaussianTarget<2> target = spike(center);
    target.faces = face_centers(near);
    ASSERT_EQ(target.faces.size(), 4u);
    target.penalty = 0.0;
    const Gaussian<2> free = fit_gaussian<2>(center, near, target);
    target.penalty = 100.0;
    const Gaussian<2> held = fit_gaussian<2>(center, near, target);
    double largest = 0.0, largest_free = 0.0;
    for (const Vec2& face : target.faces) {
        EXPECT_TRUE(near.contains(face));
        largest = std::max(largest, held.value(face));
        largest_free = std::max(largest_free, free.value(face));
    }
    EXPECT_LT(largest, 0.2 * largest_free);
}

TEST(GaussianFit, WidensToItsBoundForAKernelThatDoesNotDecay)
{
    const Vec2 center = Vec2::Zero();
    const Box<2> near(Vec2(-1, -0.5), Vec2(1, 0.5));
    GaussianTarget<2> target = spike(center);
    target.values.assign(target.values.size(), 1.0);
    const Gaussian<2> fit = fit_gaussian<2>(center, near, target);
    EXPECT_NEAR(fit.amplitude, 1.0, 0.02);
    EXPECT_GT(fit.sigma.x(), 0.9 * kMaxSigma);
    EXPECT_GT(fit.sigma.y(), 0.9 * kMaxSigma * 0.5);
}

TEST(GaussLegendre, IntegratesPolynomialsOfItsDegree)
{
    const Box<2> box(Vec2(-0.3, 1.0), Vec2(0.9, 1.8));
    for (const int order : {3, 4})
        for (int p = 0; p < 2 * order; ++p)
            for (int q = 0; q < 2 * order; ++q) {
                const auto line = [&](int axis, int power) {
                    return (std::pow(box.max()[axis], power + 1) - std::pow(box.min()[axis], power + 1)) /
                           (power + 1);
                };
                const double value =
                    weighted_sum([&](const Vec2& x) { return std::pow(x.x(), p) * std::pow(x.y(), q); },
                                 gauss_legendre(box, order));
                EXPECT_NEAR(value, line(0, p) * line(1, q), 1e-12 * std::pow(1.8, q)) << p << " " << q;
            }
}

TEST(StackedIntegral, IsExactForAGaussianPlusAPolynomial)
{
    const Box<2> near(Vec2(-0.2, -0.3), Vec2(0.4, 0.3)), middle(Vec2(-1, -1), Vec2(1, 1));
    const Gaussian<2> gaussian{1.0, Vec2(0.1, 0.0), Vec2(0.1, 0.15)};
    const auto polynomial = [](const Vec2& x) { return 1.0 + 2.0 * x.x() * x.x() * x.y() * x.y(); };
    const double exact = gaussian.integral(near) + 4.0 + 8.0 / 9.0;

    // The Gaussian is cut off at the near box, as in eq. 18.
    const double value = stacked_integral(
        [&](const Vec2& x) { return polynomial(x) + (near.contains(x) ? gaussian.value(x) : 0.0); }, gaussian,
        near, gauss_legendre(middle, 3));
    EXPECT_NEAR(value, exact, 1e-13);
}

} // namespace
} // namespace toile::test
