#include "garment/energy/fold/fold_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "garment/energy/bending.h"
#include "tests/garment/fold/hinges.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStiffness = 0.2; // [N]

std::vector<Vec3> corners_of(const HingeCorners& x) { return {x.v0, x.v1, x.a, x.b}; }

/// Two triangles over one edge.
struct HingedPair {
    std::vector<Triangle> triangles{{0, 1, 2}, {1, 0, 3}};
    std::shared_ptr<const RestShape> rest;
    int edge = 0;

    explicit HingedPair(const HingeCorners& flat)
        : rest(std::make_shared<const RestShape>(
              rest_shape_of_surface({corners_of(flat), triangles}, Vec3::UnitY(), 0.0, "pair")))
    {
        while (rest->topology.edges[edge].is_border())
            ++edge;
    }

    /// Energy that starts at an angle.
    std::shared_ptr<FoldLines> fold(double rest_angle, double start) const
    {
        return std::make_shared<FoldLines>(*rest, std::vector<FoldEdge>{{edge, rest_angle, kStiffness}},
                                           corners_of(hinge_at(start)), "pair");
    }
};

const HingedPair kPair(hinge_at(0.0));

std::vector<double> all_angles()
{
    std::vector<double> result;
    for (int k = -35; k <= 35; ++k)
        result.push_back(k * kPi / 36.0);
    result.insert(result.end(), {kPi - 2e-3, 2e-3 - kPi});
    return result;
}

} // namespace

TEST(FoldLines, CostHalfTheSquareOfTheirOpening)
{
    for (const double rest : {-kPi, -1.0, 0.0, 2.5, kPi})
        for (const double angle : all_angles()) {
            const double opening = angle - rest;
            EXPECT_NEAR(value_of(*kPair.fold(rest, angle), corners_of(hinge_at(angle))),
                        0.5 * kStiffness * 0.02 * opening * opening, 1e-12);
        }
}

TEST(FoldLines, HaveTheGradientOfTheirValueOverTheWholeRange)
{
    for (const double angle : all_angles())
        expect_gradient_of_value(*kPair.fold(2.0, angle), corners_of(hinge_at(angle)));
}

TEST(FoldLines, HaveTheHessianOfTheirGradientOverTheWholeRange)
{
    for (const double angle : all_angles()) {
        expect_exact(kPair.fold(-2.9, angle), corners_of(hinge_at(angle)));
        expect_semidefinite(kPair.fold(-2.9, angle), corners_of(hinge_at(angle)));
    }
}

TEST(FoldLines, HaveOneHessianWhereTheyRest)
{
    const std::vector<Vec3> x = corners_of(hinge_at(2.0));
    const Eigen::MatrixXd exact = dense_hessian(kPair.fold(2.0, 2.0), x, Definiteness::Exact);
    EXPECT_LT((exact - dense_hessian(kPair.fold(2.0, 2.0), x, Definiteness::Projected)).norm(),
              1e-12 * exact.norm());
    const Eigen::MatrixXd open = dense_hessian(kPair.fold(-1.0, 2.0), x, Definiteness::Exact);
    EXPECT_LT(smallest_eigenvalue(open), -0.1 * open.norm()) << "away from rest it is indefinite";
}

TEST(FoldLines, ExertNeitherForceNorTorque)
{
    const Vec3 about(0.3, -0.2, 0.9);
    for (const double angle : all_angles()) {
        const std::vector<Vec3> x = corners_of(hinge_at(angle));
        std::vector<Vec3> gradient(4, Vec3::Zero());
        kPair.fold(2.0, angle)->add_gradient(x, gradient);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (int v = 0; v < 4; ++v) {
            force += gradient[v];
            torque += (x[v] - about).cross(gradient[v]);
        }
        EXPECT_LT(force.norm(), 1e-13);
        EXPECT_LT(torque.norm(), 1e-13);
    }
}

TEST(FoldLines, CostNothingMoreWhenTheyAreMoved)
{
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(1.7, Vec3(0.6, 0.1, -0.8).normalized()).toRotationMatrix();
    for (const double angle : all_angles()) {
        std::vector<Vec3> x = corners_of(hinge_at(angle));
        const double before = value_of(*kPair.fold(-1.0, angle), x);
        for (Vec3& p : x)
            p = Q * p + Vec3(1.0, 2.0, -0.5);
        EXPECT_NEAR(value_of(*kPair.fold(-1.0, angle), x), before, 1e-12 * (1.0 + before));
    }
}

/// Step by step through half a turn: the moment goes on where it was, and back.
TEST(FoldLines, GoOnBeyondHalfATurn)
{
    const auto fold = kPair.fold(kPi, 2.9);
    double angle = 2.9;
    for (const double end : {3.5, 2.8, -1.0})
        for (const double step = end > angle ? 0.1 : -0.1; (end - angle) * step > 0.0; angle += step) {
            fold->begin_step(corners_of(hinge_at(angle)));
            EXPECT_NEAR(fold->start_angle(0), angle, 1e-12);
            EXPECT_NEAR(value_of(*fold, corners_of(hinge_at(angle))),
                        0.5 * kStiffness * 0.02 * (angle - kPi) * (angle - kPi), 1e-12);
        }
    fold->restart(corners_of(hinge_at(3.5)));
    EXPECT_NEAR(fold->start_angle(0), 3.5 - 2.0 * kPi, 1e-12);
}

