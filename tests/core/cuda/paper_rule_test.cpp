#include "quadrature2d/paper/device_paper_rule.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/pd/body.h"
#include "core/pd/device/device_body.h"
#include "tests/core/cuda/held_sheet.h"
#include "tests/core/cuda/on_device.h"

/// The paper's rule on a GPU against the same on the CPU.
namespace toile::test {
namespace {

/// Of the largest entry.
double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double most = 0.0, size = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, (a[i] - b[i]).norm());
        size = std::max(size, b[i].norm());
    }
    return most / size;
}

class DevicePaperRuleTest : public OnDevice {
protected:
    std::unique_ptr<GlobalSolver> make(const PaperRule::Settings& settings = {}) const
    {
        return std::make_unique<DevicePaperRule>(space(), held_.sheet.uv, held_.rest->triangles, settings);
    }

    HeldSheet held_;
};

TEST_F(DevicePaperRuleTest, SolvesAsOnTheCpu)
{
    for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact})
        for (const int applications : {1, 2, 3}) {
            PaperRule::Settings settings;
            settings.denominator = denominator;
            settings.applications = applications;
            const std::vector<Vec3> there = held_.solved(make(settings));
            const std::vector<Vec3> here =
                held_.solved(std::make_unique<PaperRule>(held_.sheet.uv, held_.rest->triangles, settings));
            EXPECT_LT(difference(there, here), 1e-12) << applications;
            EXPECT_EQ(there[held_.sheet.at(0, 0)], held_.load[held_.sheet.at(0, 0)]);
        }
}

TEST_F(DevicePaperRuleTest, HasTheSameBitsTwice) { EXPECT_EQ(held_.solved(make()), held_.solved(make())); }

/// Whose line search refuses nearly everything, so that both go on as if nothing was found.
TEST_F(DevicePaperRuleTest, StepsAsOnTheCpuInsideABody)
{
    const std::vector<Vec3> start = held_.sheet.flat();
    const std::vector<Vec3> gravity(start.size(), Vec3(0.0, -9.81, 0.0));
    for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact}) {
        PaperRule::Settings settings;
        settings.denominator = denominator;
        DeviceBody there(space(), start, held_.system(make(settings)), {});
        Body here(start,
                  held_.system(std::make_unique<PaperRule>(held_.sheet.uv, held_.rest->triangles, settings)),
                  {});
        for (int step = 0; step < 3; ++step) {
            for (PointMasses* body : {static_cast<PointMasses*>(&there), static_cast<PointMasses*>(&here)})
                body->step(1.0 / 60.0, gravity, held_.fixed, start, nullptr, nullptr);
            double apart = 0.0;
            for (int i = 0; i < int(start.size()); ++i)
                apart = std::max(apart, (there.positions()[i] - here.positions()[i]).norm());
            EXPECT_LT(apart, 1e-5) << step;
        }
    }
}

} // namespace
} // namespace toile::test
