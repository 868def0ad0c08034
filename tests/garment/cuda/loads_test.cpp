#include <algorithm>
#include <cmath>
#include <random>

#include "garment/energy/air/aerodynamics.h"
#include "garment/energy/air/cuda/loads.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/sheets.h"

/// Gravity, damping and air on a GPU compared with the CPU.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kDt = 1.0 / 120.0;
constexpr int kGap = 3; ///< vertices of no cloth before the first

/// Two sheets of different damping in a gusty wind, behind a few vertices of no cloth.
struct Flutter {
    std::vector<Sheet> sheets{make_sheet(Vec2(0.5, 0.4), 40, 32, Pattern::Irregular),
                              make_sheet(Vec2(0.3, 0.3), 7, 9, Pattern::Irregular)};
    std::vector<double> damping{0.0, 2.5};
    DeviceLoads::Settings settings{Vec3(0.3, -9.81, 0.0), {1.2, 1.1, 0.04}, Vec3(3.0, 0.5, -1.0)};
    double turbulence = 0.4;
    std::vector<int> first;
    std::vector<double> masses = std::vector<double>(kGap, 1.0);
    std::vector<Vec3> x = std::vector<Vec3>(kGap, Vec3::Zero()), v = x;

    Flutter()
    {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> some(-1.0, 1.0);
        for (const Sheet& sheet : sheets) {
            first.push_back(int(x.size()));
            for (const Vec3& flat : sheet.flat()) {
                x.push_back(flat + 0.003 * Vec3(some(random), some(random), some(random)));
                v.emplace_back(2.0 * some(random), 2.0 * some(random), 2.0 * some(random));
            }
            const std::vector<double> part = masses_of(*sheet.rest(), 0.1);
            masses.insert(masses.end(), part.begin(), part.end());
        }
        // A triangle without area has no drag.
        for (int k = 1; k < 3; ++k)
            x[first[0] + sheets[0].triangles[0][k]] = x[first[0] + sheets[0].triangles[0][0]];
    }
    Gusts gusts() const { return {settings.wind, {.intensity = turbulence, .seed = 7}}; }

    /// Accelerations by the CPU code of a scene.
    std::vector<Vec3> on_cpu(double t) const
    {
        std::vector<Vec3> acceleration(x.size(), settings.gravity);
        for (size_t c = 0; c < sheets.size(); ++c) {
            const int count = int(sheets[c].uv.size());
            const auto part_x = View<const Vec3>(x).subview(first[c], count);
            const auto part_v = View<const Vec3>(v).subview(first[c], count);
            const auto part = View<Vec3>(acceleration).subview(first[c], count);
            for (int i = 0; i < count; ++i)
                FallDamped{settings.gravity, part_v, part}.at(i, FallDamped::decay(damping[c], kDt));
            std::vector<Vec3> gusts_at;
            if (gusts().are_active()) {
                gusts_at.resize(count);
                gusts().sample(part_x, t, gusts_at);
            }
            Aerodynamics air(sheets[c].rest(), settings.air);
            if (air.is_active())
                air.add_acceleration(part_x, part_v, View<const double>(masses).subview(first[c], count),
                                     settings.wind, kDt, part, gusts_at);
        }
        return acceleration;
    }
    std::vector<Vec3> on_gpu(const CudaSpace& space, double t) const
    {
        DeviceLoads loads(space, settings, gusts());
        for (size_t c = 0; c < sheets.size(); ++c)
            loads.add(*sheets[c].rest(),
                      View<const double>(masses).subview(first[c], int(sheets[c].uv.size())), damping[c],
                      first[c]);
        DeviceArray<Vec3> x_device(space, "test/x"), v_device(space, "test/v"),
            acceleration(space, "test/acceleration", int(x.size()));
        x_device.upload(x);
        v_device.upload(v);
        loads.set_step(t, true);
        loads.accelerate(kDt, x_device.view(), v_device.view(), acceleration.view());
        return acceleration.downloaded();
    }
};

class DeviceLoadsTest : public OnDevice {
protected:
    /// Expects equal results to rounding. A vertex sums some six drags of a few hundred m/s^2, and phases of
    /// gusts of some 100 rad are rounded.
    void expect_same(const Flutter& flutter)
    {
        const std::vector<Vec3> on_cpu = flutter.on_cpu(1.7), on_gpu = flutter.on_gpu(space(), 1.7);
        double largest = 0.0;
        for (const Vec3& a : on_cpu)
            largest = std::max(largest, a.norm());
        for (size_t i = 0; i < on_cpu.size(); ++i)
            ASSERT_LT((on_cpu[i] - on_gpu[i]).norm(), 1e-12 * largest) << i;
    }
};

TEST_F(DeviceLoadsTest, MatchTheCpu)
{
    Flutter flutter;
    expect_same(flutter);
    flutter.turbulence = 0.0;
    expect_same(flutter);
    flutter.settings.air.density = 0.0;
    expect_same(flutter);
}

TEST_F(DeviceLoadsTest, HaveTheSameBitsEveryTimeAndFollowTheTime)
{
    const Flutter flutter;
    EXPECT_EQ(flutter.on_gpu(space(), 0.5), flutter.on_gpu(space(), 0.5));
    EXPECT_NE(flutter.on_gpu(space(), 0.5), flutter.on_gpu(space(), 0.6));
}

} // namespace
} // namespace toile::test
