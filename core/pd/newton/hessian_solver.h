#pragma once

#include <cmath>
#include <vector>

#include "core/pd/newton/affine_space.h"
#include "core/pd/newton/hessian_rows.h"
#include "core/pd/newton/ritz_value.h"

namespace toile {

/// Solver of Newton's equation K d = -g: conjugate gradients in single precision, with sums in double, and
/// the additive preconditioner
///
///   P = blockdiag(K)^-1 + p K_c^-1 p^T
///
/// of 3 x 3 blocks and an AffineSpace.
class HessianSolver {
public:
    /// Limit of iterations.
    static constexpr int kMaxIterations = 200;

    /// @param points  [vertices] undeformed positions
    /// @param extent  of the coarse space's clusters
    HessianSolver(std::vector<EmbeddedPoint> points, Extent extent)
        : coarse_(AffineSpace::make(std::move(points), extent))
    {
    }

    /// Iterations that the matrix of the coarse space costs, about.
    static constexpr int kPriceOfCoarse = 16;

    /// Takes the values of K. Finds rows and clusters anew if other vertices are fixed than before.
    /// @param with_coarse  also of the coarse space, which may be older
    void update(const HessianParts& K, bool with_coarse);

    /// Errors of d, relative to d in the norm of K [-]: one with which a solve ends, and the largest with
    /// which it may end. Without the latter, cloth that creeps towards its equilibrium would stop short of
    /// it.
    static constexpr double kRelativeError = 0.2, kMaxRelativeError = 0.5;

    /// When a solve ends before kRelativeError is reached.
    struct Stop {
        double error = 0.0;        ///< [J] Outcome::error that is small enough
        double inverse_ritz = 0.0; ///< [-] RitzValue::inverse() of similar solves: a lower bound
    };

    struct Outcome {
        int iterations = 0;
        bool is_solved = false; ///< the error became small; false: stopped by kMaxIterations
        double error = 0.0;     ///< [J] estimate of e . K e, for the error e of d
        double size = 0.0;      ///< [J] d . K d
        RitzValue ritz;

        /// Takes an iteration: lengths of p along d, and of the previous p in p [-], and r . P r before [J].
        TOILE_HD void advance(double step, double beta, double rz, const Stop& stop)
        {
            ++iterations;
            ritz.add(step, beta);
            size += step * rz;
            error = rz * (ritz.inverse() < stop.inverse_ritz ? stop.inverse_ritz : ritz.inverse());
            const auto is_within = [&](double part) { return error <= part * part * size; };
            is_solved = iterations > 1 && is_within(kMaxRelativeError) &&
                        (is_within(kRelativeError) || error <= stop.error);
        }
    };

    /// @param g  [vertices] [N]
    /// @param d  [vertices] out [m]; zero where fixed
    Outcome solve(View<const Vec3> g, const Stop& stop, View<Vec3> d);

private:
    template <typename Kernel>
    double for_chunks(const char* name, const Kernel& kernel);
    double multiply();
    void add_whole_set();
    double precondition();

    std::unique_ptr<AffineSpace> coarse_;
    HessianRows rows_;
    bool has_coarse_ = false;
    std::vector<unsigned char> fixed_; ///< [vertices] for which rows and clusters were found
    const FrozenHessian* whole_set_ = nullptr;
    std::vector<int> first_of_chunk_; ///< [chunks + 1] rows of a task
    std::vector<PaddedVec3> x_, r_, z_, p_, product_, term_force_;
    std::vector<double> sums_;                  ///< [chunks]
    std::vector<Vec3> whole_p_, whole_product_; ///< [vertices] scratch
};

} // namespace toile
