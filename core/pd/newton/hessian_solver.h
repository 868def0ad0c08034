#pragma once

#include <vector>

#include "core/pd/newton/affine_space.h"
#include "core/pd/newton/hessian_rows.h"

namespace toile {

/// Solver of Newton's equation K d = -g: conjugate gradients in single precision, with sums in double, and
/// the additive preconditioner
///
///   P = blockdiag(K)^-1 + p K_c^-1 p^T
///
/// of 3 x 3 blocks and an AffineSpace.
class HessianSolver {
public:
    struct Outcome {
        int iterations = 0;
        bool is_solved = false; ///< the increments became small; false: stopped by kMaxIterations
        double residual = 0.0;  ///< [J] r . P r at the last iteration
    };

    /// Limit of iterations.
    static constexpr int kMaxIterations = 200;

    /// Reduction of the residual's square in the preconditioner's norm before small increments count [-].
    /// Small residuals of stiff cloth begin with small increments, although far from the solution.
    static constexpr double kReduction = 0.1;

    /// @param points  [vertices] undeformed positions
    explicit HessianSolver(std::vector<EmbeddedPoint> points) : coarse_(std::move(points)) {}

    /// Takes the values of K. Finds rows and clusters anew if other vertices are fixed than before.
    /// @param with_coarse  also of the coarse space, which may be older
    void update(const HessianParts& K, bool with_coarse);

    /// When a solve ends.
    struct Stop {
        double increment = 0.0; ///< [m] RMS of the increment, by mass, twice in succession
        double residual = -1.0; ///< [J] bound on r . P r as well; negative: kReduction of the first
    };

    /// @param g       [vertices] [N]
    /// @param masses  [vertices] [kg]
    /// @param d       [vertices] out [m]; zero where fixed
    Outcome solve(View<const Vec3> g, View<const double> masses, const Stop& stop, View<Vec3> d);

private:
    struct Sums {
        double first = 0.0, second = 0.0;
        Sums& operator+=(const Sums& other)
        {
            first += other.first;
            second += other.second;
            return *this;
        }
    };
    template <typename Kernel>
    Sums for_chunks(const char* name, const Kernel& kernel);
    Sums multiply();
    void add_whole_set();
    double precondition();
    int cluster_at(int row) const;

    AffineSpace coarse_;
    HessianRows rows_;
    bool has_coarse_ = false;
    std::vector<unsigned char> fixed_; ///< [vertices] for which rows and clusters were found
    const FrozenHessian* whole_set_ = nullptr;
    std::vector<int> first_of_chunk_; ///< [chunks + 1] rows of a task
    std::vector<int> cluster_of_row_; ///< [rows] -1: none
    std::vector<PaddedVec3> x_, r_, z_, p_, product_, term_force_;
    std::vector<float> mass_;                   ///< [rows] divided by their sum
    std::vector<Sums> sums_;                    ///< [chunks]
    std::vector<Vec3> whole_p_, whole_product_; ///< [vertices] scratch
};

} // namespace toile
