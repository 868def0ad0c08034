#include "collision/ccd/collision_free_step.h"

#include <gtest/gtest.h>

#include "collision/check/find_crossings.h"
#include "core/base/stages.h"
#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

namespace {

using test::Random;

constexpr double kEdge = 0.01; // [m]

/// Parallel sheets, one above the other.
struct Layers {
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;

    Layers(int count, int side, double gap)
    {
        for (int layer = 0; layer < count; ++layer) {
            const int first = int(x.size());
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i)
                    x.emplace_back(kEdge * (i + 0.3 * layer), gap * layer, kEdge * (j + 0.2 * layer));
            for (int j = 0; j + 1 < side; ++j)
                for (int i = 0; i + 1 < side; ++i) {
                    const int a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
                    triangles.emplace_back(a, c, b);
                    triangles.emplace_back(b, c, d);
                }
        }
    }
};

/// Steps a soup from pose to pose as ClothContact does.
class Stepper {
public:
    explicit Stepper(const Layers& layers)
        : triangles_(layers.triangles), near_(layers.triangles, layers.x),
          exempt_(layers.x, std::vector<double>(layers.x.size(), kEdge), 2e-6), slack_(layers.x.size(), 3e-4),
          fixed_(layers.x.size(), 0)
    {
    }

    /// Positions at the end of a step towards `wanted`, found with pairs of the `expected` motion.
    std::vector<Vec3> step(const std::vector<Vec3>& from, const std::vector<Vec3>& wanted,
                           const std::vector<Vec3>& expected,
                           const std::vector<unsigned char>& supported = {})
    {
        std::vector<Vec3> motion(from.size());
        for (size_t v = 0; v < from.size(); ++v)
            motion[v] = expected[v] - from[v];
        near_.find(from, {motion, slack_}, 5e-4, pairs_);
        free_step_.begin(from, expected, slack_, fixed_, pairs_);
        std::vector<Vec3> x = wanted;
        held_ = free_step_.limit(x, supported);
        return x;
    }

    /// Limits another pose from the start of the last step.
    std::vector<Vec3> again(std::vector<Vec3> x)
    {
        free_step_.limit(x);
        return x;
    }

    double held() const { return held_; }

    /// Expects no crossing at sampled times of the motion.
    void expect_free(const std::vector<Vec3>& from, const std::vector<Vec3>& to) const
    {
        for (int k = 0; k <= 6; ++k) {
            std::vector<Vec3> x(from.size());
            for (size_t v = 0; v < x.size(); ++v)
                x[v] = from[v] + k / 6.0 * (to[v] - from[v]);
            ASSERT_TRUE(find_crossings(triangles_, x).empty()) << "at " << k << "/6 of the way";
        }
    }

private:
    std::vector<Triangle> triangles_;
    NearPairs near_;
    ExemptPairs exempt_;
    CollisionFreeStep free_step_{near_, exempt_, CollisionFreeStep::Settings{}};
    std::vector<double> slack_;
    std::vector<unsigned char> fixed_;
    std::vector<NearPair> pairs_;
    double held_ = 0.0;
};

TEST(CollisionFreeStep, NeverCrossesUnderRandomMotion)
{
    Random random(31);
    for (int trial = 0; trial < 12; ++trial) {
        const Layers layers(3, 7, 0.002);
        Stepper stepper(layers);
        std::vector<Vec3> x = layers.x;
        const double reach = random.scale(1e-4, 0.1);
        for (int step = 0; step < 8; ++step) {
            std::vector<Vec3> wanted = x, expected = x;
            for (size_t v = 0; v < x.size(); ++v) {
                wanted[v] += reach * random.point() + Vec3(0, -0.05, 0);
                expected[v] += Vec3(0, -0.05, 0);
            }
            const std::vector<Vec3> reached = stepper.step(x, wanted, expected);
            stepper.expect_free(x, reached);
            x = reached;
        }
    }
}

