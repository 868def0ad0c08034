#include "collision/cloth/impact_zones.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using Hold = ImpactZones::Hold;

/// Where a zone of all vertices goes.
Vec3 common_of(const std::vector<Vec3>& ways, const std::vector<Hold>& hold, double slow = 0.0)
{
    ImpactZones zones;
    zones.reset(ways, hold, slow);
    for (int v = 1; v < int(ways.size()); ++v)
        zones.join(v - 1, v);
    return zones.common(0);
}

TEST(ImpactZones, KeepMomentumWhereNothingHolds)
{
    EXPECT_EQ(common_of({Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 3)}, std::vector<Hold>(3, Hold::kNone)),
              Vec3(1, 1, 1));
}

TEST(ImpactZones, GoWhereClothOnABodyGoes)
{
    const std::vector<Vec3> ways{Vec3(0, -9, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)};
    EXPECT_EQ(common_of(ways, {Hold::kNone, Hold::kLeans, Hold::kLeans}), Vec3(2, 0, 0));
}

TEST(ImpactZones, GoWhereTheSlowestHeldVertexGoes)
{
    const std::vector<Vec3> ways{Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 2, 0)};
    EXPECT_EQ(common_of(ways, {Hold::kLeans, Hold::kIsHeld, Hold::kIsHeld}), Vec3(0, 2, 0));
    EXPECT_EQ(common_of(ways, {Hold::kIsHeld, Hold::kIsHeld, Hold::kNone}), Vec3(0, 0, 0));
}

TEST(ImpactZones, StayWhereTheyWouldOnlyCreep)
{
    const std::vector<Vec3> ways{Vec3(0.001, 0, 0), Vec3(0.003, 0, 0)};
    EXPECT_EQ(common_of(ways, std::vector<Hold>(2, Hold::kNone), 0.0019), Vec3(0.002, 0, 0));
    EXPECT_EQ(common_of(ways, std::vector<Hold>(2, Hold::kNone), 0.0021), Vec3(0, 0, 0));
}

TEST(ImpactZones, LeaveOthersAloneAndShortenByShares)
{
    const std::vector<Vec3> ways{Vec3(2, 0, 0), Vec3(0, 0, 0), Vec3(0, 7, 0)};
    ImpactZones zones;
    zones.reset(ways, std::vector<Hold>(3, Hold::kNone), 0.0);
    zones.join(0, 1);
    zones.bring_back(0, 0.5);
    zones.bring_back(0, 0.75); // the least counts
    EXPECT_EQ(zones.motion(0), ways[0]);
    zones.close_round();
    EXPECT_EQ(zones.motion(0), Vec3(1.5, 0, 0)); // 1 + half of 2 - 1
    EXPECT_EQ(zones.motion(1), ways[1]);
    EXPECT_EQ(zones.motion(2), ways[2]);
    zones.bring_back(0, 0.5);
    zones.close_round();
    EXPECT_EQ(zones.share(0), 0.25);
}

TEST(ImpactZones, GrowByVerticesWithoutTurningUntilTheySettle)
{
    const std::vector<Vec3> ways{Vec3(4, 0, 0), Vec3(0, 0, 0), Vec3(0, 9, 0), Vec3(0, 0, 5)};
    ImpactZones zones;
    zones.reset(ways, std::vector<Hold>{Hold::kNone, Hold::kNone, Hold::kNone, Hold::kLeans}, 0.0);
    zones.join(0, 1);
    zones.attach(2, 0);
    zones.bring_back_to(1, 0.0);
    zones.close_round();
    EXPECT_EQ(zones.common(2), Vec3(2, 0, 0));
    EXPECT_TRUE(zones.settle());
    EXPECT_FALSE(zones.settle());
    EXPECT_EQ(zones.close_round().size(), 3);
    EXPECT_EQ(zones.motion(1), Vec3(4.0 / 3.0, 3, 0));

    // Who holds more leads at once.
    zones.attach(3, 0);
    EXPECT_TRUE(zones.leans(0));
    EXPECT_EQ(zones.common(0), ways[3]);
    EXPECT_FALSE(zones.settle());
}

TEST(ImpactZones, ForgetWhatWasJoined)
{
    const std::vector<Vec3> ways{Vec3(4, 0, 0), Vec3(0, 0, 0)};
    ImpactZones zones;
    for (int time = 0; time < 2; ++time) {
        zones.reset(ways, std::vector<Hold>(2, Hold::kNone), 0.0);
        EXPECT_EQ(zones.common(0), ways[0]);
        EXPECT_EQ(zones.share(1), 1.0);
        zones.join(0, 1);
        zones.bring_back(1, 0.5);
        zones.close_round();
        EXPECT_EQ(zones.motion(1), Vec3(1, 0, 0));
    }
}

} // namespace
} // namespace toile
