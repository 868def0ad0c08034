#include <algorithm>
#include <cmath>

#include "core/linear/field.h"
#include "core/linear/pcg.h"
#include "core/pd/step/step_objective.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/paper/figures.h"
#include "research/benchmarks/paper/half_edges.h"
#include "research/benchmarks/solvers/methods.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::paper {

namespace {

using solvers::Problem;

const std::vector<int> kIterations{1, 3, 10, 40};

constexpr double kStep = 1.0 / 120.0; ///< [s]

/// Step of the swinging body whose gradient is the smooth load.
constexpr int kSampledStep = 16;

enum class Loop { Plain, LineSearch, Pcg };
constexpr std::pair<Loop, const char*> kLoops[] = {
    {Loop::Plain, "plain"}, {Loop::LineSearch, "line search"}, {Loop::Pcg, "pcg"}};

/// H x = b and its solution.
class GlobalStep {
public:
    GlobalStep(const System& system, std::vector<Vec3> b)
        : H_(system.matrix()), b_(std::move(b)), solution_(b_.size()), product_(b_.size())
    {
        system.solver().solve(b_, solution_);
    }

    /// Iterates from x = 0.
    /// @return iterations made: fewer if there is no direction
    int solve(const GlobalSolver& A, Loop loop, int iterations, std::vector<Vec3>& x)
    {
        x.assign(b_.size(), Vec3::Zero());
        if (loop == Loop::Pcg) {
            const auto times_H = [&](View<const Vec3> p, View<Vec3> out) { multiply(p, out); };
            const auto times_A = [&](View<const Vec3> r, View<Vec3> z) { A.solve(r, z); };
            return Pcg().solve(times_H, times_A, b_, x, {0.0, iterations, true}).iterations;
        }
        std::vector<Vec3> r = b_, z(b_.size());
        for (int iteration = 0; iteration < iterations; ++iteration) {
            A.solve(r, z);
            multiply(z, product_);
            const double curvature = dot(z, product_);
            if (!(curvature > 0.0))
                return iteration;
            const double length = loop == Loop::LineSearch ? dot(z, r) / curvature : 1.0;
            axpy(length, z, x);
            axpy(-length, product_, r);
        }
        return iterations;
    }

    void judge(const std::vector<Vec3>& x, Curve::Point& point)
    {
        multiply(x, product_);
        std::vector<Vec3> r = b_, e = solution_;
        axpy(-1.0, product_, r);
        axpy(-1.0, x, e);
        point.residual = std::sqrt(dot(r, r) / dot(b_, b_));
        point.error = std::sqrt(std::abs(dot(e, r)) / dot(solution_, b_)); // r = H e
    }

private:
    void multiply(View<const Vec3> p, View<Vec3> out) const
    {
        parallel_for(kCpu, "figures/multiply", p.size(), [&](int i) { out[i] = row_times(H_, i, p); });
    }

    const SparseMatrix& H_;
    std::vector<Vec3> b_, solution_, product_;
};

/// Negative gradient at the prediction of a step [N].
std::vector<Vec3> swing_load(const Problem& problem, const System& system)
{
    const solvers::SampledStep step = solvers::sample_steps(problem, 1, kSampledStep).front();
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    std::vector<Vec3> b(step.x.size());
    objective.evaluate(step.prediction, b);
    for (Vec3& force : b)
        force = -force;
    return b;
}

/// A pull at the vertex that is farthest from the middle of the fixed ones [N].
std::vector<Vec3> drag_load(const Problem& problem)
{
    const std::vector<Vec3>& x = problem.start.positions;
    Vec3 sum = Vec3::Zero();
    int fixed_count = 0;
    for (int v = 0; v < problem.vertex_count(); ++v)
        if (problem.fixed[v]) {
            sum += x[v];
            ++fixed_count;
        }
    const Vec3 middle = sum / fixed_count;
    const auto farthest = std::max_element(x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) {
        return (a - middle).squaredNorm() < (b - middle).squaredNorm();
    });
    std::vector<Vec3> b(x.size(), Vec3::Zero());
    b[farthest - x.begin()] = Vec3(0.0, 1.0, 0.0);
    return b;
}

