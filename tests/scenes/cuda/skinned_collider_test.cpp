#include "scenes/colliders/skinned_collider.h"

#include <filesystem>

#include "core/compute/cuda/array.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace avatars;
using namespace collision;

namespace {

class DeviceSkinnedColliderTest : public OnDevice {
protected:
    /// Poses a moving avatar on both machines at a few times, under a moving root.
    void expect_same_poses(const scene::Avatar& settings) const
    {
        scenes::SkinnedCollider skinned(settings, identity_affine());
        const std::unique_ptr<DeviceMeshPoses> poses = skinned.on_device(space());
        DeviceArray<Vec3> x(space(), "test/x", skinned.vertex_count());
        std::vector<Vec3> expected(size_t(skinned.vertex_count()));
        const auto compare = [&](const char* what) {
            const std::vector<Vec3> found = x.downloaded();
            for (size_t v = 0; v < expected.size(); ++v)
                ASSERT_LT((found[v] - expected[v]).norm(), 1e-14)
                    << what << ", vertex " << v; // other contractions of multiply-adds
        };
        Affine root_transform = identity_affine();
        for (const double t : {0.2, 0.4}) {
            root_transform.col(3) = Vec3(0, t, 0);
            ASSERT_TRUE(skinned.advance_to(t, root_transform));
            skinned.pose_t0(expected);
            poses->pose_t0(x);
            compare("start");
            skinned.pose_t1(expected);
            poses->pose_t1(x);
            compare("end");
        }
    }
};

TEST_F(DeviceSkinnedColliderTest, IsPosedOnTheGpuAsOnTheCpu)
{
    scene::Avatar settings;
    settings.name = "mannequin";
    settings.shape = scene::Mannequin{};
    settings.clip = "walk";
    settings.exclude_bones = {"hand_l", "foot_r"};
    expect_same_poses(settings);
}

TEST_F(DeviceSkinnedColliderTest, GrowsOnTheGpuAsOnTheCpu)
{
    scene::Avatar settings;
    settings.name = "body";
    settings.shape = std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/growing_tetrahedron.gltf";
    settings.clip = "grow";
    expect_same_poses(settings);
}

} // namespace
} // namespace toile::test
