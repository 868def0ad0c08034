#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "garment/energy/bend_damping.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/energy/springs.h"
#include "garment/energy/strain_limit/stretch_tension.h"
#include "tests/garment/hessian_check.h"
#include "tests/garment/sheets.h"

/// True Hessians of the energies compared with differences of their gradients.
namespace toile::test {

using namespace garment;

namespace {

/// Sheet stretched by the two factors, with waves.
std::vector<Vec3> stretched(const Sheet& sheet, double warp, double weft, double height)
{
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p = Vec3(warp * p.x() + 0.1 * p.z(), height * std::sin(40 * p.x() + 9 * p.z()), weft * p.z());
    return x;
}

class MembraneHessian : public testing::Test {
protected:
    Sheet sheet_ = make_sheet(Vec2(0.2, 0.2), 4, 4, Pattern::Irregular);
    std::shared_ptr<Energy> membrane_ =
        std::make_shared<Membrane>(sheet_.rest(), Membrane::Settings{300.0, 200.0, 40.0}, "sheet");
};

TEST_F(MembraneHessian, IsTheDerivativeOfTheGradient)
{
    expect_exact(membrane_, stretched(sheet_, 1.1, 1.2, 0.004));
    expect_exact(membrane_, stretched(sheet_, 0.7, 0.8, 0.01));
}

TEST_F(MembraneHessian, ProjectsNegativeEigenvalues)
{
    const std::vector<Vec3> slack = stretched(sheet_, 0.7, 0.8, 0.01);
    EXPECT_LT(smallest_eigenvalue(dense_hessian(membrane_, slack, Definiteness::Exact)), -1.0);
    expect_semidefinite(membrane_, slack);
    expect_semidefinite(membrane_, stretched(sheet_, 0.8, 1.3, 0.01));
}

TEST_F(MembraneHessian, NeedsNoProjectionOnTautCloth)
{
    std::vector<Vec3> taut = sheet_.flat();
    for (Vec3& p : taut)
        p = 1.1 * p;
    const Eigen::MatrixXd exact = dense_hessian(membrane_, taut, Definiteness::Exact);
    const Eigen::MatrixXd projected = dense_hessian(membrane_, taut, Definiteness::Projected);
    EXPECT_LT((exact - projected).cwiseAbs().maxCoeff(), 1e-12 * exact.cwiseAbs().maxCoeff());
}

TEST_F(MembraneHessian, LiesBelowTheConstantBound)
{
    // The majoriser that makes plain local/global descend.
    Triplets entries;
    membrane_->add_hessian(entries);
    const int n = sheet_.rest()->vertex_count();
    for (const double factor : {0.6, 1.0, 1.4}) {
        Eigen::MatrixXd gap =
            -dense_hessian(membrane_, stretched(sheet_, factor, 1.0, 0.01), Definiteness::Projected);
        for (const auto& entry : entries)
            gap.block<3, 3>(3 * entry.row(), 3 * entry.col()).diagonal().array() += entry.value();
        EXPECT_GT(smallest_eigenvalue(gap), -1e-9 * gap.cwiseAbs().maxCoeff()) << factor << " of " << n;
    }
}

TEST_F(MembraneHessian, IsFiniteOnACollapsedTriangle)
{
    const std::vector<Vec3> point(sheet_.uv.size(), Vec3(1, 2, 3));
    EXPECT_TRUE(dense_hessian(membrane_, point, Definiteness::Exact).allFinite());
    expect_semidefinite(membrane_, point);
    const std::vector<Vec3> line = stretched(sheet_, 1.0, 0.0, 0.0);
    EXPECT_TRUE(dense_hessian(membrane_, line, Definiteness::Projected).allFinite());
}

TEST_F(MembraneHessian, IncludesViscosity)
{
    const auto viscous = std::make_shared<Membrane>(
        sheet_.rest(), Membrane::Settings{300.0, 200.0, 40.0, 0.01, 0.03}, "sheet");
    viscous->begin_step(stretched(sheet_, 1.0, 1.0, 0.004), 0.01);
    for (const double warp : {0.8, 1.2}) {
        const std::vector<Vec3> x = stretched(sheet_, warp, 1.1, 0.006);
        expect_exact(viscous, x);
        expect_semidefinite(viscous, x);
    }
}

TEST(BendDampingHessian, IsExactAcrossFlatClothAndSemidefiniteElsewhere)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 4, 4, Pattern::Irregular);
    const auto damping = std::make_shared<BendDamping>(
        *sheet.rest(), BendDamping::Settings{{3e-6, 2e-6}, 0.03, 12.0}, "sheet");
    damping->begin_step(sheet.flat(), 0.01);
    const Eigen::MatrixXd flat = dense_hessian(damping, sheet.flat(), Definiteness::Projected);
    const Eigen::MatrixXd exact = differences_of_gradient(*damping, sheet.flat());
    const int n = int(sheet.uv.size());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) // y is the normal
            EXPECT_NEAR(flat(3 * i + 1, 3 * j + 1), exact(3 * i + 1, 3 * j + 1), 1e-2 * flat.maxCoeff());
    expect_semidefinite(damping, stretched(sheet, 1.0, 1.0, 0.01));
    EXPECT_GT(smallest_eigenvalue(flat - exact), -1e-2 * flat.maxCoeff());
}

TEST(BendingHessian, IsTheDerivativeOfTheGradientWithAndWithoutH)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 4, 4, Pattern::Irregular);
    const auto bending = std::make_shared<Bending>(sheet.rest(), Bending::Settings{0.02, 0.01}, "sheet");
    expect_exact(bending, stretched(sheet, 1.0, 1.0, 0.01));
    bending->leave_to(std::vector<double>(sheet.uv.size(), 1e9));
    expect_exact(bending, stretched(sheet, 1.0, 1.0, 0.01));
    expect_semidefinite(bending, stretched(sheet, 1.0, 1.0, 0.01));
}

TEST(SpringsHessian, FollowsReleases)
{
    const auto springs =
        std::make_shared<Springs>(std::vector<Springs::Spring>{{0, 10.0}, {2, 20.0}, {2, 5.0}});
    const std::vector<Vec3> x{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    expect_exact(springs, x);
    springs->release(1);
    expect_exact(springs, x);
}

class TensionHessian : public testing::Test {
protected:
    Sheet sheet_ = make_sheet(Vec2(0.2, 0.2), 4, 4, Pattern::Irregular);
    std::shared_ptr<StretchTension> tension_ =
        std::make_shared<StretchTension>(sheet_.rest(), StretchTension::Settings{0.06, 250.0, 1.0});
};

TEST_F(TensionHessian, IsTheDerivativeOfTheGradient)
{
    for (const double weft : {0.9, 1.2}) { // one principal stretch beyond the limit, then both
        const std::vector<Vec3> x = stretched(sheet_, 1.15, weft, 0.004);
        tension_->begin_step(x);
        expect_exact(tension_, x);
        expect_semidefinite(tension_, x);
    }
}

TEST_F(TensionHessian, IncludesTheRememberedTension)
{
    const std::vector<Vec3> far = stretched(sheet_, 1.2, 1.0, 0.004),
                            near = stretched(sheet_, 1.03, 1.0, 0.004);
    tension_->begin_step(far);
    tension_->remember(far);
    tension_->begin_step(near);
    expect_exact(tension_, near);
}

TEST_F(TensionHessian, IsFiniteOnTrianglesPulledToALine)
{
    const std::vector<Vec3> line = stretched(sheet_, 1.3, 0.0, 0.0);
    tension_->begin_step(line);
    expect_semidefinite(tension_, line);
}

} // namespace
} // namespace toile::test