TEST(CollisionFreeStep, SearchesOnceForARepeatedPose)
{
    const Layers layers(2, 8, 0.002);
    Stepper stepper(layers);
    std::vector<Vec3> wanted = layers.x;
    for (size_t v = wanted.size() / 2; v < wanted.size(); ++v)
        wanted[v] += Vec3(0.01, 0.001, 0.0); // along the lower sheet, not expected
    Stages stages;
    const Stages::Activate record(stages);
    EXPECT_EQ(stepper.step(layers.x, wanted, layers.x), wanted);
    EXPECT_EQ(stages.calls("collision/search_again"), 1);
    EXPECT_EQ(stepper.again(wanted), wanted);
    EXPECT_EQ(stages.calls("collision/search_again"), 1);

    // The pairs found for that pose do not hold for another one.
    for (size_t v = wanted.size() / 2; v < wanted.size(); ++v)
        wanted[v] -= Vec3(0.01, 0.01, 0.0);
    const std::vector<Vec3> x = stepper.again(wanted);
    EXPECT_GT(stages.calls("collision/search_again"), 1);
    stepper.expect_free(layers.x, x);
}

TEST(CollisionFreeStep, LeavesFreeStepsUnchangedBitwise)
{
    const Layers layers(2, 6, 0.002);
    Stepper stepper(layers);
    // Both layers translate together, unexpectedly, 500 times as far as they are apart.
    std::vector<Vec3> wanted = layers.x;
    for (Vec3& p : wanted)
        p += Vec3(0.3, -1.0, 0.1);
    EXPECT_EQ(stepper.step(layers.x, wanted, layers.x), wanted);
    EXPECT_EQ(stepper.held(), 0.0);
}

TEST(CollisionFreeStep, StopsSheetsThatMeetAtAHundredMetresPerSecond)
{
    const Layers layers(2, 8, 0.5);
    Stepper stepper(layers);
    std::vector<Vec3> x = layers.x;
    for (int step = 0; step < 6; ++step) {
        std::vector<Vec3> wanted = x;
        for (size_t v = 0; v < x.size(); ++v)
            wanted[v].y() += v < x.size() / 2 ? 0.5 : -0.5; // [m] in a step of 1/200 s each
        const std::vector<Vec3> reached = stepper.step(x, wanted, wanted);
        stepper.expect_free(x, reached);
        x = reached;
    }
    for (size_t v = 0; v < x.size() / 2; ++v) {
        EXPECT_LT(x[v].y(), x[v + x.size() / 2].y());
        EXPECT_LT(x[v + x.size() / 2].y() - x[v].y(), 0.01); // and the sheets do come near
    }
}

/// What comes into another sheet by much more than max_deflection, but little of its motion, slides on.
TEST(CollisionFreeStep, FastSheetsSlideAlongEachOther)
{
    const Layers layers(2, 12, 0.002);
    Stepper stepper(layers);
    const Vec3 motion(0.02, -0.005, 0.0);
    std::vector<Vec3> wanted = layers.x;
    for (size_t v = wanted.size() / 2; v < wanted.size(); ++v)
        wanted[v] += motion;
    const std::vector<Vec3> x = stepper.step(layers.x, wanted, wanted);
    stepper.expect_free(layers.x, x);
    EXPECT_GT(stepper.held(), CollisionFreeStep::Settings().max_deflection);
    double mean = 0.0;
    for (size_t v = x.size() / 2; v < x.size(); ++v) {
        const double slid = (x[v].x() - layers.x[v].x()) / motion.x();
        EXPECT_GT(slid, 0.8);
        mean += slid / (0.5 * double(x.size()));
    }
    EXPECT_NEAR(mean, 1.0, 0.05);
}

TEST(CollisionFreeStep, LimitsOnlyNearbyVertices)
{
    const Layers layers(2, 8, 0.002);
    Stepper stepper(layers);
    std::vector<Vec3> wanted = layers.x;
    const size_t half = wanted.size() / 2, falling = half + 27;
    wanted[falling] -= Vec3(0, 0.004, 0); // one vertex of the upper layer, through the lower one
    const std::vector<Vec3> reached = stepper.step(layers.x, wanted, layers.x);
    stepper.expect_free(layers.x, reached);
    EXPECT_GT(reached[falling].y(), -0.001);
    EXPECT_LT(reached[falling].y(), 0.001); // most of the motion
    for (size_t v = 0; v < wanted.size(); ++v) {
        if (v == falling)
            continue;
        EXPECT_LE((reached[v] - wanted[v]).norm(), 0.001) << v; // less than half as far
        Vec3 beside = layers.x[v] - layers.x[falling];
        beside.y() = 0.0;
        if (beside.norm() > 0.025) {
            EXPECT_EQ(reached[v], wanted[v]) << v;
        }
    }
}

