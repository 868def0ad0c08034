#include "collision/ccd/safe_motion.h"

#include <gtest/gtest.h>

#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

namespace {

using test::PairCase;
using test::Random;

double distance(const PairCase& c, double t) { return test::distance_at(c.is_edge_edge, c.x, c.move, t); }

/// Distance at time t in double precision, for searching.
double quick_distance(const PairCase& c, double t)
{
    std::array<Vec3, 4> now;
    for (int k = 0; k < 4; ++k)
        now[k] = c.x[k] + t * c.move[k];
    return closest_difference(closest_weights(c.is_edge_edge, now), now).norm();
}

/// Time of min distance on [0, end], of `count` samples.
double nearest_time(const PairCase& c, double end, int count)
{
    double best = 0.0, min_distance = quick_distance(c, 0.0);
    for (int i = 1; i <= count; ++i)
        if (const double t = end * i / count, d = quick_distance(c, t); d < min_distance) {
            min_distance = d;
            best = t;
        }
    return best;
}

TEST(PairGeometry, DistancesMatchQuadruplePrecision)
{
    Random random(11);
    for (int i = 0; i < 20000; ++i) {
        const PairCase c = random_case(random);
        const std::array<double, 4> weight = closest_weights(c.is_edge_edge, c.x);
        EXPECT_NEAR(weight[0] + weight[1] + weight[2] + weight[3], 0.0, 1e-15);
        const Vec3 difference = closest_difference(weight, c.x);
        EXPECT_NEAR(difference.norm(), test::exact_distance(c.is_edge_edge, c.x), 2e-11)
            << i << " kind " << int(c.kind) << " edges " << c.is_edge_edge;
        EXPECT_NEAR(separating_direction(c.is_edge_edge, c.x, weight, difference).norm(), 1.0, 1e-12);
    }
}

TEST(MaxSafeStep, NeverPassesTheMinDistance)
{
    Random random(12);
    int stopped = 0;
    for (int i = 0; i < 20000; ++i) {
        const PairCase c = random_case(random);
        const double begin = distance(c, 0.0);
        const double min_distance = begin * random.scale(1e-3, 2.0);
        const double fraction = max_safe_step(c.is_edge_edge, c.x, c.move, min_distance);
        ASSERT_TRUE(fraction >= 0.0 && fraction <= 1.0);
        stopped += fraction < 1.0;
        // A pair that begins too near keeps its first distance up to rounding.
        const double bound = begin > min_distance + 1e-11 ? min_distance : begin * (1.0 - 1e-6) - 1e-15;
        for (const double t : {fraction, 0.5 * fraction, nearest_time(c, fraction, 60)})
            ASSERT_GE(distance(c, t), bound) << i << " kind " << int(c.kind) << " edges " << c.is_edge_edge;
    }
    EXPECT_GT(stopped, 4000);
}

TEST(MaxSafeStep, UsesMostOfTheGap)
{
    Random random(13);
    int stopped = 0, premature = 0;
    for (int i = 0; i < 20000; ++i) {
        const PairCase c = random_case(random);
        const double begin = distance(c, 0.0);
        const double min_distance = 0.1 * begin;
        if (begin < 1e-9)
            continue;
        const double fraction = max_safe_step(c.is_edge_edge, c.x, c.move, min_distance);
        if (fraction < 1.0) {
            ++stopped;
            premature += distance(c, fraction) - min_distance > 0.1 * (begin - min_distance);
        }
    }
    EXPECT_GT(stopped, 2000);
    EXPECT_EQ(premature, 0);
}

TEST(MaxSafeStep, StopsAVertexAboveATriangle)
{
    const std::array<Vec3, 4> x{Vec3(0.2, 0.5, 0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
    const Vec3 still = Vec3::Zero();
    // Straight down: the step is exact, so the gap is used up to rounding.
    EXPECT_NEAR(max_safe_step(false, x, {Vec3(0, -1, 0), still, still, still}, 0.1), 0.4, 1e-12);
    // A common motion costs nothing, nor does sliding past, however fast.
    const Vec3 fall(0, -1e3, 0), slide(1e3, 0, 0);
    EXPECT_EQ(max_safe_step(false, x, {fall, fall, fall, fall}, 0.1), 1.0);
    EXPECT_EQ(max_safe_step(false, x, {slide, still, still, still}, 0.1), 1.0);
    // 100 m/s in a step of 10 ms, from a distance of a micrometre: the vertex stops before the triangle.
    const std::array<Vec3, 4> close{Vec3(0.2, 1e-6, 0.2), x[1], x[2], x[3]};
    const double fraction = max_safe_step(false, close, {Vec3(0, -1, 0), still, still, still}, 1e-9);
    EXPECT_GT(fraction, 0.9e-6);
    EXPECT_LT(fraction, 1e-6 - 1e-9);
}

TEST(MaxSafeStep, LimitsPairsThatStartTooNear)
{
    const Vec3 still = Vec3::Zero(), up(0, 1, 0);
    const std::array<Vec3, 4> x{Vec3(0.2, 0.05, 0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
    EXPECT_EQ(max_safe_step(false, x, {-up, still, still, still}, 0.1), 0.0);
    EXPECT_EQ(max_safe_step(false, x, {up, still, still, still}, 0.1), 1.0);
    EXPECT_EQ(max_safe_step(false, x, {Vec3(0.1, 0, 0), still, still, still}, 0.1), 1.0);
    // Touching primitives may separate to either side, or move together.
    const std::array<Vec3, 4> touching{Vec3(0.2, 0, 0.2), x[1], x[2], x[3]};
    EXPECT_EQ(max_safe_step(false, touching, {up, still, still, still}, 0.1), 1.0);
    EXPECT_EQ(max_safe_step(false, touching, {-up, still, still, still}, 0.1), 1.0);
    EXPECT_EQ(max_safe_step(false, touching, {up, up, up, up}, 0.1), 1.0);
}

} // namespace
} // namespace toile::test
