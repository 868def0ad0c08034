#include <gtest/gtest.h>

#include <random>

#include <Eigen/LU>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"
#include "tests/volume/blocks.h"
#include "volume/energy/elastic_solid.h"

namespace toile::test {

using namespace volume;

namespace {

const ElasticMaterial kMaterial{1e4, 0.3};

std::shared_ptr<ElasticSolid> make_solid(const Block& block, const ElasticMaterial& material)
{
    return std::make_shared<ElasticSolid>(std::make_shared<RestTets>(rest_tets(block.mesh, "block")),
                                          std::vector<Lame>(block.mesh.tets.size(), material.lame("block")));
}

std::vector<Vec3> shaken(std::vector<Vec3> x, double size, unsigned seed = 1)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, size);
    for (Vec3& point : x)
        point += Vec3(normal(random), normal(random), normal(random));
    return x;
}

std::vector<Vec3> mapped(const std::vector<Vec3>& x, const Mat3& F)
{
    std::vector<Vec3> result;
    for (const Vec3& point : x)
        result.push_back(F * point);
    return result;
}

TEST(ElasticSolid, HasTheGradientAndHessianOfItsEnergy)
{
    const Block block = make_block({1.0, 1.0, 1.0}, {2, 2, 1});
    for (const double poisson : {0.0, 0.3, 0.49}) {
        const auto solid = make_solid(block, {1e4, poisson});
        for (const double size : {1e-3, 0.05}) {
            const std::vector<Vec3> x = shaken(block.mesh.positions, size);
            expect_gradient_of_value(*solid, x);
            expect_exact(solid, x);
        }
    }
}

TEST(ElasticSolid, HasAProjectedHessianWithoutNegativeCurvature)
{
    const Block block = make_block({1.0, 1.0, 1.0}, {2, 1, 1});
    const auto solid = make_solid(block, {1e4, 0.45});
    for (const unsigned seed : {1U, 2U, 3U})
        for (const double size : {0.05, 0.3, 1.0, 10.0}) // from 0.3 on, tetrahedra are inside out
            expect_semidefinite(solid, shaken(block.mesh.positions, size, seed));
    expect_semidefinite(solid, mapped(block.mesh.positions, 0.5 * Mat3::Identity()));
    expect_semidefinite(solid, std::vector<Vec3>(block.mesh.positions.size(), Vec3(1.0, 2.0, 3.0)));
}

TEST(ElasticSolid, ProjectsOnlyNegativeCurvature)
{
    // Stretched material has none.
    const Block block = make_block({1.0, 1.0, 1.0}, {1, 1, 1});
    const auto solid = make_solid(block, {1e4, 0.0});
    const std::vector<Vec3> x =
        shaken(mapped(block.mesh.positions, Vec3(1.3, 1.2, 1.1).asDiagonal().toDenseMatrix()), 0.01);
    const Eigen::MatrixXd exact = dense_hessian(solid, x, Definiteness::Exact);
    const Eigen::MatrixXd projected = dense_hessian(solid, x, Definiteness::Projected);
    EXPECT_LT((exact - projected).norm(), 1e-12 * exact.norm());
}

TEST(ElasticSolid, CostsNothingInRigidMotion)
{
    const Block block = make_block({1.0, 0.5, 0.2}, {3, 2, 2}, 0.2);
    const auto solid = make_solid(block, kMaterial);
    const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    std::vector<Vec3> x = mapped(block.mesh.positions, R);
    for (Vec3& point : x)
        point += Vec3(10.0, -20.0, 30.0);
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    EXPECT_LT(solid->add_gradient(x, gradient), 1e-20);
    for (const Vec3& force : gradient)
        EXPECT_LT(force.norm(), 1e-9);
}

TEST(ElasticSolid, HasNoNetForceOrMoment)
{
    const Block block = make_block({1.0, 0.5, 0.2}, {3, 2, 2}, 0.2);
    const auto solid = make_solid(block, kMaterial);
    const std::vector<Vec3> x = shaken(block.mesh.positions, 0.1);
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    solid->add_gradient(x, gradient);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (size_t v = 0; v < x.size(); ++v) {
        force += gradient[v];
        moment += x[v].cross(gradient[v]);
    }
    EXPECT_LT(force.norm(), 1e-9);
    EXPECT_LT(moment.norm(), 1e-9);
}

