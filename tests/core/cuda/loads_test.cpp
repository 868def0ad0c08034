#include <algorithm>
#include <cmath>
#include <random>

#include "garment/energy/aerodynamics.h"
#include "garment/energy/device_loads.h"
#include "tests/core/cuda/on_device.h"
#include "tests/garment/sheets.h"

/// Gravity, damping and air on a GPU against the CPU's.
namespace toile::test {
namespace {

constexpr double kDt = 1.0 / 120.0;
constexpr int kGap = 3; ///< vertices of no cloth before the first

/// Two sheets of different damping that flutter in a gusty wind, after a few vertices of no cloth.
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
            const std::vector<double> own = masses_of(*sheet.rest(), 0.1);
            masses.insert(masses.end(), own.begin(), own.end());
        }
        // A triangle without area feels nothing.
        for (int k = 1; k < 3; ++k)
            x[first[0] + sheets[0].triangles[0][k]] = x[first[0] + sheets[0].triangles[0][0]];
    }
    Gusts gusts() const { return {settings.wind, {.intensity = turbulence, .seed = 7}}; }

    /// As a scene has it computed on the CPU.
    std::vector<Vec3> here(double t) const
    {
        std::vector<Vec3> acceleration(x.size(), settings.gravity);
        for (size_t c = 0; c < sheets.size(); ++c) {
            const int count = int(sheets[c].uv.size());
            const auto own_x = View<const Vec3>(x).subview(first[c], count);
            const auto own_v = View<const Vec3>(v).subview(first[c], count);
            const auto own = View<Vec3>(acceleration).subview(first[c], count);
            for (int i = 0; i < count; ++i)
                FallDamped{settings.gravity, own_v, own}.at(i, FallDamped::decay(damping[c], kDt));
            std::vector<Vec3> gusts_at;
            if (gusts().are_active()) {
                gusts_at.resize(count);
                gusts().sample(own_x, t, gusts_at);
            }
            Aerodynamics air(sheets[c].rest(), settings.air);
            if (air.is_active())
                air.add_acceleration(own_x, own_v, View<const double>(masses).subview(first[c], count),
                                     settings.wind, kDt, own, gusts_at);
        }
        return acceleration;
    }
    std::vector<Vec3> there(const CudaSpace& space, double t) const
    {
        DeviceLoads loads(space, settings, gusts());
        for (size_t c = 0; c < sheets.size(); ++c)
            loads.add(*sheets[c].rest(),
                      View<const double>(masses).subview(first[c], int(sheets[c].uv.size())), damping[c],
                      first[c]);
        DeviceArray<Vec3> x_there(space, "test/x"), v_there(space, "test/v"),
            acceleration(space, "test/acceleration", int(x.size()));
        x_there.upload(x);
        v_there.upload(v);
        loads.set_time(t);
        loads.accelerate(kDt, x_there.view(), v_there.view(), acceleration.view());
        return acceleration.downloaded();
    }
};

class DeviceLoadsTest : public OnDevice {
protected:
    /// Both, and that they are the same to rounding: at a vertex a sum of some six drags of a few hundred
    /// m/s^2, and gusts whose phases of some 100 rad are rounded.
    void expect_same(const Flutter& flutter)
    {
        const std::vector<Vec3> here = flutter.here(1.7), there = flutter.there(space(), 1.7);
        double largest = 0.0;
        for (const Vec3& a : here)
            largest = std::max(largest, a.norm());
        for (size_t i = 0; i < here.size(); ++i)
            ASSERT_LT((here[i] - there[i]).norm(), 1e-12 * largest) << i;
    }
};

TEST_F(DeviceLoadsTest, AreThoseOfTheCpu)
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
    EXPECT_EQ(flutter.there(space(), 0.5), flutter.there(space(), 0.5));
    EXPECT_NE(flutter.there(space(), 0.5), flutter.there(space(), 0.6));
}

} // namespace
} // namespace toile::test
