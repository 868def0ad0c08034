#include "core/pd/newton/ritz_value.h"

#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace toile::test {

namespace {

/// Conjugate gradients for a diagonal matrix, whose eigenvalues and errors are known.
class KnownSpectrum {
public:
    explicit KnownSpectrum(Eigen::VectorXd eigenvalues)
        : eigenvalues_(std::move(eigenvalues)), r_(Eigen::VectorXd::Ones(eigenvalues_.size())),
          p_(Eigen::VectorXd::Zero(r_.size()))
    {
    }

    void iterate()
    {
        const double rr = r_.squaredNorm(), beta = squares_.empty() ? 0.0 : rr / squares_.back();
        p_ = r_ + beta * p_;
        const Eigen::VectorXd product = eigenvalues_.cwiseProduct(p_);
        const double step = rr / p_.dot(product);
        r_ -= step * product;
        squares_.push_back(rr);
        steps_.push_back(step);
        betas_.push_back(beta);
        ritz.add(step, beta);
    }

    /// e . A e, with A e = r.
    double error() const { return r_.cwiseAbs2().cwiseQuotient(eigenvalues_).sum(); }
    double estimate() const { return r_.squaredNorm() * ritz.inverse(); }

    /// The smallest eigenvalue of the Lanczos matrix.
    double smallest_ritz_value() const
    {
        const Eigen::Index n = Eigen::Index(steps_.size());
        Eigen::VectorXd diagonal(n), beside(n - 1);
        for (Eigen::Index k = 0; k < n; ++k) {
            diagonal[k] = 1.0 / steps_[k] + (k > 0 ? betas_[k] / steps_[k - 1] : 0.0);
            if (k > 0)
                beside[k - 1] = std::sqrt(betas_[k]) / steps_[k - 1];
        }
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
        solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
        return solver.eigenvalues()[0];
    }

    RitzValue ritz;

private:
    Eigen::VectorXd eigenvalues_, r_, p_;
    std::vector<double> squares_, steps_, betas_;
};

TEST(RitzValue, IsExactForTwoIterationsAndNeverBelow)
{
    KnownSpectrum problem(Eigen::VectorXd::LinSpaced(200, 0.01, 1.0).cwiseAbs2());
    for (int k = 1; k <= 60; ++k) {
        problem.iterate();
        const double ratio = 1.0 / (problem.ritz.inverse() * problem.smallest_ritz_value());
        EXPECT_GE(ratio, 1.0 - 1e-9) << k;
        EXPECT_LE(ratio, k <= 2 ? 1.0 + 1e-9 : 4.0) << k;
    }
}

TEST(RitzValue, BoundsTheErrorOnceTheSmallestEigenvalueIsSeen)
{
    KnownSpectrum problem(Eigen::VectorXd::LinSpaced(200, 0.1, 1.0));
    for (int k = 1; k <= 40; ++k) {
        problem.iterate();
        if (k < 3)
            continue;
        EXPECT_GE(problem.estimate(), problem.error()) << k;
        EXPECT_LE(problem.estimate(), 20.0 * problem.error()) << k;
    }
}

TEST(RitzValue, IsTheEigenvalueOfAMultipleOfTheIdentity)
{
    KnownSpectrum problem(Eigen::VectorXd::Constant(5, 4.0));
    problem.iterate();
    EXPECT_DOUBLE_EQ(problem.ritz.inverse(), 0.25);
}

} // namespace

} // namespace toile::test
