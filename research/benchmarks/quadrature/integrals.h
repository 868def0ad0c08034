#pragma once

#include <vector>

#include "research/benchmarks/quadrature/sheet.h"
#include "research/paper_rule/rule_weights.h"

namespace toile::research {

/// The paper's figures 3, 5 and 6: errors of several rules for the integral of a function with a peak.

/// |rule / exact - 1| of each rule [-].
struct IntegrationErrors {
    double gauss_legendre_3 = 0.0; ///< plain, on the middle box
    double gauss_legendre_4 = 0.0;
    double gaussian_alone = 0.0;     ///< fitted without penalty, integrated over the middle box
    double stacked_no_penalty = 0.0; ///< three points per axis on the residual, mu = 0
    double stacked = 0.0;            ///< mu = 100: the paper's rule
};

/// A function on [-1, 1] with a peak: the impulse response of 1 - lambda^2 d^2/dx^2 with free ends, smoothed.
///
///   G(x) = exp(-|x| / lambda) * hat_epsilon          [multilevel quadrature for PD, eq. 14 in one dimension]
///
/// smoothed by a hat function and mirrored at both ends (method of images); 1 at the peak.
class YukawaLine {
public:
    /// @param peak     in [-1, 1]
    /// @param lambda   decay length, below 1
    /// @param epsilon  half width of the hat, positive
    YukawaLine(double peak, double lambda, double epsilon);

    double peak() const { return peak_; }
    double operator()(double x) const { return in_free_space_and_images(x) / at_peak_; }

    /// Integral over [-1, 1]: images make it that of free space, 2 lambda before scaling.
    double integral() const { return 2.0 * lambda_ / at_peak_; }

    /// Interval that grows from the peak to both sides at equal speed, cut at -1 and 1, until it contains
    /// `fraction` of the integral.
    Box<1> near_box(double fraction) const;

private:
    double in_free_space_and_images(double x) const;

    double peak_, lambda_, epsilon_, at_peak_ = 1.0;
};

/// The two Gaussians of a comparison.
template <int Dim>
struct GaussianFits {
    Box<Dim> near; ///< box of the fit
    Gaussian<Dim> no_penalty, penalty;
};

/// The fits behind errors_on_line().
GaussianFits<1> fits_on_line(const YukawaLine& target, double near_fraction);

/// Figures 3 and 5: the middle box is [-1, 1], the near box contains `near_fraction` of the integral, S_i are
/// 8 points.
IntegrationErrors errors_on_line(const YukawaLine& target, double near_fraction);

/// Figure 5, right half: the peak times a wave, phi(x) = target(x) cos(omega (x - peak)). Its near box is
/// that of the peak alone, because in a global step the wave is b. The paper gives neither phase nor omega.
/// @param omega  [1/m]
IntegrationErrors errors_on_wave(const YukawaLine& target, double omega, double near_fraction);

/// Figure 6: phi(x, y) = target_x(x) target_y(y) on the square; the near box is the product of the near
/// intervals. S_i are 8 points by farthest point sampling.
IntegrationErrors errors_on_square(const YukawaLine& target_x, const YukawaLine& target_y,
                                   double near_fraction);

/// Errors on a sheet with its own kernel: phi = u(i) b / |Omega| over the middle box of Alg. 1, against the
/// exact integral of the interpolant over the box.
/// @param b  [vertices] [N]
IntegrationErrors errors_on_sheet(const VoxelisedMesh<2>& mesh, int vertex, View<const double> u,
                                  View<const double> b, const RuleSettings& settings);

/// Mean of each error.
IntegrationErrors mean(const std::vector<IntegrationErrors>& errors);

} // namespace toile::research
