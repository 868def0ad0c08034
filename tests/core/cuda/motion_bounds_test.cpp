#include "collision/device_motion_bounds.h"

#include "tests/collision/motion_cases.h"
#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

class DeviceMotionBoundsTest : public OnDevice {};

/// Of one mesh after the other, the second larger.
TEST_F(DeviceMotionBoundsTest, HaveTheBitsOfTheCpu)
{
    Random random(3);
    DeviceMotionBounds there(space());
    for (const double size : {0.7, 1.5}) {
        MotionCase made = motion_case(random);
        for (std::vector<Vec3>* x : {&made.before, &made.now})
            for (Vec3& point : *x)
                point *= size;
        MotionBounds here;
        here.build(made.triangles, made.before, made.now, made.box());
        DeviceArray<Triangle> triangles(space(), "test/triangles");
        DeviceArray<Vec3> before(space(), "test/before"), now(space(), "test/now");
        triangles.upload(made.triangles);
        before.upload(made.before);
        now.upload(made.now);
        there.build(triangles.view(), before.view(), now.view(), made.box());

        const View<const Bounds> expected = here.view().motion;
        const int cells = there.view().grid.cell_count();
        ASSERT_EQ(cells, expected.size());
        DeviceArray<Bounds> copy(space(), "test/motion", cells);
        copy.upload(there.view().motion.subview(0, cells));
        const std::vector<Bounds> found = copy.downloaded();
        int filled = 0;
        for (int i = 0; i < cells; ++i) {
            EXPECT_EQ(found[i].lower, expected[i].lower) << i;
            EXPECT_EQ(found[i].upper, expected[i].upper) << i;
            filled += found[i].empty() ? 0 : 1;
        }
        EXPECT_GT(filled, 100);
    }
}

} // namespace
} // namespace toile::test
