#pragma once

#include "core/pd/preconditioner/chebyshev.h"

namespace toile::research {

/// Matrix and sweeps of A-Jacobi, for CPU and GPU.
struct AggregatedSweeps {
    struct Settings {
        int order = 2;          ///< l, Jacobi sweeps per application: 1, 2 or 3 in the paper
        int applications = 16;  ///< products with R^l, plus one. At least 1.
        bool accelerate = true; ///< false: plain A-Jacobi
        int lanczos_steps = 40; ///< in update(); see estimate_bounds()
    };

    SparseMatrix R;                    ///< R^l; empty rows where vertices are fixed
    SpectralBounds bounds;             ///< of I - R^l
    std::vector<ChebyshevStep> steps;  ///< of the applications
    std::vector<ChebyshevStep> before; ///< of the plain sweeps from zero that give c

    AggregatedSweeps() = default;
    AggregatedSweeps(const SparseMatrix& A, View<const double> inverse_diagonal, const Settings& settings);
};

/// A-Jacobi: several Jacobi sweeps as one product with a wider matrix [Lan et al. 2022, "Penetration-free
/// projective dynamics on the GPU", section on A-Jacobi]. With R = I - w D^-1 H, l sweeps are
///
///   x <- R^l x + c,    c = sum_{k < l} R^k w D^-1 b
///
/// R^l is computed in update() and reaches l rings of neighbours. It exchanges dependent steps, which cost a
/// GPU time, for multiply-adds, which it has to spare; on a CPU it is no gain. c takes l - 1 plain sweeps
/// once per solve. As in the paper, Chebyshev accelerates the aggregated iteration, here with both ends of
/// the spectrum of I - R^l from Lanczos.
///
/// Deviations: the paper has w = 1, which diverges once D^-1 H has eigenvalues of 2 or more, as on irregular
/// sheets and with bending. Ours is 2 / (lowest + highest): order 2 and k applications then equal
/// ChebyshevSolver's 2 k sweeps (T_k(T_2) = T_2k). We drop no small products. No contact changes D inside the
/// solve, so that R^l can be stored instead of its products.
///
/// O(applications nnz(R^l)). Linear in b, symmetric positive definite.
class AggregatedJacobi final : public PaddedSolver {
public:
    using Settings = AggregatedSweeps::Settings;

    AggregatedJacobi() : AggregatedJacobi(Settings{}) {}
    explicit AggregatedJacobi(const Settings& settings) : settings_(settings) {}

    bool is_symmetric() const override { return true; }

    /// Number of entries of R^l; after update().
    long entry_count() const { return aggregated_.R.nonZeros(); }
    /// Bounds of I - R^l; after update().
    const SpectralBounds& bounds() const { return aggregated_.bounds; }

private:
    void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) override;
    void solve_free(View<const Vec4> b, View<Vec4> x) const override;

    Settings settings_;
    ChebyshevJacobi sweeps_; ///< plain damped Jacobi: gives c
    AggregatedSweeps aggregated_;
    mutable std::vector<Vec4> c_, d_, other_;
};

} // namespace toile::research
