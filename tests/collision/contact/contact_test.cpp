#include "collision/contact/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/body/collider_pairs.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kGap = 0.002; // [m]

/// One cloth with the gap kGap to one collider.
ContactCloth one_cloth(int vertex_count)
{
    ContactCloth cloth;
    cloth.vertex_count = vertex_count;
    cloth.gap = kGap;
    cloth.collider_friction = {0.3};
    cloth.cloth_friction = {0.3};
    return cloth;
}

/// Three terms on five vertices: a pressing vertex that slides, a face that sticks, a separated edge.
ContactEnergy sample_energy()
{
    std::vector<ContactTerm> terms(3);
    terms[0].pair.vertex = contact_vertices(0);
    terms[0].pair.weight = {1.0, 0.0, 0.0};
    terms[0].pair.normal = Vec3(1, 2, 2) / 3.0;
    terms[0].pair.point = Vec3(0.01, 0.0, 0.02);
    terms[0].friction = 0.4;
    terms[0].normal_force = 2.0;
    terms[1].pair.vertex = contact_vertices(1, 2, 3);
    terms[1].pair.weight = {0.5, 0.3, 0.2};
    terms[1].pair.point = Vec3(0.0, 0.03, 0.0);
    terms[1].friction = 0.5;
    terms[1].normal_force = 1e3;
    terms[2].pair.vertex = contact_vertices(3, 4);
    terms[2].pair.weight = {0.25, 0.75, 0.0};
    terms[2].pair.point = Vec3(0.0, -1.0, 0.0);
    for (ContactTerm& term : terms) {
        term.offset = 0.002;
        term.spring.stiffness = 500.0;
    }
    terms[1].spring.ramp = 0.05;
    ContactEnergy energy;
    energy.set_terms(terms, 5);
    return energy;
}

std::vector<Vec3> sample_positions()
{
    return {Vec3(-0.02, 0.01, -0.01), Vec3(0.01, 0.02, 0.0), Vec3(0.0, 0.01, 0.02), Vec3(-0.01, 0.0, 0.01),
            Vec3(0.02, 0.01, 0.01)};
}

TEST(ContactEnergy, HasTheGradientOfItsValue)
{
    const ContactEnergy energy = sample_energy();
    std::vector<Vec3> x = sample_positions(), gradient(5, Vec3::Zero()), ignored(5, Vec3::Zero());
    energy.add_gradient(x, gradient);
    const double step = 1e-6;
    for (int v = 0; v < 5; ++v)
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec3> up = x, down = x;
            up[v][k] += step;
            down[v][k] -= step;
            const double slope =
                (energy.add_gradient(up, ignored) - energy.add_gradient(down, ignored)) / (2.0 * step);
            EXPECT_NEAR(gradient[v][k], slope, 1e-5 * (1.0 + std::abs(slope)))
                << "vertex " << v << " axis " << k;
        }
    EXPECT_GT(gradient[0].norm(), 1.0); // pressed
    EXPECT_EQ(gradient[4].norm(), 0.0); // far away
}

TEST(ContactEnergy, LimitsFrictionToCoulombsDisc)
{
    const ContactEnergy energy = sample_energy();
    std::vector<Vec3> x = sample_positions(), gradient(5, Vec3::Zero());
    energy.add_gradient(x, gradient);
    const Vec3 n = energy.terms()[0].pair.normal;
    const Vec3 tangential = gradient[0] - n.dot(gradient[0]) * n;
    EXPECT_NEAR(tangential.norm(), 0.4 * 2.0, 1e-12); // slides: 500 N/m times its slip is far above mu f
}

TEST(ContactEnergy, IsBoundedByItsDiagonalBlocks)
{
    ContactEnergy energy = sample_energy();
    EXPECT_TRUE(energy.activate(sample_positions()));
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Vec3> p(5), product(5, Vec3::Zero());
        for (int v = 0; v < 5; ++v)
            p[v] =
                Vec3(std::sin(3.1 * trial + v), std::cos(1.7 * trial * v + 1), std::sin(trial + 2.3 * v * v));
        energy.add_hessian_product(p, product);
        double exact = 0.0, bound = 0.0;
        for (int v = 0; v < 5; ++v) {
            exact += p[v].dot(product[v]);
            bound += p[v].dot(energy.diagonal_blocks()[v] * p[v]);
        }
        EXPECT_GE(exact, -1e-12);
        EXPECT_LE(exact, bound * (1.0 + 1e-12));
    }
}

