#pragma once

#include <vector>

#include "core/linear/field.h"

namespace toile {

/// Preconditioned conjugate gradients for A x = b on 3-vector fields, started at x = 0 [Saad 2003, alg. 9.1].
/// The flexible form follows [Notay 2000].
class Pcg {
public:
    struct Settings {
        double tolerance = 0.1; ///< [-] |r| / |b| to reach
        int max_iterations = 4;
        bool is_flexible = false; ///< for a preconditioner that is not symmetric: Polak-Ribiere's beta

        /// Min gain [-] of an iteration over the mean gain so far, in the quadratic 1/2 x . A x - b . x
        /// [Nash & Sofer 1990]. An iteration below it is the last; 0: no such test.
        double min_gain = 0.0;
        int min_iterations = 0; ///< iterations before min_gain counts

        TOILE_HD bool is_worth_more(int iterations, double gain, double total_gain) const
        {
            return iterations < min_iterations || min_gain == 0.0 ||
                   iterations * gain > min_gain * total_gain;
        }
    };
    struct Outcome {
        int iterations = 0;
        double residual = 0.0; ///< [-] |r| / |b| reached
    };

    /// @param multiply      multiply(p, out): out = A p, A symmetric positive definite
    /// @param precondition  precondition(r, z): z = P r, P symmetric positive definite unless
    ///                      the form is flexible
    /// @param is_enough     is_enough(step, p): true after an increment step * p of x with which the solve
    /// may
    ///                      end
    template <typename Multiply, typename Precondition, typename IsEnough>
    Outcome solve(const Multiply& multiply, const Precondition& precondition, View<const Vec3> b,
                  View<Vec3> x, const Settings& settings, const IsEnough& is_enough)
    {
        const int n = b.size();
        r_.assign(b.begin(), b.end());
        z_.resize(n);
        p_.assign(n, Vec3::Zero());
        product_.resize(n);
        std::fill(x.begin(), x.end(), Vec3::Zero());

        Outcome outcome;
        const double b_norm = std::sqrt(dot(b, b));
        if (!(b_norm > 0.0))
            return outcome;
        double rz_previous = 0.0, total_gain = 0.0;
        outcome.residual = 1.0;
        while (outcome.iterations < settings.max_iterations && outcome.residual > settings.tolerance) {
            precondition(View<const Vec3>(r_), View<Vec3>(z_));
            const double rz = dot(r_, z_);
            const double change =
                settings.is_flexible && outcome.iterations > 0 ? rz - dot(r_previous_, z_) : rz;
            xpay(z_, outcome.iterations > 0 ? change / rz_previous : 0.0, p_);
            multiply(View<const Vec3>(p_), View<Vec3>(product_));
            const double curvature = dot(p_, product_);
            // By rounding, or because A is indefinite after all: the iterate so far is the answer.
            if (!(curvature > 0.0))
                break;
            const double step = settings.is_flexible ? dot(r_, p_) / curvature : rz / curvature;
            if (settings.is_flexible)
                r_previous_ = r_;
            axpy(step, p_, x);
            axpy(-step, product_, r_);
            rz_previous = rz;
            outcome.residual = std::sqrt(dot(r_, r_)) / b_norm;
            ++outcome.iterations;
            const double gain = step * step * curvature;
            total_gain += gain;
            if (!settings.is_worth_more(outcome.iterations, gain, total_gain) ||
                is_enough(step, View<const Vec3>(p_)))
                break;
        }
        return outcome;
    }
    template <typename Multiply, typename Precondition>
    Outcome solve(const Multiply& multiply, const Precondition& precondition, View<const Vec3> b,
                  View<Vec3> x, const Settings& settings)
    {
        return solve(multiply, precondition, b, x, settings, [](double, View<const Vec3>) { return false; });
    }

private:
    std::vector<Vec3> r_, z_, p_, product_, r_previous_;
};

} // namespace toile
