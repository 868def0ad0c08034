#include "core/pd/step_end.h"

#include <gtest/gtest.h>

#include "tests/garment/touching_plane.h"

namespace toile {
namespace {

/// Remembers which of its sweeps went on from the one before.
class SweptPlane : public test::TouchingPlane {
public:
    using TouchingPlane::TouchingPlane;
    bool sweep_once(StepField, bool goes_on) const override
    {
        went_on.push_back(goes_on);
        return false;
    }
    mutable std::vector<bool> went_on;
};

/// Sweeps over a limit of its own, with three of contact in between.
class ThreeSweeps : public StepProjection {
public:
    void observe(View<const Vec3>) override {}
    void project(View<Vec3>, View<const double>, const std::function<bool()>& clear_contacts) override
    {
        for (int sweep = 0; sweep < 3; ++sweep)
            clear_contacts();
    }
};

TEST(StepEnd, LetsSweepsOfContactGoOnWithinAProjection)
{
    std::vector<Vec3> x(2, Vec3::Zero()), v = x;
    const std::vector<double> masses(2, 1.0);
    const std::vector<unsigned char> fixed(2, 0);
    SweptPlane plane(x, {});
    ThreeSweeps limit;
    StepEnd end(x, v, masses, fixed, 0.01);
    end.project(limit, &plane);
    end.project(limit, &plane); // cloth has been brought back in between
    EXPECT_EQ(plane.went_on, std::vector<bool>({false, true, true, false, true, true}));
}

} // namespace
} // namespace toile
