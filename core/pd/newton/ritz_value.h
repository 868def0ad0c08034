#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile {

/// Inverse of the smallest Ritz value of conjugate gradients with the preconditioner P, a lower bound on that
/// of the smallest eigenvalue of P A [-]. It estimates the error e of an iterate with the residual r:
///
///   e . A e ~ inverse * r . P r
///
/// With the eigenvalue itself this is a bound. The estimate may be too low until the eigenvalue is seen.
/// Column by column of the triangular factor of the Lanczos matrix, by the incremental estimator of norms
/// [Duff & Voemel 2002], as in [Meurant & Tichy 2019, sec. 5].
class RitzValue {
public:
    TOILE_HD double inverse() const { return inverse_; }

    /// Takes an iteration.
    /// @param step, beta  [-] lengths of p along x, and of the previous p in p
    TOILE_HD void add(double step, double beta)
    {
        // The factor's next column is zero but for the last two entries: sqrt(beta / previous step), and
        // 1 / sqrt(step) on the diagonal.
        const double moved = previous_ > 0.0 ? std::sqrt(beta / previous_) * last_ : 0.0;
        const double a = inverse_ + step * moved * moved, b = -step * moved;
        const double half = 0.5 * (a - step), root = std::sqrt(half * half + b * b);
        // The larger eigenvalue of [a b; b step], and its unit vector.
        inverse_ = step + half + root;
        double s = half + root, c = b;
        if (half < 0.0)
            s = b, c = root - half;
        const double norm = std::sqrt(s * s + c * c);
        last_ = norm > 0.0 ? std::sqrt(step) * (c - s * moved) / norm : std::sqrt(step);
        previous_ = step;
    }

private:
    double inverse_ = 0.0;  ///< of the Lanczos matrix so far
    double last_ = 0.0;     ///< its estimated singular vector times the last column of the factor's inverse
    double previous_ = 0.0; ///< step
};

} // namespace toile
