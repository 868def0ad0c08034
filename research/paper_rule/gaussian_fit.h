#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/compute/types.h"

namespace toile::research {

/// Point of the line, the plane or space [m].
template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;

/// Axis-aligned box, borders included [m].
template <int Dim>
using Box = Eigen::AlignedBox<double, Dim>;

/// Surrogate of the near field [multilevel quadrature for PD, eq. 15, in Dim dimensions]:
///
///   A prod_a exp(-(x_a - c_a)^2 / sigma_a^2)
template <int Dim>
struct Gaussian {
    double amplitude = 1.0;                     ///< A, in the units of the fitted function
    Point<Dim> center = Point<Dim>::Zero();     ///< [m]
    Point<Dim> sigma = Point<Dim>::Constant(1); ///< [m] positive

    double value(const Point<Dim>& x) const;

    /// Closed-form integral over `box`, in units of A times m^Dim [eq. 16]:
    ///
    ///   A prod_a sqrt(pi)/2 sigma_a [erf((upper_a - c_a) / sigma_a) + erf((c_a - lower_a) / sigma_a)]
    ///
    /// The centre may lie outside of the box.
    double integral(const Box<Dim>& box) const;
};

/// Data to which the Gaussian is fitted.
template <int Dim>
struct GaussianTarget {
    std::vector<Point<Dim>> samples; ///< S_i: points with known values, the node included [m]
    std::vector<double> values;      ///< [samples] values of the function
    std::vector<Point<Dim>> faces;   ///< F_i: points at which the surrogate should vanish [m]
    double penalty = 100.0;          ///< mu [-]; 0 leaves the faces alone
};

/// Bounds of sigma_a over the half width of the box along a [-]. At the upper bound the surrogate varies by
/// 1 % over the box. Below the lower one it is a spike, seen by the sample at the node only. A kernel that
/// does not decay reaches the upper bound.
inline constexpr double kMinSigma = 0.05;
inline constexpr double kMaxSigma = 10.0;

/// Gaussian around `center` with [eq. 17]
///
///   min over A, sigma of  sum_s (G(x_s) - value_s)^2 + mu sum_f G(x_f)^2
///
/// by Levenberg-Marquardt in (A, log sigma). The paper takes one Gauss-Newton step; we run to convergence,
/// because the result is kept (see rule_weights.h).
/// @param near  the box that the Gaussian is integrated over; bounds sigma
template <int Dim>
Gaussian<Dim> fit_gaussian(const Point<Dim>& center, const Box<Dim>& near, const GaussianTarget<Dim>& target);

/// Weights of the best amplitude of eq. 17 for a given sigma, which is linear in the samples:
/// A = sum_s weight_s value_s with
///
///   weight_s = g(x_s) / (sum_s g(x_s)^2 + mu sum_f g(x_f)^2),   g = G / A
///
/// @return weights [samples]; `values` of the target are not read
template <int Dim>
std::vector<double> amplitude_weights(const Gaussian<Dim>& gaussian, const GaussianTarget<Dim>& target);

/// Centres of the 2 Dim faces of the box: F_i of eq. 17. The paper takes the nodes next to them. The
/// surrogate is known everywhere, so that no node is needed.
template <int Dim>
std::vector<Point<Dim>> face_centers(const Box<Dim>& box);

} // namespace toile::research
