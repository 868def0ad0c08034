#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

/// Coulomb friction between cloths: a small sheet on a fixed, tilted one.
namespace toile::test {

using namespace scenes;

namespace {

constexpr double kGravity = 9.81; // [m/s^2]
constexpr int kFrames = 10;       // 1/30 s each

/// Parameters of the scene file.
struct Slide {
    double slope;    ///< [-] tangent of the angle
    double friction; ///< [-] of cloth on cloth
    int substeps = 16;
    std::string tolerance = R"("velocity_tolerance": 5e-5)"; ///< converged steps
};

Vec3 mean(View<const Vec3> x)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : x)
        sum += p / x.size();
    return sum;
}

/// Distance of the sheet down the slope in a third of a second [m].
double distance_of(const Slide& slide)
{
    const double angle = std::atan(slide.slope);
    const Vec3 up(std::sin(angle), std::cos(angle), 0.0), down(std::cos(angle), -std::sin(angle), 0.0);
    const auto number = [](double value) { return std::to_string(value); };
    const auto sheet = [&](const std::string& name, const std::string& size, const Vec3& position) {
        return R"({"name": ")" + name + R"(", "fabric": "bare", "rectangle": {"size": )" + size +
               R"(, "resolution": 0.02}, "rotate_deg": [0, 0, )" + number(-angle * 180.0 / std::numbers::pi) +
               R"(], "translate": [)" + number(position.x()) + "," + number(position.y()) + "," +
               number(position.z()) + "]}";
    };
    World world(parse_scene(
        R"({"toile": 1, "frames": 31, "air": {"density": 0},
            "fabrics": {"bare": {"base": "cotton", "damping": 0}},
            "solver": {"substeps": )" +
            std::to_string(slide.substeps) + ", " + slide.tolerance + R"(},
            "contact": {"friction": )" +
            number(slide.friction) + R"(}, "cloths": [)" + sheet("ramp", "[0.4, 0.16]", Vec3::Zero()) + "," +
            sheet("slider", "[0.1, 0.1]", 0.0004 * up - 0.1 * down + Vec3(0.0, 0.0, 0.003)) +
            R"(], "attachments": [{"cloth": "ramp", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}}}]})",
        "test.json"));
    const Vec3 start = mean(world.cloths()[1].positions);
    for (int frame = 0; frame < kFrames; ++frame)
        (void)world.advance_frame();
    return (mean(world.cloths()[1].positions) - start).dot(down);
}

/// Distance by Coulomb's law: g (sin a - mu cos a) t^2 / 2.
double exact_distance_of(const Slide& slide)
{
    const double angle = std::atan(slide.slope), time = kFrames / 30.0;
    return 0.5 * kGravity * (std::sin(angle) - slide.friction * std::cos(angle)) * time * time;
}

void expect_exact(const Slide& slide, double tolerance)
{
    SCOPED_TRACE("slope " + std::to_string(slide.slope) + ", friction " + std::to_string(slide.friction));
    EXPECT_NEAR(distance_of(slide), exact_distance_of(slide), tolerance * exact_distance_of(slide));
}

TEST(ClothFriction, SticksBelowTheFrictionAngle)
{
    for (const double slope : {0.3, 0.6}) {
        SCOPED_TRACE(slope);
        EXPECT_LT(distance_of({slope, 1.01 * slope}), 6e-4) << "while it lands";
    }
}

TEST(ClothFriction, SlidesAtCoulombsAcceleration)
{
    expect_exact({0.3, 0.1}, 0.03);
    expect_exact({0.3, 0.2}, 0.03);
    expect_exact({0.6, 0.5}, 0.03);
}

TEST(ClothFriction, LandsWithoutTangentialImpulse)
{
    // At 8 ms a step the expected position of the sheet is on the far side of the other one, beside its
    // border.
    expect_exact({0.3, 0.1, 4, R"("velocity_tolerance": 1e-4)"}, 0.03);
}

TEST(ClothFriction, IsCoulombsAtTheDefaultTolerance)
{
    // The slip in a step, 1 to 200 micrometres, is below the accuracy of such a step.
    for (const int substeps : {4, 16, 64})
        for (const auto& [slope, friction] : {std::pair(0.3, 0.1), {0.3, 0.2}, {0.6, 0.4}}) {
            SCOPED_TRACE(substeps);
            expect_exact({slope, friction, substeps, R"("quality": "standard")"}, 0.1);
        }
}

TEST(ClothFriction, LetsClothSlideFivePerCentAboveTheFrictionAngle)
{
    const Slide slide{0.3, 0.3 / 1.05};
    EXPECT_GT(distance_of(slide), 0.5 * exact_distance_of(slide));
}

TEST(ClothFriction, TakesNoEnergyWithoutFriction)
{
    // All of the height becomes motion, at the default tolerance too.
    for (const char* tolerance : {R"("velocity_tolerance": 5e-5)", R"("quality": "standard")"}) {
        SCOPED_TRACE(tolerance);
        expect_exact({0.3, 0.0, 16, tolerance}, 0.005);
    }
}

} // namespace
} // namespace toile::test
