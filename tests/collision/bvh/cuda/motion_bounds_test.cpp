#include "collision/bvh/cuda/motion_bounds.h"

#include "tests/collision/motion_cases.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace collision;

namespace {

class DeviceMotionBoundsTest : public OnDevice {};

/// Bounds of two meshes in sequence, the second larger.
TEST_F(DeviceMotionBoundsTest, HaveTheBitsOfTheCpu)
{
    Random random(3);
    DeviceMotionBounds gpu(space());
    for (const double size : {0.7, 1.5}) {
        MotionCase made = motion_case(random);
        for (std::vector<Vec3>* x : {&made.before, &made.now})
            for (Vec3& point : *x)
                point *= size;
        MotionBounds cpu;
        cpu.build(made.triangles, made.before, made.now, made.box());
        DeviceArray<Triangle> triangles(space(), "test/triangles");
        DeviceArray<Vec3> before(space(), "test/before"), now(space(), "test/now");
        triangles.upload(made.triangles);
        before.upload(made.before);
        now.upload(made.now);
        gpu.build(triangles.view(), before.view(), now.view(), made.box());

        const View<const Bounds> expected = cpu.view().motion;
        const int cells = gpu.view().grid.cell_count();
        ASSERT_EQ(cells, expected.size());
        DeviceArray<Bounds> copy(space(), "test/motion", cells);
        copy.upload(gpu.view().motion.subview(0, cells));
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