TEST(ElasticSolid, HasTheSameBitsForEveryThreadCount)
{
    const Block block = make_block({1.0, 0.5, 0.2}, {13, 7, 5}, 0.2);
    const std::vector<Vec3> x = shaken(block.mesh.positions, 0.02);
    const auto solid = make_solid(block, kMaterial);
    std::vector<std::vector<Vec3>> gradients;
    std::vector<double> energies;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        gradients.emplace_back(x.size(), Vec3::Zero());
        energies.push_back(solid->add_gradient(x, gradients.back()));
    }
    for (int k = 1; k < 3; ++k) {
        EXPECT_EQ(energies[0], energies[k]);
        EXPECT_EQ(gradients[0], gradients[k]);
    }
}

/// Patch test: the forces of a uniform strain of an irregular block. Inside there are none.
struct Patch {
    Block block = make_block({1.0, 1.0, 1.0}, {4, 3, 3}, 0.2);
    std::vector<Vec3> force; ///< [vertices] that holds the strain [N]

    Patch(const ElasticMaterial& material, const Mat3& strain)
    {
        const std::vector<Vec3> x = mapped(block.mesh.positions, Mat3::Identity() + strain);
        force.assign(x.size(), Vec3::Zero());
        make_solid(block, material)->add_gradient(x, force);
        for (int v = 0; v < int(x.size()); ++v)
            if (!block.is_on_surface(v)) {
                EXPECT_LT(force[v].norm(), 1e-9 * material.young * strain.norm());
            }
    }

    /// Mean stress [Pa]: sum of f X^T over the volume.
    Mat3 stress() const
    {
        Mat3 sum = Mat3::Zero();
        for (size_t v = 0; v < force.size(); ++v)
            sum += force[v] * block.mesh.positions[v].transpose();
        return sum;
    }
};

constexpr double kSmall = 1e-5; // strain

TEST(PatchTest, OfAUniformStretchHasYoungsModulusAndPoissonsRatio)
{
    for (const double poisson : {0.0, 0.3, 0.45, 0.49}) {
        const double young = 2e5;
        const Vec3 strain(kSmall, -poisson * kSmall, -poisson * kSmall);
        const Mat3 stress = Patch({young, poisson}, strain.asDiagonal()).stress();
        EXPECT_NEAR(stress(0, 0) / (young * kSmall), 1.0, 1e-3) << "nu = " << poisson;
        EXPECT_LT(std::abs(stress(1, 1)), 1e-3 * young * kSmall) << "nu = " << poisson;
        EXPECT_LT(std::abs(stress(2, 2)), 1e-3 * young * kSmall) << "nu = " << poisson;
    }
}

TEST(PatchTest, OfAUniformShearHasTheShearModulus)
{
    const double young = 2e5, poisson = 0.3;
    Mat3 strain = Mat3::Zero();
    strain(0, 1) = kSmall; // simple shear: half of it is a rotation
    const Mat3 stress = Patch({young, poisson}, strain).stress();
    EXPECT_NEAR(stress(0, 1) / (young / (2.0 * (1.0 + poisson)) * kSmall), 1.0, 1e-3);
    EXPECT_NEAR(stress(1, 0), stress(0, 1), 1e-3 * stress(0, 1));
    EXPECT_LT(std::abs(stress(0, 0)), 1e-3 * stress(0, 1));
}

TEST(PatchTest, OfAChangeOfVolumeHasTheBulkModulus)
{
    const double young = 2e5;
    for (const double poisson : {0.0, 0.3, 0.49}) {
        const Mat3 stress = Patch({young, poisson}, kSmall * Mat3::Identity()).stress();
        const double bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        EXPECT_NEAR(stress.trace() / 3.0 / (bulk * 3.0 * kSmall), 1.0, 1e-3) << "nu = " << poisson;
    }
}

TEST(ElasticMaterial, RefusesValuesOutOfRange)
{
    for (const ElasticMaterial& material :
         {ElasticMaterial{0.0, 0.3}, ElasticMaterial{-1.0, 0.3}, ElasticMaterial{NAN, 0.3},
          ElasticMaterial{INFINITY, 0.3}, ElasticMaterial{1e5, 0.5}, ElasticMaterial{1e5, -0.1},
          ElasticMaterial{1e5, NAN}})
        EXPECT_THROW(material.lame("ball"), InvalidInput);
}

} // namespace
} // namespace toile::test
