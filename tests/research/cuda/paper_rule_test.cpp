#include "research/paper_rule/cuda/paper_rule.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/pd/cuda/body.h"
#include "core/pd/step/body.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/pinned_sheet.h"

/// Paper's rule on a GPU compared with the CPU.
namespace toile::test {

using namespace research;

namespace {

/// Max difference relative to the max entry.
double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max_difference = 0.0, size = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        max_difference = std::max(max_difference, (a[i] - b[i]).norm());
        size = std::max(size, b[i].norm());
    }
    return max_difference / size;
}

class DevicePaperRuleTest : public OnDevice {
protected:
    std::unique_ptr<GlobalSolver> make(const PaperRule::Settings& settings = {}) const
    {
        return std::make_unique<DevicePaperRule>(space(), pinned_.sheet.uv, pinned_.rest->triangles,
                                                 settings);
    }

    PinnedSheet pinned_;
};

TEST_F(DevicePaperRuleTest, SolvesAsOnTheCpu)
{
    for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact})
        for (const int applications : {1, 2, 3}) {
            PaperRule::Settings settings;
            settings.denominator = denominator;
            settings.applications = applications;
            const std::vector<Vec3> gpu = pinned_.solved(make(settings));
            const std::vector<Vec3> cpu = pinned_.solved(
                std::make_unique<PaperRule>(pinned_.sheet.uv, pinned_.rest->triangles, settings));
            EXPECT_LT(difference(gpu, cpu), 1e-12) << applications;
            EXPECT_EQ(gpu[pinned_.sheet.at(0, 0)], pinned_.load[pinned_.sheet.at(0, 0)]);
        }
}

TEST_F(DevicePaperRuleTest, HasTheSameBitsTwice)
{
    EXPECT_EQ(pinned_.solved(make()), pinned_.solved(make()));
}

/// The line search refuses nearly every direction, on both machines alike.
TEST_F(DevicePaperRuleTest, StepsAsOnTheCpuInsideABody)
{
    const std::vector<Vec3> start = pinned_.sheet.flat();
    const std::vector<Vec3> gravity(start.size(), Vec3(0.0, -9.81, 0.0));
    for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact}) {
        PaperRule::Settings settings;
        settings.denominator = denominator;
        DeviceBody gpu(space(), start, pinned_.system(make(settings)), {});
        Body cpu(
            start,
            pinned_.system(std::make_unique<PaperRule>(pinned_.sheet.uv, pinned_.rest->triangles, settings)),
            {});
        for (int step = 0; step < 3; ++step) {
            for (PointMasses* body : {static_cast<PointMasses*>(&gpu), static_cast<PointMasses*>(&cpu)})
                body->step(1.0 / 60.0, gravity, pinned_.fixed, start, nullptr, nullptr);
            double apart = 0.0;
            for (int i = 0; i < int(start.size()); ++i)
                apart = std::max(apart, (gpu.positions()[i] - cpu.positions()[i]).norm());
            EXPECT_LT(apart, 1e-5) << step;
        }
    }
}

} // namespace
} // namespace toile::test