TEST(Contact, DoesNotAccelerateAVertexOfSmallWeight)
{
    // A tip crosses the cloth beside its fixed edge: only the far, free vertex could move.
    MovingMesh tip;
    tip.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    tip.x_t0 = {Vec3(0.05, 0.001, 0.0002), Vec3(0.07, -0.03, 0.0), Vec3(0.04, -0.03, -0.02),
                Vec3(0.04, -0.03, 0.02)};
    tip.x_t1 = tip.x_t0;
    const MeshCollider collider(tip);

    const std::vector<Triangle> triangles{{0, 2, 1}};
    const std::vector<Vec3> start{Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0.05, 0, 0.1)};
    Contact contact(triangles, start, {one_cloth(3)}, {{&collider, nullptr}}, Contact::Settings{});
    const std::vector<double> diagonal(3, 100.0), masses(3, 1e-3);
    const std::vector<unsigned char> fixed{1, 1, 0};
    contact.begin_step({start, start, diagonal, fixed, masses, 1.0 / 120.0});
    ASSERT_FALSE(contact.energy().terms().empty());
    std::vector<Vec3> x = start;
    contact.make_feasible(x);
    EXPECT_LT((x[2] - start[2]).norm(), 0.01);
}

/// One vertex of a small cloth above a plate that rises.
struct RisingPlate {
    static constexpr double kDt = 0.01;
    double rise; ///< [m] in the step

    ShapeCollider plate{PlaneShape{}, Eigen::Isometry3d::Identity(), "plate"};
    std::vector<Triangle> triangles{{0, 1, 2}};
    std::vector<Vec3> start{Vec3(0.0, 0.005, 0.0), Vec3(0.1, 0.5, 0.0), Vec3(0.0, 0.5, 0.1)};
    std::vector<double> diagonal = std::vector<double>(3, 100.0);
    std::vector<double> masses = std::vector<double>(3, 1e-3);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(3, 0);
    Contact::Settings settings;
    Contact contact{triangles, start, {one_cloth(3)}, {{nullptr, &plate}}, settings};

    explicit RisingPlate(double height = 0.02) : rise(height)
    {
        plate.move(Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(0.0, rise, 0.0)));
        contact.begin_step({start, start, diagonal, fixed, masses, kDt});
    }

    /// Positions displaced by 2 cm along the plate, pressing.
    std::vector<Vec3> slid() const
    {
        std::vector<Vec3> x = start;
        x[0] = Vec3(0.02, rise + 0.5 * kGap, 0.0);
        return x;
    }
};

TEST(Contact, ClearsResidualPenetrationWithoutAddingVelocity)
{
    RisingPlate scene;
    std::vector<Vec3> x = scene.start; // the plate has passed it
    std::vector<Vec3> v(3, Vec3(1.0, -3.0, 0.0));
    scene.contact.clear(x, v);
    EXPECT_NEAR(x[0].y(), scene.rise + kGap, 1e-12);
    EXPECT_NEAR(v[0].y(), scene.rise / RisingPlate::kDt,
                1e-9); // the velocity of the plate, not of the correction
    EXPECT_EQ(v[0].x(), 1.0);
    EXPECT_EQ(x[1], scene.start[1]);
    EXPECT_EQ(v[1], Vec3(1.0, -3.0, 0.0));
}

TEST(Contact, LeavesVerticesCloseToTheirGapUnchanged)
{
    RisingPlate scene(0.004);
    std::vector<Vec3> x = scene.start;
    x[0].y() = scene.rise + kGap - 5e-5;
    const std::vector<Vec3> end = x;
    std::vector<Vec3> v(3, Vec3(0.0, -3.0, 0.0));
    scene.contact.clear(x, v);
    EXPECT_EQ(x, end);
    EXPECT_EQ(v[0].y(), -3.0);
}

TEST(Contact, LimitsTheClearingOfASliverByItsAltitude)
{
    // Its altitude is 0.1 mm: five sweeps move no vertex by more than a quarter of a millimetre.
    const ShapeCollider plate(PlaneShape{}, Eigen::Isometry3d::Identity(), "plate");
    const std::vector<Triangle> triangles{{0, 1, 2}};
    const std::vector<Vec3> start{Vec3(0.0, -0.01, 0.0), Vec3(0.1, 0.5, 0.0), Vec3(0.05, 0.245, 1e-4)};
    const std::vector<double> diagonal(3, 100.0), masses(3, 1e-3);
    const std::vector<unsigned char> fixed(3, 0);
    Contact contact(triangles, start, {one_cloth(3)}, {{nullptr, &plate}}, Contact::Settings{});
    contact.begin_step({start, start, diagonal, fixed, masses, 0.1});
    std::vector<Vec3> x = start, v(3, Vec3::Zero());
    contact.clear(x, v);
    EXPECT_GT(x[0].y(), start[0].y());
    EXPECT_LE(x[0].y(), start[0].y() + 2.6e-4);
}

