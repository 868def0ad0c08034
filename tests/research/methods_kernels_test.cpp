#include <gtest/gtest.h>

#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "core/mesh/colouring.h"
#include "research/methods/vbd/membrane_corner.h"
#include "research/methods/xpbd/strain_constraints.h"
#include "tests/garment/sheets.h"

/// Closed forms of the baseline methods.
namespace toile::test {

using namespace garment;
using namespace research;

namespace {

Mat32 random_gradient(std::mt19937& random)
{
    std::uniform_real_distribution<double> value(-1.5, 1.5);
    Mat32 F;
    for (int k = 0; k < 6; ++k)
        F(k) = value(random);
    return F;
}

TEST(ColourTriangles, GivesTrianglesWithACommonVertexDifferentColours)
{
    // At most a few more colours than triangles at a vertex.
    const auto rest = make_sheet(Vec2(1.0, 1.0), 20, 20, Pattern::Irregular).rest();
    const auto colours = colour_triangles(rest->triangles, rest->vertex_count());
    size_t items = 0;
    for (const std::vector<int>& colour : colours) {
        std::vector<int> seen(rest->vertex_count(), 0);
        for (const int t : colour)
            for (const int v : rest->triangles[t])
                EXPECT_EQ(seen[v]++, 0);
        items += colour.size();
    }
    EXPECT_EQ(items, rest->triangles.size());
    EXPECT_LE(colours.size(), 12u);
}

/// Gradient and Hessian block of corner 1 of a triangle at F + step g^T.
struct Corner {
    MembraneWeights weights{120.0, 80.0, 60.0};
    HatGradient<double> g{90.0, -40.0};
    double area = 5e-5;

