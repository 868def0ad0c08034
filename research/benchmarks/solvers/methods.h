#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "research/benchmarks/solvers/problem.h"

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
    bool needs_chart = false;   ///< only for cloth that is initially planar
    bool knows_energies = true; ///< false: supports cloth alone, no ball
    bool uses_tables = false;   ///< uses Problem::tables
    std::function<std::unique_ptr<Stepper>(const Problem&)> make;
};

/// Maximum number of vertices for the paper's rule: its kernel rows are clustered one by one, O(n^2).
inline constexpr int kPaperSize = 3000;

bool applies(const Method& method, const Problem& problem);

/// Projective Dynamics with every global solver at several numbers of outer iterations, then the baseline
/// methods at several numbers of sweeps or substeps.
std::vector<Method> all_methods();

} // namespace toile::research::solvers
