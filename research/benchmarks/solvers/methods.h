#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "research/benchmarks/solvers/problem.h"
#include "research/paper_rule/paper_rule.h"

namespace toile::research::solvers {

/// A method ready to step one problem repeatedly.
class Stepper {
public:
    virtual ~Stepper() = default;

    /// Takes a sampled step from its start. @return iterations (sweeps, substeps)
    virtual int step(const SampledStep& from) = 0;
    virtual View<const Vec3> positions() const = 0;
};

/// A method with a budget of work per step.
struct Method {
    std::string name;           ///< "direct 20": the global solver or whole method, and its budget
    int max_vertices = 0;       ///< larger meshes are skipped: set-up takes too long
    bool needs_chart = false;   ///< only for cloth that is initially planar, and solids
    bool knows_energies = true; ///< false: supports cloth alone, no ball and no solid
    bool uses_tables = false;   ///< uses Problem::tables
    std::function<std::unique_ptr<Stepper>(const Problem&)> make;
};

/// Maximum number of vertices for the paper's rule: its kernel rows are clustered one by one, O(n^2).
inline constexpr int kPaperSize = 3000;

bool applies(const Method& method, const Problem& problem);

/// Quadrature for the problem's mesh, with the problem's tables.
std::unique_ptr<GlobalSolver> make_quadrature(const Problem& problem);

/// The paper's rule in the sheet's plane or the solid's volume. It needs one flat chart, which a skirt does
/// not have.
std::unique_ptr<GlobalSolver> make_paper_rule(const Problem& problem, PaperRule::Settings settings = {});

/// Projective Dynamics with every global solver at several numbers of outer iterations, then the baseline
/// methods at several numbers of sweeps or substeps.
std::vector<Method> all_methods();

} // namespace toile::research::solvers
