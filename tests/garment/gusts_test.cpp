#include "garment/energy/air/gusts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "garment/energy/air/aerodynamics.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

const Vec3 kMean(4.0, 0.5, -1.0);

Gusts gusts_of(double intensity, std::uint64_t seed = 0)
{
    Gusts::Settings settings;
    settings.intensity = intensity;
    settings.seed = seed;
    return {kMean, settings};
}

/// Mean and second moments of u' over `count` samples.
struct Moments {
    Vec3 mean = Vec3::Zero();
    Mat3 covariance = Mat3::Zero();
};

template <typename Sample>
Moments moments(int count, const Sample& sample)
{
    Moments m;
    for (int i = 0; i < count; ++i) {
        const Vec3 u = sample(i);
        m.mean += u / count;
        m.covariance += u * u.transpose() / count;
    }
    return m;
}

/// Point i of a grid of side^3 points that is incommensurate with the gusts' wavelengths [m].
Vec3 grid_point(int i, int side)
{
    const int column = i % side, row = i / side % side, layer = i / (side * side);
    return {0.31 * column, 0.37 * row, 0.29 * layer};
}

void expect_isotropic(const Moments& m, double deviation)
{
    EXPECT_LT(m.mean.norm(), 0.01 * deviation);
    EXPECT_LT((m.covariance / (deviation * deviation) - Mat3::Identity()).cwiseAbs().maxCoeff(), 0.02);
}

TEST(Gusts, HaveZeroMeanAndTheDeclaredDeviationOverTime)
{
    for (const std::uint64_t seed : {0, 1, 2, 3}) {
        const Gusts gusts = gusts_of(0.3, seed);
        expect_isotropic(moments(200000, [&](int i) { return gusts.at(Vec3(0.3, 1.0, -0.2), 0.037 * i); }),
                         0.3 * kMean.norm());
    }
}

TEST(Gusts, HaveZeroMeanAndTheDeclaredDeviationOverSpace)
{
    const Gusts gusts = gusts_of(0.3);
    expect_isotropic(moments(216000, [&](int i) { return gusts.at(grid_point(i, 60), 2.0); }),
                     0.3 * kMean.norm());
}

TEST(Gusts, AreFreeOfDivergence)
{
    const Gusts gusts = gusts_of(0.5, 7);
    const double h = 1e-5;
    for (int i = 0; i < 50; ++i) {
        const Vec3 x(std::sin(i), std::cos(2.0 * i), 0.1 * i);
        Mat3 gradient;
        for (int k = 0; k < 3; ++k)
            gradient.col(k) =
                (gusts.at(x + h * Vec3::Unit(k), 1.0) - gusts.at(x - h * Vec3::Unit(k), 1.0)) / (2.0 * h);
        EXPECT_LT(std::abs(gradient.trace()), 1e-7 * (1.0 + gradient.norm()));
    }
}

/// Correlation coefficient of u' between points with a given offset and delay, over many of them.
double correlation(const Gusts& gusts, const Vec3& shift, double delay)
{
    double product = 0.0, square = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 x = grid_point(i, 27);
        const double t = 0.73 * i;
        const Vec3 u = gusts.at(x, t);
        product += u.dot(gusts.at(x + shift, t + delay));
        square += u.squaredNorm();
    }
    return product / square;
}

TEST(Gusts, DecorrelateWithDistanceAndTravelWithTheWind)
{
    const Gusts gusts = gusts_of(0.1, 5);
    EXPECT_GT(correlation(gusts, Vec3(0.02, 0, 0), 0.0), 0.95);
    for (int k = 0; k < 3; ++k)
        EXPECT_LT(std::abs(correlation(gusts, 1.5 * Vec3::Unit(k), 0.0)), 0.5);
    // A tenth of a second later the same air is 0.4 m downwind.
    const double delay = 0.1;
    EXPECT_GT(correlation(gusts, delay * kMean, delay), 0.95);
    EXPECT_GT(correlation(gusts, delay * kMean, delay), correlation(gusts, Vec3::Zero(), delay) + 0.2);
}

TEST(Gusts, DependOnTheSeedOnly)
{
    const Vec3 x(0.2, 0.7, 0.1);
    EXPECT_EQ(gusts_of(0.3, 4).at(x, 1.5), gusts_of(0.3, 4).at(x, 1.5));
    EXPECT_GT((gusts_of(0.3, 4).at(x, 1.5) - gusts_of(0.3, 5).at(x, 1.5)).norm(), 0.01);
    EXPECT_FALSE(gusts_of(0.0).are_active());
    EXPECT_FALSE(Gusts(Vec3::Zero(), {.intensity = 0.5}).are_active());
}

TEST(Aerodynamics, TakesAUniformGustForWind)
{
    const Sheet sheet = make_sheet(Vec2(0.3, 0.3), 6, 6, Pattern::Irregular);
    const std::vector<Vec3> x = sheet.flat(), v(x.size(), Vec3(0.1, 0.2, 0.3));
    const std::vector<double> masses(x.size(), 1e-3);
    Aerodynamics air(sheet.rest(), {});
    const Vec3 gust(0.5, -0.25, 1.0);
    std::vector<Vec3> together(x.size(), Vec3::Zero()), apart = together, steady = together, zero = together;
    air.add_acceleration(x, v, masses, kMean + gust, 0.01, together);
    air.add_acceleration(x, v, masses, kMean, 0.01, apart, std::vector<Vec3>(x.size(), gust));
    air.add_acceleration(x, v, masses, kMean, 0.01, steady);
    air.add_acceleration(x, v, masses, kMean, 0.01, zero, std::vector<Vec3>(x.size(), Vec3::Zero()));
    for (size_t i = 0; i < x.size(); ++i) {
        EXPECT_LT((together[i] - apart[i]).norm(), 1e-12 * together[i].norm());
        EXPECT_EQ(steady[i], zero[i]);
        EXPECT_GT((together[i] - steady[i]).norm(), 0.05);
    }
}

} // namespace
} // namespace toile::test