/// A rule, and what it is called in figures.
struct Variant {
    std::vector<std::pair<int, std::string>> names;
    RuleSettings rule;
};

std::vector<Variant> make_variants()
{
    std::vector<Variant> variants{{{{7, "near by Gaussian (paper)"},
                                    {8, "stacked (paper)"},
                                    {9, "near 70 %, middle 90 %, 8 clusters (paper)"}},
                                   {}}};
    const auto add = [&](int figure, const std::string& name) -> RuleSettings& {
        return variants.emplace_back(Variant{{{figure, name}}, {}}).rule;
    };
    add(7, "near by Gauss-Legendre").near_middle = NearMiddle::GaussLegendre;
    add(8, "subdivided").near_middle = NearMiddle::Subdivided;
    for (const int share : {60, 80})
        add(9, "near " + std::to_string(share) + " %").domains.near_influence = 0.01 * share;
    for (const int share : {80, 100})
        add(9, "middle " + std::to_string(share) + " %").domains.middle_influence = 0.01 * share;
    for (const int count : {4, 16})
        add(9, std::to_string(count) + " clusters").cluster_count = count;
    return variants;
}

/// Curves of a solver for every load and loop.
void add_curves(const Problem& problem, const System& system,
                std::vector<std::pair<std::string, GlobalStep>>& loads, GlobalSolver& solver, Curve curve,
                double seconds, std::vector<Curve>& curves)
{
    curve.setup_ms = best_ms(0.0, [&] { solver.update(system.matrix(), system.fixed()); });
    std::vector<Vec3> x;
    for (auto& [load, step] : loads)
        for (const auto& [loop, loop_name] : kLoops) {
            curve.problem = problem.mesh + " " + std::to_string(problem.vertex_count()) + ", " +
                            format("%g", problem.stiffness) + (problem.solid ? " Pa, " : " N/m, ") + load;
            curve.loop = loop_name;
            curve.points.clear();
            trace(
                curve, kIterations, seconds,
                [&, &step = step, loop = loop](int iterations) {
                    return step.solve(solver, loop, iterations, x);
                },
                [&, &step = step](Curve::Point& point) { step.judge(x, point); });
            curves.push_back(curve);
        }
}

} // namespace

std::vector<Curve> rule_curves(const Effort& effort)
{
    std::vector<Curve> curves;
    // With 2 500 vertices kernels reach about 1 and 11 cells of the bars, 3 and 33 of the sheets.
    for (const Problem& problem :
         {Problem::bar(effort.vertices, 2e3, kStep), Problem::bar(effort.vertices, 2e5, kStep),
          Problem::sheet(effort.vertices, 10.0, kStep), Problem::sheet(effort.vertices, 1e3, kStep)}) {
        const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
        system->prepare(problem.dt, problem.fixed);
        std::vector<std::pair<std::string, GlobalStep>> loads;
        loads.emplace_back("drag", GlobalStep(*system, drag_load(problem)));
        loads.emplace_back("swing", GlobalStep(*system, swing_load(problem, *system)));

        for (const Variant& variant : make_variants())
            for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact}) {
                PaperRule::Settings settings;
                settings.rule = variant.rule;
                settings.denominator = denominator;
                settings.voxels = half_edges_along(problem.start.positions, problem.start.triangles);
                std::vector<Curve> of_variant;
                add_curves(problem, *system, loads, *make_paper_rule(problem, settings), {}, effort.seconds,
                           of_variant);
                for (const auto& [figure, name] : variant.names)
                    for (Curve& curve : of_variant) {
                        curve.figure = figure;
                        curve.method =
                            name + (denominator == Denominator::Exact ? ", exact denominators" : "");
                        curves.push_back(curve);
                    }
            }
        Curve ours;
        ours.figure = 7;
        ours.method = "quadrature (Toile)";
        add_curves(problem, *system, loads, *make_quadrature(problem), ours, effort.seconds, curves);
    }
    std::stable_sort(curves.begin(), curves.end(),
                     [](const Curve& a, const Curve& b) { return a.figure < b.figure; });
    return curves;
}

} // namespace toile::research::paper
