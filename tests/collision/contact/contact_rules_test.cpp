#include "collision/contact/memory.h"
#include "collision/contact/rules.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace collision;

namespace {

constexpr double kKeep = 1e-3, kRecovery = 8e-3; // [m]

/// A vertex of one cloth that was 12 mm behind the plane of a triangle, at t0.
struct StartBehind {
    std::vector<Vec3> x{Vec3(0.0, 0.0, -0.012), Vec3(-1.0, -1.0, 0.0), Vec3(1.0, -1.0, 0.0),
                        Vec3(0.0, 2.0, 0.0)};
    std::vector<int> cloth_of{0, 1, 1, 1};
    std::vector<double> gap{kKeep, kKeep}, friction = std::vector<double>(4, 0.0),
                                           half = std::vector<double>(4, 0.5 * kKeep),
                                           diagonal = std::vector<double>(4, 100.0);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(4, 0);

    ContactTerm term_of(ContactKind kind, const PinchedTerm& pinched = {}, double clearance = 1.0) const
    {
        ContactRules rules;
        rules.cloth_of = cloth_of;
        rules.gap = gap;
        rules.cloth_friction = rules.collider_friction = friction;
        rules.thickness.half = half;
        rules.x = x;
        rules.diagonal = diagonal;
        rules.fixed = fixed;
        rules.stiffness = 2.0;
        rules.max_recovery = kRecovery;
        ContactPair pair;
        pair.kind = kind;
        pair.collider = 0;
        pair.normal = Vec3::UnitZ();
        pair.vertex = {0, -1, -1, -1};
        pair.weight = {1.0, 0.0, 0.0, 0.0};
        if (pair.is_between_cloths()) {
            pair.vertex = {0, 1, 2, 3};
            pair.weight = {1.0, -1.0 / 3.0, -1.0 / 3.0, -1.0 / 3.0};
        }
        return rules.term_of(pair, clearance, pinched);
    }
};

TEST(ContactRules, ClothInsideABodyComesOutAtTheRecoverySpeed)
{
    for (const ContactKind kind : {ContactKind::kVertexFace, ContactKind::kGuard})
        EXPECT_DOUBLE_EQ(StartBehind().term_of(kind).offset, -0.012 + kRecovery);
}

TEST(ContactRules, ClothPressesClothThoughItsPlaneLeavesTheStartBehind)
{
    const ContactTerm cloth = StartBehind().term_of(ContactKind::kClothVertexFace);
    EXPECT_DOUBLE_EQ(cloth.offset, kKeep);
    EXPECT_DOUBLE_EQ(cloth.min_gap, kMinGap * kKeep);
}

TEST(ContactRules, ClothGoesNoDeeperIntoAShapeUnlessAnotherSqueezesIt)
{
    EXPECT_DOUBLE_EQ(StartBehind().term_of(ContactKind::kVertexShape).min_gap, -0.012);
    EXPECT_FALSE(StartBehind().term_of(ContactKind::kVertexShape, {}, -1e-3).has_min_gap());
    ContactTerm squeezed = StartBehind().term_of(ContactKind::kVertexShape, {}, -1e-3);
    ContactRecord record = ContactRecord::of(squeezed.pair);
    record.normal = squeezed.pair.normal;
    record.multiplier.shift = 1e-3; // from before it was squeezed
    WarmStart{squeezed}.consider(record);
    EXPECT_EQ(squeezed.spring.shift, 0.0);
    StartBehind above;
    above.x[0].z() = 0.01;
    EXPECT_DOUBLE_EQ(above.term_of(ContactKind::kVertexShape).min_gap, kMinGap * kKeep);
    EXPECT_FALSE(above.term_of(ContactKind::kVertexFace).has_min_gap());
}

TEST(ContactRules, ClothThatABodyPassesThroughComesOutSlowly)
{
    const PinchedTerm caught{0.0, 0.1};
    EXPECT_DOUBLE_EQ(StartBehind().term_of(ContactKind::kGuard, caught).offset, -0.012 + 0.1 * kRecovery);
}

} // namespace
} // namespace toile::test