/// Nothing tells on which side an edge is folded flat but the fold.
TEST(FoldLines, StartFoldedFlatOnTheirSide)
{
    for (const double rest : {-kPi, kPi})
        for (const double angle : {1e-5 - kPi, kPi - 1e-5})
            EXPECT_NEAR(kPair.fold(rest, angle)->start_angle(0), rest, 2e-5);
}

TEST(FoldLines, LieBelowTheConstantBound)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int k = 0; k < 300; ++k) {
        // Shapes from obtuse to flat, folded without strain.
        const double length = 0.02, a = 0.005 + 0.03 * unit(random), b = 0.005 + 0.03 * unit(random);
        const double along_a = length * (1.4 * unit(random) - 0.2),
                     along_b = length * (1.4 * unit(random) - 0.2);
        const auto at = [&](double angle) {
            return HingeCorners{Vec3::Zero(), length * Vec3::UnitY(),
                                Vec3(-a * std::cos(angle), along_a, a * std::sin(angle)),
                                Vec3(b, along_b, 0.0)};
        };
        const HingedPair pair(at(0.0));
        const double rest = kPi * (2.0 * unit(random) - 1.0), angle = kPi * (2.0 * unit(random) - 1.0);
        const std::vector<Vec3> x = corners_of(at(angle));
        const auto fold = std::make_shared<FoldLines>(
            *pair.rest, std::vector<FoldEdge>{{pair.edge, rest, kStiffness}}, x, "pair");
        Triplets entries;
        fold->add_hessian(entries);
        Eigen::MatrixXd gap = -dense_hessian(fold, x, Definiteness::Exact);
        for (const auto& entry : entries)
            gap.block<3, 3>(3 * entry.row(), 3 * entry.col()).diagonal().array() += entry.value();
        EXPECT_GT(smallest_eigenvalue(gap), -1e-12 * gap.norm());
    }
}

TEST(FoldLines, RefuseWhatIsNoFold)
{
    const auto refusal_of = [&](const FoldEdge& fold) {
        try {
            FoldLines(*kPair.rest, {fold}, corners_of(hinge_at(0.0)), "pair");
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const int border = kPair.edge == 0 ? 1 : 0;
    EXPECT_EQ(refusal_of({border, 1.0, 0.1}), "pair: fold of edge " + std::to_string(border) +
                                                  ": it is at the border; a fold lies between two triangles");
    EXPECT_EQ(refusal_of({5, 1.0, 0.1}), "pair: fold of edge 5: there are 5 edges");
    EXPECT_NE(refusal_of({kPair.edge, 3.2, 0.1}).find("angle = 3.2"), std::string::npos);
    EXPECT_NE(refusal_of({kPair.edge, 1.0, 0.0}).find("stiffness = 0.0"), std::string::npos);
    EXPECT_EQ(refusal_of({kPair.edge, -kPi, 0.1}), "accepted");
}

/// Inner edges of a sheet between two columns of vertices.
static std::vector<int> edges_between(const Sheet& sheet, int column)
{
    std::vector<int> edges;
    const auto rest = sheet.rest();
    for (int e = 0; e < int(rest->topology.edges.size()); ++e) {
        const auto [a, b] = rest->topology.edges[e].vertex;
        if (!rest->topology.edges[e].is_border() && a % (sheet.columns + 1) == column &&
            b % (sheet.columns + 1) == column)
            edges.push_back(e);
    }
    return edges;
}

/// A sheet of which one half is folded over, both halves flat.
TEST(BendingHinges, ResistNoFoldBetweenFlatHalves)
{
    const Sheet sheet = make_sheet(Vec2(0.16, 0.08), 8, 4);
    const Bending::Settings rigidity{1e-3, 2e-3};
    const std::vector<int> hinges = edges_between(sheet, 4);
    ASSERT_EQ(hinges.size(), 4u);
    Bending hinged(sheet.rest(), rigidity, "sheet", hinges), whole(sheet.rest(), rigidity, "sheet");
    for (const double angle : {0.3, 1.5, 3.0}) {
        std::vector<Vec3> x = sheet.flat();
        for (Vec3& p : x)
            if (p.x() > 0.08)
                p = Vec3(0.08 + (p.x() - 0.08) * std::cos(angle), (p.x() - 0.08) * std::sin(angle), p.z());
        EXPECT_LT(value_of(hinged, x), 1e-9 * value_of(whole, x));
        EXPECT_GT(value_of(whole, x), 1e-6);
    }
}

/// Halves bend as sheets of their own do.
TEST(BendingHinges, AreBordersOfBothHalves)
{
    const Sheet sheet = make_sheet(Vec2(0.16, 0.08), 8, 4), half = make_sheet(Vec2(0.08, 0.08), 4, 4);
    const Bending::Settings rigidity{1e-3, 2e-3};
    Bending hinged(sheet.rest(), rigidity, "sheet", edges_between(sheet, 4)),
        alone(half.rest(), rigidity, "half");
    const auto bent = [](std::vector<Vec3> x) {
        for (Vec3& p : x)
            p.y() = p.x() < 0.08 ? 3.0 * p.x() * p.x() + 2.0 * p.x() * p.z() : 0.0192 + 0.16 * p.z();
        return x;
    };
    std::vector<Vec3> x = bent(sheet.flat());
    EXPECT_NEAR(value_of(hinged, x), value_of(alone, bent(half.flat())), 1e-3 * value_of(hinged, x));
}

} // namespace toile::test