/// Two sheets with columns of needles (edges of 4 micrometres). One needle lies across the border of the
/// sheet below: one end meets the sheet, the other passes.
Layers needle_sheets()
{
    constexpr double kNeedle = 4e-6;
    Layers layers(2, 8, 0.002);
    for (size_t v = 0; v < layers.x.size(); ++v) {
        const bool is_upper = v >= layers.x.size() / 2;
        const int column = int(v) % 8, pair = column / 2;
        // Columns 0, 2, 4 and 6 stay, the odd ones move next to them.
        layers.x[v].x() = pair * kEdge + column % 2 * kNeedle;
        if (is_upper)
            layers.x[v] += Vec3(2 * kEdge + 0.5 * kNeedle, 0.0, 0.0);
    }
    return layers;
}

/// Expects unstretched needles, among stopped pairs and yielding pairs.
void expect_needles_whole(const std::vector<unsigned char>& supported)
{
    constexpr double kShort = 1e-4; // [m]
    const Layers layers = needle_sheets();
    const std::vector<Vec3>& from = layers.x;
    Stepper stepper(layers);
    for (const double fall : {0.0022, 0.0026, 0.05}) {
        std::vector<Vec3> wanted = from;
        for (size_t v = from.size() / 2; v < from.size(); ++v)
            wanted[v].y() -= fall;
        const std::vector<Vec3> to = stepper.step(from, wanted, wanted, supported);
        EXPECT_GT(stepper.held(), 1e-4);
        stepper.expect_free(from, to);
        for (const Triangle& corner : layers.triangles)
            for (int k = 0; k < 3; ++k) {
                const int a = corner[k], b = corner[(k + 1) % 3];
                const double before = (from[a] - from[b]).norm();
                if (before <= kShort) {
                    ASSERT_LE((to[a] - to[b]).norm(), 1.02 * before + 1e-12)
                        << a << " " << b << " by " << fall;
                }
            }
    }
}

TEST(CollisionFreeStep, LimitsTheStretchOfNeedles) { expect_needles_whole({}); }

TEST(CollisionFreeStep, LimitsTheStretchOfNeedlesOfSupportedCloth)
{
    expect_needles_whole(std::vector<unsigned char>(needle_sheets().x.size(), 1));
}

/// Two sheets meet. Their remaining velocity is their common one, independent of the frame of reference.
TEST(CollisionFreeStep, IsGalileanInvariant)
{
    const Layers layers(2, 6, 0.002);
    const size_t half = layers.x.size() / 2;
    const Vec3 flight(0.5, 0.25, -1.0); // exact in binary, like the sheets' displacements
    std::vector<Vec3> wanted = layers.x;
    for (size_t v = 0; v < wanted.size(); ++v)
        wanted[v].y() += v < half ? 0.0 : -0.00390625;
    Stepper at_rest(layers);
    const std::vector<Vec3> reached = at_rest.step(layers.x, wanted, wanted);
    EXPECT_GT(at_rest.held(), 0.001);

    std::vector<Vec3> flying = wanted;
    for (Vec3& p : flying)
        p += flight;
    Stepper in_flight(layers);
    const std::vector<Vec3> landed = in_flight.step(layers.x, flying, flying);
    Vec3 momentum = Vec3::Zero();
    for (size_t v = 0; v < landed.size(); ++v) {
        EXPECT_LE((landed[v] - flight - reached[v]).norm(), 1e-9) << v;
        momentum += reached[v] - wanted[v];
    }
    EXPECT_LE(momentum.norm() / double(landed.size()), 1e-4); // 2 % of the momentum that the sheets lose
}

} // namespace
} // namespace toile::test
