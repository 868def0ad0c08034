#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "core/pd/energy/curvature.h"
#include "core/pd/newton/embedded_points.h"
#include "core/pd/newton/hessian_solver.h"
#include "core/pd/step/step_hessian.h"
#include "tests/volume/blocks.h"
#include "volume/energy/elastic_solid.h"

namespace toile::test {

using namespace volume;

namespace {

/// A stiff bar whose ends are pulled sideways, in opposite directions at opposite corners.
class PulledBar : public testing::Test {
protected:
    PulledBar()
        : block_(make_block({0.6, 0.15, 0.15}, {24, 6, 6}, 0.2)), n_(int(block_.mesh.positions.size())),
          curvature_(n_,
                     {std::make_shared<ElasticSolid>(
                         std::make_shared<RestTets>(rest_tets(block_.mesh, "bar")),
                         std::vector<Lame>(block_.mesh.tets.size(), ElasticMaterial{1e6, 0.3}.lame("bar")))}),
          inertia_(n_, 1.0), fixed_(n_, 0), hessian_(curvature_, inertia_, fixed_),
          gradient_(n_, Vec3::Zero())
    {
        hessian_.linearise(block_.mesh.positions, Definiteness::Projected);
        gradient_[0] = Vec3(0.0, 1.0, 0.5);
        gradient_[block_.at(0, 6, 6)] = -gradient_[0];
        gradient_[block_.at(24, 0, 0)] = -gradient_[0];
        gradient_[block_.at(24, 6, 6)] = gradient_[0];
    }

    /// Direction by conjugate gradients with a coarse space for clusters of an extent.
    HessianSolver::Outcome solve(Extent extent)
    {
        HessianSolver solver(embedded(block_.mesh.positions), extent);
        solver.update(hessian_.parts(), true);
        direction_.resize(n_);
        return solver.solve(gradient_, {}, direction_);
    }

    Block block_;
    int n_;
    Curvature curvature_;
    std::vector<double> inertia_;
    std::vector<unsigned char> fixed_;
    StepHessian hessian_;
    std::vector<Vec3> gradient_, direction_;
};

TEST_F(PulledBar, NeedsFewerIterationsByFunctionsOfThreeCoordinates)
{
    const int in_plane = solve(Extent::Surface).iterations, in_space = solve(Extent::Volume).iterations;
    EXPECT_LT(in_space, 0.6 * in_plane);
}

TEST_F(PulledBar, HasADirectionOfTheErrorThatEndsASolve)
{
    const HessianSolver::Outcome outcome = solve(Extent::Volume);
    EXPECT_TRUE(outcome.is_solved);
    const SparseMatrix K = hessian_.matrix();
    const auto flat = [this](const std::vector<Vec3>& field) {
        return Eigen::Map<const Eigen::VectorXd>(field.front().data(), 3 * n_);
    };
    const Eigen::VectorXd exact = Eigen::SimplicialLDLT<SparseMatrix>(K).solve(-flat(gradient_));
    const Eigen::VectorXd error = flat(direction_) - exact;
    EXPECT_LT(error.dot(K * error),
              HessianSolver::kRelativeError * HessianSolver::kRelativeError * exact.dot(K * exact));
}

} // namespace

} // namespace toile::test
