#include "tests/garment/newton.h"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace toile::test {

namespace {

/// Half the step of the central differences for a column of the Hessian [m].
constexpr double kDifference = 1e-6;

/// Max displacement of a Newton step that ends the search [m].
constexpr double kFinished = 1e-12;

/// Free coordinates, as indices into the flattened positions.
std::vector<int> free_coordinates(const std::vector<unsigned char>& fixed)
{
    std::vector<int> coordinates;
    for (size_t v = 0; v < fixed.size(); ++v)
        for (int k = 0; k < 3 && !fixed[v]; ++k)
            coordinates.push_back(int(3 * v) + k);
    return coordinates;
}

Eigen::VectorXd gather(const std::vector<Vec3>& field, const std::vector<int>& coordinates)
{
    Eigen::VectorXd values(coordinates.size());
    for (int i = 0; i < values.size(); ++i)
        values[i] = field[coordinates[i] / 3][coordinates[i] % 3];
    return values;
}

Eigen::MatrixXd hessian(const ValueAndGradient& function, const std::vector<int>& coordinates,
                        std::vector<Vec3> x)
{
    Eigen::MatrixXd H(coordinates.size(), coordinates.size());
    std::vector<Vec3> up(x.size()), down(x.size());
    for (int j = 0; j < H.cols(); ++j) {
        double& coordinate = x[coordinates[j] / 3][coordinates[j] % 3];
        const double here = coordinate;
        coordinate = here + kDifference;
        function(x, up);
        coordinate = here - kDifference;
        function(x, down);
        coordinate = here;
        H.col(j) = (gather(up, coordinates) - gather(down, coordinates)) / (2.0 * kDifference);
    }
    return 0.5 * (H + H.transpose());
}

/// -|H|^-1 g, where |H| has the absolute eigenvalues of H.
Eigen::VectorXd newton_step(const Eigen::MatrixXd& H, const Eigen::VectorXd& g)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H);
    const Eigen::VectorXd curvature = eigen.eigenvalues().cwiseAbs();
    return -eigen.eigenvectors() * (eigen.eigenvectors().transpose() * g).cwiseQuotient(curvature);
}

} // namespace

double minimise_by_newton(const ValueAndGradient& function, const std::vector<unsigned char>& fixed,
                          std::vector<Vec3>& x)
{
    const std::vector<int> coordinates = free_coordinates(fixed);
    std::vector<Vec3> gradient(x.size());
    double value = function(x, gradient);
    double longest = INFINITY;
    for (int iteration = 0; iteration < 100 && longest > kFinished; ++iteration) {
        const Eigen::VectorXd step =
            newton_step(hessian(function, coordinates, x), gather(gradient, coordinates));
        longest = step.lpNorm<Eigen::Infinity>();

        double fraction = 1.0;
        for (int halving = 0; halving < 30; ++halving, fraction *= 0.5) {
            std::vector<Vec3> trial = x;
            for (int i = 0; i < step.size(); ++i)
                trial[coordinates[i] / 3][coordinates[i] % 3] += fraction * step[i];
            std::vector<Vec3> trial_gradient(x.size());
            const double trial_value = function(trial, trial_gradient);
            if (trial_value > value + 1e-14 * std::abs(value))
                continue;
            x = trial;
            gradient = trial_gradient;
            value = trial_value;
            break;
        }
    }
    return longest;
}

} // namespace toile::test
