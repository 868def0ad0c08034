#pragma once

#include <cmath>
#include <vector>

#include "research/paper_rule/gaussian_fit.h"

namespace toile::research {

/// Sample of a quadrature rule.
template <int Dim>
struct QuadraturePoint {
    Point<Dim> position; ///< xi [m]
    double weight;       ///< product of the one-dimensional weights times the Jacobian J [m^Dim]
};

/// Gauss-Legendre rule of `order` points on [-1, 1]: exact for polynomials of degree 2 order - 1.
/// @param order  2, 3 or 4
inline std::vector<QuadraturePoint<1>> gauss_legendre_line(int order)
{
    TOILE_ASSERT(order >= 2 && order <= 4);
    if (order == 2) {
        const double x = std::sqrt(1.0 / 3.0);
        return {{Point<1>(-x), 1.0}, {Point<1>(x), 1.0}};
    }
    if (order == 3) {
        const double x = std::sqrt(3.0 / 5.0);
        return {{Point<1>(-x), 5.0 / 9.0}, {Point<1>(0.0), 8.0 / 9.0}, {Point<1>(x), 5.0 / 9.0}};
    }
    const double root = 2.0 / 7.0 * std::sqrt(6.0 / 5.0);
    const double inner = std::sqrt(3.0 / 7.0 - root), outer = std::sqrt(3.0 / 7.0 + root);
    const double of_inner = (18.0 + std::sqrt(30.0)) / 36.0, of_outer = (18.0 - std::sqrt(30.0)) / 36.0;
    return {{Point<1>(-outer), of_outer},
            {Point<1>(-inner), of_inner},
            {Point<1>(inner), of_inner},
            {Point<1>(outer), of_outer}};
}

/// Tensor product of the rule on a box: order^Dim points whose weights sum to its volume [multilevel
/// quadrature for PD, eq. 4 and 20].
template <int Dim>
std::vector<QuadraturePoint<Dim>> gauss_legendre(const Box<Dim>& box, int order)
{
    const std::vector<QuadraturePoint<1>> line = gauss_legendre_line(order);
    const Point<Dim> half_width = 0.5 * box.sizes();
    std::vector<QuadraturePoint<Dim>> points(1, {box.center(), half_width.prod()});
    for (int a = 0; a < Dim; ++a) {
        std::vector<QuadraturePoint<Dim>> finer;
        for (const QuadraturePoint<Dim>& coarse : points)
            for (const QuadraturePoint<1>& on_line : line) {
                finer.push_back(coarse);
                finer.back().position[a] += half_width[a] * on_line.position[0];
                finer.back().weight *= on_line.weight;
            }
        points = std::move(finer);
    }
    return points;
}

/// Boxes that fill `outer` around `inner`, which lies in it: two beside each pair of faces, those of the
/// first axis over the whole cross-section. Boxes without volume are left out.
template <int Dim>
std::vector<Box<Dim>> boxes_around(const Box<Dim>& inner, Box<Dim> outer)
{
    std::vector<Box<Dim>> boxes;
    for (int a = 0; a < Dim; ++a) {
        Box<Dim> below = outer, above = outer;
        below.max()[a] = outer.min()[a] = inner.min()[a];
        above.min()[a] = outer.max()[a] = inner.max()[a];
        for (const Box<Dim>& box : {below, above})
            if (box.volume() > 0.0)
                boxes.push_back(box);
    }
    return boxes;
}

/// sum_k weight_k phi(xi_k): plain Gauss-Legendre if `points` are its points.
template <int Dim, typename Phi>
double weighted_sum(const Phi& phi, const std::vector<QuadraturePoint<Dim>>& points)
{
    double sum = 0.0;
    for (const QuadraturePoint<Dim>& point : points)
        sum += point.weight * phi(point.position);
    return sum;
}

/// Correction of the plain rule by stacking: the Gaussian's integral over the near box less the rule's
/// estimate of it. Linear in the amplitude.
template <int Dim>
double stacking_correction(const Gaussian<Dim>& gaussian, const Box<Dim>& near,
                           const std::vector<QuadraturePoint<Dim>>& points)
{
    return gaussian.integral(near) -
           weighted_sum([&](const Point<Dim>& x) { return near.contains(x) ? gaussian.value(x) : 0.0; },
                        points);
}

/// Integral by stacking: the Gaussian's closed-form integral over the near box plus the rule on the middle
/// box. The rule is applied to phi - G inside of the near box and to phi outside [multilevel quadrature for
/// PD, eq. 16, 18, 20].
/// @param points  of the middle box, which contains the near box
template <int Dim, typename Phi>
double stacked_integral(const Phi& phi, const Gaussian<Dim>& gaussian, const Box<Dim>& near,
                        const std::vector<QuadraturePoint<Dim>>& points)
{
    return weighted_sum(phi, points) + stacking_correction(gaussian, near, points);
}

} // namespace toile::research
