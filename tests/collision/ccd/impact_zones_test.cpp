#include "collision/ccd/impact_zones.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace collision;

namespace {

using Support = ImpactZones::Support;

/// Common displacement of a zone of all vertices.
Vec3 common_of(const std::vector<Vec3>& displacements, const std::vector<Support>& support, double slow = 0.0)
{
    ImpactZones zones;
    zones.reset(displacements, support, slow);
    for (int v = 1; v < int(displacements.size()); ++v)
        zones.join(v - 1, v);
    return zones.common(0);
}

TEST(ImpactZones, KeepMomentumWithoutSupport)
{
    EXPECT_EQ(
        common_of({Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 3)}, std::vector<Support>(3, Support::kNone)),
        Vec3(1, 1, 1));
}

TEST(ImpactZones, FollowSupportedCloth)
{
    const std::vector<Vec3> displacements{Vec3(0, -9, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)};
    EXPECT_EQ(common_of(displacements, {Support::kNone, Support::kSupported, Support::kSupported}),
              Vec3(2, 0, 0));
}

TEST(ImpactZones, FollowTheSlowestFixedVertex)
{
    const std::vector<Vec3> displacements{Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 2, 0)};
    EXPECT_EQ(common_of(displacements, {Support::kSupported, Support::kFixed, Support::kFixed}),
              Vec3(0, 2, 0));
    EXPECT_EQ(common_of(displacements, {Support::kFixed, Support::kFixed, Support::kNone}), Vec3(0, 0, 0));
}

TEST(ImpactZones, StopBelowTheCreepThreshold)
{
    const std::vector<Vec3> displacements{Vec3(0.001, 0, 0), Vec3(0.003, 0, 0)};
    EXPECT_EQ(common_of(displacements, std::vector<Support>(2, Support::kNone), 0.0019), Vec3(0.002, 0, 0));
    EXPECT_EQ(common_of(displacements, std::vector<Support>(2, Support::kNone), 0.0021), Vec3(0, 0, 0));
}

TEST(ImpactZones, ScaleMotionByFractionsInsideTheZoneOnly)
{
    const std::vector<Vec3> displacements{Vec3(2, 0, 0), Vec3(0, 0, 0), Vec3(0, 7, 0)};
    ImpactZones zones;
    zones.reset(displacements, std::vector<Support>(3, Support::kNone), 0.0);
    zones.join(0, 1);
    zones.limit_by(0, 0.5);
    zones.limit_by(0, 0.75); // the smaller fraction counts
    EXPECT_EQ(zones.motion(0), displacements[0]);
    zones.close_pass();
    EXPECT_EQ(zones.motion(0), Vec3(1.5, 0, 0)); // 1 + half of 2 - 1
    EXPECT_EQ(zones.motion(1), displacements[1]);
    EXPECT_EQ(zones.motion(2), displacements[2]);
    zones.limit_by(0, 0.5);
    zones.close_pass();
    EXPECT_EQ(zones.fraction(0), 0.25);
}

TEST(ImpactZones, ForgetJoinsOnReset)
{
    const std::vector<Vec3> displacements{Vec3(4, 0, 0), Vec3(0, 0, 0)};
    ImpactZones zones;
    for (int time = 0; time < 2; ++time) {
        zones.reset(displacements, std::vector<Support>(2, Support::kNone), 0.0);
        EXPECT_EQ(zones.common(0), displacements[0]);
        EXPECT_EQ(zones.fraction(1), 1.0);
        zones.join(0, 1);
        zones.limit_by(1, 0.5);
        zones.close_pass();
        EXPECT_EQ(zones.motion(1), Vec3(1, 0, 0));
    }
}

} // namespace
} // namespace toile::test