    Vec3 gradient(const Mat32& F, Symmetric3<double>& hessian) const
    {
        Vec3 result = Vec3::Zero();
        add_membrane_corner<double>(F, g, area, weights, result, hessian);
        return result;
    }
    Mat3 hessian(const Mat32& F) const
    {
        Symmetric3<double> H(0.0);
        gradient(F, H);
        Mat3 full;
        full << H.xx, H.xy, H.xz, H.xy, H.yy, H.yz, H.xz, H.yz, H.zz;
        return full;
    }
    Mat3 hessian_by_differences(const Mat32& F) const
    {
        Mat3 result;
        const double step = 1e-7;
        for (int k = 0; k < 3; ++k) {
            Mat32 move = Mat32::Zero();
            move.row(k) << step * g.u, step * g.v;
            Symmetric3<double> ignored(0.0);
            result.col(k) = (gradient(F + move, ignored) - gradient(F - move, ignored)) / (2.0 * step);
        }
        return result;
    }
};

TEST(MembraneCorner, HasTheGradientOfTheMembrane)
{
    std::mt19937 random(5);
    const Corner corner;
    Mat2 rest_inv;
    rest_inv << corner.g.u, corner.g.v, -20.0, 70.0;
    for (int trial = 0; trial < 50; ++trial) {
        const Mat32 F = random_gradient(random);
        Symmetric3<double> hessian(0.0);
        const Vec3 expected =
            project_membrane<double>(F, rest_inv, corner.area, corner.weights).corner_gradient.col(0);
        EXPECT_LT((corner.gradient(F, hessian) - expected).norm(), 1e-12 * (1.0 + expected.norm()));
    }
}

TEST(MembraneCorner, HasTheHessianOfTheStretchedMembrane)
{
    Mat32 F;
    for (const double shear : {0.0, 0.2, -0.3}) {
        F << 1.3, shear, 0.1, 1.4, 0.6 * shear, 0.2;
        const Mat3 exact = Corner().hessian_by_differences(F);
        EXPECT_LT((Corner().hessian(F) - exact).norm(), 1e-6 * exact.norm());
    }
}

TEST(MembraneCorner, IsPositiveAndBoundsTheHessianOfTheCompressedMembrane)
{
    std::mt19937 random(6);
    for (int trial = 0; trial < 200; ++trial) {
        const Mat32 F = random_gradient(random);
        const Mat3 projected = Corner().hessian(F), exact = Corner().hessian_by_differences(F);
        const double size = projected.norm();
        const auto min_eigenvalue = [](const Mat3& A) {
            return Eigen::SelfAdjointEigenSolver<Mat3>(Mat3(0.5 * (A + A.transpose()))).eigenvalues()[0];
        };
        EXPECT_GT(min_eigenvalue(projected), -1e-9 * size);
        EXPECT_GT(min_eigenvalue(projected - exact), -1e-4 * size) << "clamping only adds";
    }
}

TEST(Symmetric3, SolvesWithItsInverse)
{
    Symmetric3<double> A(0.1);
    A.add_square(2.0, Vec3(1.0, -2.0, 0.5));
    A.add_square(3.0, Vec3(0.0, 1.0, 1.0));
    Mat3 full;
    full << A.xx, A.xy, A.xz, A.xy, A.yy, A.yz, A.xz, A.yz, A.zz;
    const Vec3 b(1.0, 2.0, -3.0);
    EXPECT_LT((full * A.solve(b) - b).norm(), 1e-12);
}

TEST(PrincipalDirection, IsTheFirstSingularVector)
{
    std::mt19937 random(8);
    for (int trial = 0; trial < 100; ++trial) {
        const Mat32 F = random_gradient(random);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(F, Eigen::ComputeThinU | Eigen::ComputeThinV);
        const Vec2 expected = svd.matrixV().col(0), found = principal_direction<double>(F);
        EXPECT_NEAR(std::abs(expected.dot(found)), 1.0, 1e-12);
        EXPECT_NEAR(found.norm(), 1.0, 1e-14);
    }
    EXPECT_EQ(principal_direction<double>(Mat32::Identity()), Vec2(1.0, 0.0));
}

TEST(ProjectStrains, ActsLikeTheForcesOfTheMembraneInAShortStep)
{
    // D -> -h^2 A stress: the compliances are those of Membrane's terms.
    std::mt19937 random(9);
    const MembraneWeights weights{120.0, 80.0, 60.0};
    const double area = 5e-5, h2 = 1e-10;
    Mat2 N;
    N << 3e4, 1e4, 1e4, 2e4;
    for (int trial = 0; trial < 50; ++trial) {
        const Mat32 F = random_gradient(random);
        const StrainStiffness<double> stiffness{h2 * area * weights.warp, h2 * area * weights.weft,
                                                h2 * area * weights.shear};
        const Mat32 D = project_strains<double>(F, N, stiffness) / h2;
        const Mat32 stress =
            project_membrane<double>(F, Mat2::Identity(), area, weights).corner_gradient; // A dW/dF
        EXPECT_LT((D + stress).norm(), 1e-5 * stress.norm());
    }
}

TEST(ProjectStrains, MakesAStiffTriangleAnIsometry)
{
    std::mt19937 random(10);
    const StrainStiffness<double> stiffness{0.0, 0.0, 1e12};
    Mat2 N;
    N << 3e4, 1e4, 1e4, 2e4;
    for (int trial = 0; trial < 20; ++trial) {
        // The projection moves F by D N. A few passes are needed, because N rotates it away from the
        // principal directions.
        Mat32 F = random_gradient(random);
        for (int pass = 0; pass < 30; ++pass)
            F += project_strains<double>(F, N, stiffness) * N;
        EXPECT_LT((F.transpose() * F - Mat2::Identity()).norm(), 1e-6);
    }
}

TEST(ProjectStrains, MatchesInLanesAndOneByOne)
{
    std::mt19937 random(11);
    std::vector<Mat32> F(kLanes);
    for (Mat32& gradient : F)
        gradient = random_gradient(random);
    F[3] = Mat32::Identity();
    F[5].setZero();
    Mat2 N;
    N << 3e4, 1e4, 1e4, 2e4;
    Mat32Of<Lanes> side_by_side;
    Mat2Of<Lanes> N_of_all;
    for (int k = 0; k < 6; ++k)
        side_by_side(k) = gather(0, kLanes, [&](int lane) { return F[lane](k); });
    for (int k = 0; k < 4; ++k)
        N_of_all(k) = Lanes(N(k));
    const auto all = project_strains<Lanes>(side_by_side, N_of_all, {Lanes(1e-6), Lanes(2e-6), Lanes(3e-6)});
    for (int lane = 0; lane < kLanes; ++lane) {
        const Mat32 one = project_strains<double>(F[lane], N, {1e-6, 2e-6, 3e-6});
        for (int k = 0; k < 6; ++k)
            EXPECT_NEAR(all(k)[lane], one(k), 1e-12 * (1.0 + one.norm())) << lane;
    }
}

} // namespace
} // namespace toile::test
