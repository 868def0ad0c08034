#pragma once

#include <variant>
#include <vector>

#include "core/linear/global_solver.h"
#include "research/paper_rule/rule_weights.h"

namespace toile::research {

/// Denominator of eq. 7. u(i)^T H u(i) = l_i = 1 / G_ii, with G = H^-1.
enum class Denominator {
    SameRule, ///< the rule applied to u(i)^T (H u(i)), as the paper does: H u(i) is l_i at vertex i, zero
              ///< elsewhere
    Exact,    ///< 1 / G_ii
};

/// Global step by the paper's multilevel quadrature, word for word, on triangle surfaces and on
/// tetrahedra [multilevel quadrature for PD, eq. 7]:
///
///   x_i = u(i)^T b / (u(i)^T H u(i)),  u(i) = G(:, i) / G_ii
///
/// The inner product is taken from about 43 vertices of a surface, 124 of a solid (rule_weights.h).
/// Everything but b is tabulated, so that an application is one gather.
///
/// For comparison only: one application is right to some ten per cent for smooth b. x += solve(b - H x)
/// diverges on every body measured. So does the local/global loop around it, unless each step is
/// line-searched. See docs/theory/paper_rule.md. Unsymmetric.
class PaperRule : public GlobalSolver {
public:
    struct Settings {
        RuleSettings rule;
        Denominator denominator = Denominator::SameRule;
        int voxels = 64;      ///< of Alg. 1 along the longest side of the bounding box
        int applications = 1; ///< per solve, at least 1; from the second on x += rule(b - H x)
    };

    /// @param uv         [vertices x 2] positions in the plane [m]
    /// @param triangles  [triangles] counter-clockwise in the plane
    /// @throws InvalidInput  as VoxelisedMesh does, or naming the first setting that is out of its range
    PaperRule(View<const Vec2> uv, View<const Triangle> triangles, Settings settings);
    PaperRule(View<const Vec2> uv, View<const Triangle> triangles) : PaperRule(uv, triangles, Settings{}) {}

    /// @param positions  [vertices] at rest [m]
    /// @param tets       [tets] positively oriented
    PaperRule(View<const Vec3> positions, View<const Simplex<3>> tets, Settings settings);

    /// Factors H and tabulates the rule of every free vertex. O(n^2) time: n solves, and n clusterings of the
    /// far field.
    /// @throws InvalidInput  also if H is not [vertices x vertices] or `fixed` not [vertices]
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return false; }

    const Settings& settings() const { return settings_; }

    // After update(): the rule of every x_i, denominator included, where fixed vertices read themselves; and
    // H, which has rows only if a second application needs it.
    WeightedRows rule() const { return rule_.view(); }
    WeightedRows matrix() const { return H_.view(); }

    /// Entries of the rule of x_i.
    View<const WeightedVertex> row(int i) const
    {
        return rule().entries.subview(rule_.first[i], rule_.first[i + 1] - rule_.first[i]);
    }

private:
    int vertex_count() const;

    /// Rows of weights in one array.
    struct Table {
        std::vector<int> first; ///< [vertices + 1] into entries
        std::vector<WeightedVertex> entries;

        explicit Table(const std::vector<std::vector<WeightedVertex>>& rows = {});
        WeightedRows view() const { return {first, entries}; }
    };

    std::vector<WeightedVertex> tabulate(int vertex, std::vector<double> G) const;
    static Table table_of(const SparseMatrix& H);

    Settings settings_;
    std::variant<VoxelisedMesh<2>, VoxelisedMesh<3>> mesh_;
    Table rule_, H_;
};

} // namespace toile::research
