#include "research/paper_rule/gaussian_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace toile::research {

namespace {

constexpr int kMaxIterations = 60;

/// Relative decrease of the objective below which the fit has converged [-].
constexpr double kConverged = 1e-12;

/// Damping of Levenberg-Marquardt relative to the diagonal [-]: at first, and when no step helps any more.
constexpr double kFirstDamping = 1e-3;
constexpr double kMaxDamping = 1e8;

/// Residuals of eq. 17 and their derivatives by (A, log sigma).
template <int Dim>
struct Residuals {
    Eigen::VectorXd r;
    Eigen::Matrix<double, Eigen::Dynamic, Dim + 1> J;

    Residuals(const Gaussian<Dim>& gaussian, const GaussianTarget<Dim>& target)
        : r(target.samples.size() + target.faces.size()), J(r.size(), Dim + 1)
    {
        const int sample_count = int(target.samples.size());
        for (int s = 0; s < sample_count; ++s)
            set_row(s, gaussian, target.samples[s], target.values[s], 1.0);
        for (int f = 0; f < int(target.faces.size()); ++f)
            set_row(sample_count + f, gaussian, target.faces[f], 0.0, std::sqrt(target.penalty));
    }

    void set_row(int row, const Gaussian<Dim>& gaussian, const Point<Dim>& x, double value, double weight)
    {
        const double G = gaussian.value(x);
        r[row] = weight * (G - value);
        J(row, 0) = weight * (gaussian.amplitude != 0.0 ? G / gaussian.amplitude : 0.0);
        const auto scaled = (x - gaussian.center).cwiseQuotient(gaussian.sigma);
        for (int a = 0; a < Dim; ++a)
            J(row, 1 + a) = weight * 2.0 * G * scaled[a] * scaled[a];
    }
};

template <int Dim>
double best_amplitude(const Gaussian<Dim>& gaussian, const GaussianTarget<Dim>& target)
{
    const std::vector<double> weights = amplitude_weights(gaussian, target);
    double amplitude = 0.0;
    for (size_t s = 0; s < weights.size(); ++s)
        amplitude += weights[s] * target.values[s];
    return amplitude;
}

} // namespace

template <int Dim>
double Gaussian<Dim>::value(const Point<Dim>& x) const
{
    return amplitude * std::exp(-(x - center).cwiseQuotient(sigma).squaredNorm());
}

template <int Dim>
double Gaussian<Dim>::integral(const Box<Dim>& box) const
{
    const double half_root_pi = 0.5 * std::sqrt(std::numbers::pi);
    double result = amplitude;
    for (int a = 0; a < Dim; ++a)
        result *= half_root_pi * sigma[a] *
                  (std::erf((box.max()[a] - center[a]) / sigma[a]) +
                   std::erf((center[a] - box.min()[a]) / sigma[a]));
    return result;
}

template <int Dim>
Gaussian<Dim> fit_gaussian(const Point<Dim>& center, const Box<Dim>& near, const GaussianTarget<Dim>& target)
{
    const Point<Dim> half_width = 0.5 * near.sizes();
    Gaussian<Dim> best{1.0, center, 0.5 * half_width};
    best.amplitude = best_amplitude(best, target);
    Residuals<Dim> at_best(best, target);

    double damping = kFirstDamping;
    for (int iteration = 0; iteration < kMaxIterations && damping < kMaxDamping; ++iteration) {
        // Compute the step of the damped normal equations.
        Eigen::Matrix<double, Dim + 1, Dim + 1> N = at_best.J.transpose() * at_best.J;
        N.diagonal() += (damping * N.diagonal().array() + 1e-300).matrix();
        const Eigen::Matrix<double, Dim + 1, 1> step = N.ldlt().solve(-at_best.J.transpose() * at_best.r);

        // Replace the step's amplitude by the best one for the new widths.
        Gaussian<Dim> trial = best;
        for (int a = 0; a < Dim; ++a)
            trial.sigma[a] = std::clamp(best.sigma[a] * std::exp(std::clamp(step[1 + a], -1.0, 1.0)),
                                        kMinSigma * half_width[a], kMaxSigma * half_width[a]);
        trial.amplitude = 1.0;
        trial.amplitude = best_amplitude(trial, target);

        // Keep a step that helps; shorten the next one otherwise.
        const Residuals<Dim> at_trial(trial, target);
        const double before = at_best.r.squaredNorm(), after = at_trial.r.squaredNorm();
        if (!(after < before)) {
            damping *= 10.0;
            continue;
        }
        damping = std::max(0.1 * damping, 1e-12);
        best = trial;
        at_best = at_trial;
        if (before - after < kConverged * before)
            break;
    }
    return best;
}

template <int Dim>
std::vector<double> amplitude_weights(const Gaussian<Dim>& gaussian, const GaussianTarget<Dim>& target)
{
    Gaussian<Dim> unit = gaussian;
    unit.amplitude = 1.0;

    std::vector<double> weights;
    double squares = 0.0;
    for (const Point<Dim>& x : target.samples) {
        weights.push_back(unit.value(x));
        squares += weights.back() * weights.back();
    }
    for (const Point<Dim>& x : target.faces)
        squares += target.penalty * unit.value(x) * unit.value(x);
    for (double& weight : weights)
        weight = squares > 0.0 ? weight / squares : 0.0;
    return weights;
}

template <int Dim>
std::vector<Point<Dim>> face_centers(const Box<Dim>& box)
{
    std::vector<Point<Dim>> centers;
    for (int a = 0; a < Dim; ++a)
        for (const double side : {box.min()[a], box.max()[a]}) {
            centers.push_back(box.center());
            centers.back()[a] = side;
        }
    return centers;
}

template struct Gaussian<1>;
template struct Gaussian<2>;
template struct Gaussian<3>;
template Gaussian<1> fit_gaussian(const Point<1>&, const Box<1>&, const GaussianTarget<1>&);
template Gaussian<2> fit_gaussian(const Point<2>&, const Box<2>&, const GaussianTarget<2>&);
template Gaussian<3> fit_gaussian(const Point<3>&, const Box<3>&, const GaussianTarget<3>&);
template std::vector<double> amplitude_weights(const Gaussian<1>&, const GaussianTarget<1>&);
template std::vector<double> amplitude_weights(const Gaussian<2>&, const GaussianTarget<2>&);
template std::vector<double> amplitude_weights(const Gaussian<3>&, const GaussianTarget<3>&);
template std::vector<Point<1>> face_centers(const Box<1>&);
template std::vector<Point<2>> face_centers(const Box<2>&);
template std::vector<Point<3>> face_centers(const Box<3>&);

} // namespace toile::research