TEST(Contact, FollowsTheStartPointOnARotatingShape)
{
    const Eigen::Isometry3d quarter(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitY()));
    ShapeCollider box(BoxShape{Vec3::Constant(0.1)}, Eigen::Isometry3d::Identity(), "box");
    box.move(Eigen::Isometry3d::Identity(), quarter);
    const Vec3 point(0.1, 0.1, 0.0);
    NearestSurface started;
    started.point = point;
    const Vec3 motion = advecting_collider({nullptr, &box}).motion_of(started);
    EXPECT_LT((motion - (quarter * point - point)).norm(), 1e-15);
    EXPECT_LT((box.motion(quarter * point) - motion).norm(), 1e-15);
}

TEST(Contact, KeepsTheAnchorOfTheStartWhenPairsAreUpdated)
{
    RisingPlate scene;
    std::vector<Vec3> x = scene.slid();
    ASSERT_TRUE(scene.contact.revise(x, MinimiserProgress::kConverged));
    ASSERT_EQ(scene.contact.energy().terms().size(), 1u);
    const ContactTerm& term = scene.contact.energy().terms()[0];
    EXPECT_GT(term.normal_force, 0.0);
    EXPECT_EQ(term.anchor.x(), 0.0);
}

TEST(Contact, IsNotMinimisedForOtherPairsAloneOnceItHasSettled)
{
    RisingPlate scene;
    std::vector<Vec3> x = scene.slid();
    ASSERT_TRUE(scene.contact.revise(x, MinimiserProgress::kSettled)); // friction has landed
    x[0].x() += 0.02;
    ASSERT_TRUE(scene.contact.revise(x, MinimiserProgress::kConverged));
    x[0].x() += 0.02;
    EXPECT_FALSE(scene.contact.revise(x, MinimiserProgress::kSettled));
}

TEST(Contact, IgnoresTruncatedForcesInFrictionButWarmStartsWithThem)
{
    RisingPlate scene;
    std::vector<Vec3> x = scene.slid();
    ASSERT_TRUE(scene.contact.revise(x, MinimiserProgress::kNear));
    ASSERT_EQ(scene.contact.energy().terms().size(), 1u);
    EXPECT_EQ(scene.contact.energy().terms()[0].normal_force, 0.0);

    scene.contact.end_step(x);
    const Eigen::Isometry3d risen(Eigen::Translation3d(0.0, scene.rise, 0.0));
    scene.plate.move(risen, risen);
    scene.contact.begin_step({x, x, scene.diagonal, scene.fixed, scene.masses, RisingPlate::kDt});
    ASSERT_EQ(scene.contact.energy().terms().size(), 1u);
    EXPECT_GT(scene.contact.energy().terms()[0].normal_force, 0.0);
}

/// Pairs are found again within the step, which remembers their forces: of a step that is not taken, nothing.
TEST(Contact, RemembersNothingOfAnAbandonedStep)
{
    for (const bool is_abandoned : {false, true}) {
        RisingPlate scene;
        std::vector<Vec3> x = scene.slid();
        ASSERT_TRUE(scene.contact.revise(x, MinimiserProgress::kConverged));
        ASSERT_GT(scene.contact.energy().terms()[0].normal_force, 0.0);
        if (is_abandoned)
            scene.contact.abandon_step();
        scene.contact.begin_step(
            {scene.start, scene.start, scene.diagonal, scene.fixed, scene.masses, 0.5 * RisingPlate::kDt});
        ASSERT_EQ(scene.contact.energy().terms().size(), 1u);
        EXPECT_EQ(scene.contact.energy().terms()[0].normal_force > 0.0, !is_abandoned);
    }
}

TEST(Contact, KeepsTheEquilibriumDepthOfAPair)
{
    RisingPlate scene;
    const double depth = 6e-5; // [m]
    std::vector<Vec3> x = scene.start, v(3, Vec3::Zero());
    x[0] = Vec3(0.003, scene.rise + kGap - depth, 0.0); // slid beyond the threshold of a new query
    scene.contact.revise(x, MinimiserProgress::kConverged);
    scene.contact.clear(x, v);
    EXPECT_NEAR(x[0].y(), scene.rise + kGap - depth, 1e-12);
}

} // namespace
} // namespace toile::test
