#pragma once

#include <vector>

#include "core/linear/global_solver.h"
#include "quadrature2d/paper/rule_weights.h"

namespace toile {

/// The denominator of eq. 7. u(i)^T H u(i) = l_i = 1 / G_ii, with G = H^-1.
enum class Denominator {
    SameRule, ///< the rule applied to u(i)^T (H u(i)), as the paper does: H u(i) is l_i at vertex i, zero
              ///< elsewhere
    Exact,    ///< 1 / G_ii
};

/// The global step by the paper's multilevel quadrature, word for word, on triangle surfaces:
///
///   x_i = u(i)^T b / (u(i)^T H u(i)),  u(i) = G(:, i) / G_ii              [multilevel quadrature for PD, eq.
///   7]
///
/// with the inner product taken from about 43 vertices (rule_weights.h). Everything but b is tabulated, so
/// that solve() is one gather.
///
/// For comparison only: one application is right to some ten per cent for smooth b, but x += solve(b - H x)
/// diverges on every cloth measured, and so does the local/global loop around it unless each step is
/// line-searched. See docs/quadrature2d/paper.md. Unsymmetric.
class PaperRule : public GlobalSolver {
public:
    struct Settings {
        RuleSettings rule;
        Denominator denominator = Denominator::SameRule;
        int pixels = 64; ///< of Alg. 1 along the longer side of the UV bounding box
    };

    /// @param uv         [vertices x 2] positions in the plane [m]
    /// @param triangles  [triangles] counter-clockwise in the plane
    /// @throws InvalidInput  as UvSurface does, or naming the first setting that is out of its range
    PaperRule(View<const Vec2> uv, View<const Triangle> triangles, Settings settings);
    PaperRule(View<const Vec2> uv, View<const Triangle> triangles) : PaperRule(uv, triangles, Settings{}) {}

    /// Factors H and tabulates the rule of every free vertex. O(n^2) time: n solves, and n clusterings of the
    /// far field.
    /// @throws InvalidInput  also where H is not [vertices x vertices] or `fixed` not [vertices]
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return false; }

    /// The rule of x_i, denominator included; fixed vertices read themselves. After update().
    View<const WeightedVertex> row(int i) const
    {
        return View<const WeightedVertex>(entries_.data() + first_[i], first_[i + 1] - first_[i]);
    }

private:
    std::vector<WeightedVertex> tabulate(int vertex, std::vector<double> G) const;

    Settings settings_;
    UvSurface surface_;
    std::vector<int> first_; ///< [vertices + 1] into entries_
    std::vector<WeightedVertex> entries_;
};

} // namespace toile
