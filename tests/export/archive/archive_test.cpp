#include <gmock/gmock.h>

#include "export/archive/face_groups.h"
#include "export/archive/frame_velocities.h"
#include "export/archive/names.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

TEST(FrameVelocities, AreCentralDifferencesAndOneSidedAtTheEnds)
{
    FrameVelocities velocities(10.0);
    const auto at = [](double x) { return std::vector<Vec3>{Vec3(x, 0, 0)}; };
    EXPECT_FALSE(velocities.advance(at(0.0)));
    ASSERT_TRUE(velocities.advance(at(1.0)));
    EXPECT_EQ(velocities.completed().positions[0].x(), 0.0);
    EXPECT_EQ(velocities.completed().velocities[0].x(), 10.0);
    ASSERT_TRUE(velocities.advance(at(4.0)));
    EXPECT_EQ(velocities.completed().positions[0].x(), 1.0);
    EXPECT_EQ(velocities.completed().velocities[0].x(), 20.0);
    ASSERT_TRUE(velocities.finish());
    EXPECT_EQ(velocities.completed().positions[0].x(), 4.0);
    EXPECT_EQ(velocities.completed().velocities[0].x(), 30.0);
    EXPECT_FALSE(velocities.finish());
}

TEST(FrameVelocities, AreZeroForASingleFrame)
{
    FrameVelocities velocities(24.0);
    velocities.advance(std::vector<Vec3>{Vec3(1, 2, 3)});
    ASSERT_TRUE(velocities.finish());
    EXPECT_EQ(velocities.completed().velocities[0], Vec3(0, 0, 0));
}

TEST(FaceGroups, JoinWhatHasOneNameAndKeepOthersApart)
{
    ObjMesh mesh = quad_mesh();
    mesh.groups = {{0, "a b"}, {1, "a-b"}, {2, "a b"}};
    const std::vector<FaceGroup> groups = face_groups(mesh);
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0].polygons, (std::vector<int>{0, 2}));
    EXPECT_EQ(groups[0].clean_name, "a_b");
    EXPECT_EQ(groups[1].clean_name, "a_b_2");
    EXPECT_EQ(groups[1].name, "a-b");
}

TEST(Names, HaveLettersDigitsAndUnderscores)
{
    EXPECT_EQ(clean_name("back panel"), "back_panel");
    EXPECT_EQ(clean_name("7"), "_7");
    EXPECT_EQ(clean_name(""), "_");
}

} // namespace

} // namespace toile::test
