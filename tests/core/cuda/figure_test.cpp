#include "scenes/figure.h"

#include "core/backend/cuda/array.h"
#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

using DeviceFigureTest = OnDevice;

TEST_F(DeviceFigureTest, IsPosedThereAsOnTheCpu)
{
    scene::Avatar settings;
    settings.name = "mannequin";
    settings.shape = scene::Mannequin{};
    settings.clip = "walk";
    settings.exclude_bones = {"hand_l", "foot_r"};
    Figure figure(settings, identity_affine());
    const std::unique_ptr<DeviceMeshPoses> there = figure.on_device(space());
    DeviceArray<Vec3> x(space(), "test/x", figure.vertex_count());
    std::vector<Vec3> expected(size_t(figure.vertex_count()));
    const auto compare = [&](const char* what) {
        const std::vector<Vec3> found = x.downloaded();
        for (size_t v = 0; v < expected.size(); ++v)
            ASSERT_LT((found[v] - expected[v]).norm(), 1e-14)
                << what << ", vertex " << v; // other contractions
    };
    Affine carried = identity_affine();
    for (const double t : {0.2, 0.4}) {
        carried.col(3) = Vec3(0, t, 0);
        ASSERT_TRUE(figure.advance_to(t, carried));
        figure.pose_t0(expected);
        there->pose_t0(x);
        compare("start");
        figure.pose_t1(expected);
        there->pose_t1(x);
        compare("end");
    }
}

} // namespace
} // namespace toile::test
