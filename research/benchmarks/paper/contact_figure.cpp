#include <cmath>

#include "core/linear/field.h"
#include "core/pd/newton/embedded_points.h"
#include "core/pd/preconditioner/block_inverse.h"
#include "core/pd/preconditioner/nested_pcg.h"
#include "core/quadrature/quadrature_solver.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/contact_solver/cases.h"
#include "research/benchmarks/paper/figures.h"
#include "research/benchmarks/paper/half_edges.h"
#include "research/benchmarks/text_table.h"
#include "research/paper_rule/paper_rule.h"
#include "scenes/method/solver_choice.h"

namespace toile::research::paper {

namespace {

using contact_solver::Case;
using contact_solver::Kind;

const std::vector<int> kIterations{1, 2, 3, 5, 10, 20, 40, 80};

/// Limits of the reference solution.
constexpr Pcg::Settings kReference{.tolerance = 1e-12, .max_iterations = 2000};

using Precondition = std::function<void(View<const Vec3> r, View<Vec3> z)>;

/// (H + dH) z = g of a case, and its solution.
class ContactStep {
public:
    ContactStep(const Case& problem, double seconds)
        : problem_(problem), seconds_(seconds), n_(problem.system().vertex_count()),
          reference_(problem.system(), Case::kDt, {ContactPreconditioner::Exact, kReference}), solution_(n_)
    {
        reference_.update(problem.contact());
        (void)reference_.solve(problem.forces(), solution_);
        for (const double mass : problem.system().masses())
            inertia_.push_back(mass / (Case::kDt * Case::kDt));
        projection_.update(problem.contact(), inertia_, problem.system().fixed());
        block_.update(problem.contact(), problem.system().diagonal(), problem.system().fixed());
    }

    /// The paper's P_c: inertia and contact.
    Precondition contact_of_paper() const
    {
        return [this](View<const Vec3> r, View<Vec3> z) {
            projection_.apply(r, z);
            for (int i = 0; i < n_; ++i)
                z[i] /= inertia_[i];
        };
    }

    /// The paper's P_e[P_c(.)].
    Precondition nested_of_paper(const GlobalSolver& P_e) const
    {
        return [this, &P_e, s = std::vector<Vec3>(n_)](View<const Vec3> r, View<Vec3> z) mutable {
            projection_.apply(r, s);
            P_e.solve(s, z);
        };
    }

    /// E = (D + blocks)^-1.
    Precondition contact_of_toile() const
    {
        return [this](View<const Vec3> r, View<Vec3> z) { block_.apply(r, z); };
    }

    /// E r + E D P_e D E r.
    Precondition nested_of_toile(const GlobalSolver& P_e) const
    {
        return [this, &P_e, s = std::vector<Vec3>(n_)](View<const Vec3> r, View<Vec3> z) mutable {
            const View<const double> D = problem_.system().diagonal();
            block_.apply(r, s);
            for (int i = 0; i < n_; ++i)
                s[i] *= D[i];
            P_e.solve(s, s);
            for (int i = 0; i < n_; ++i)
                s[i] = r[i] + D[i] * s[i];
            block_.apply(s, z);
        };
    }

    Curve curve_of(const std::string& method, const Precondition& precondition)
    {
        const auto multiply = [&](View<const Vec3> p, View<Vec3> out) { reference_.multiply(p, out); };
        const View<const Vec3> g = problem_.forces();
        std::vector<Vec3> z(n_), r(n_);
        Curve curve;
        curve.figure = 11;
        curve.method = method;
        curve.loop = "pcg";
        trace(
            curve, kIterations, seconds_,
            [&](int iterations) {
                return Pcg().solve(multiply, precondition, g, z, {0.0, iterations, true}).iterations;
            },
            [&](Curve::Point& point) {
                multiply(z, r);
                std::vector<Vec3> e = solution_;
                axpy(-1.0, z, e);
                for (int i = 0; i < n_; ++i)
                    r[i] = g[i] - r[i];
                point.residual = std::sqrt(dot(r, r) / dot(g, g));
                point.error = std::sqrt(std::abs(dot(e, r)) / dot(solution_, g)); // r = (H + dH) e
            });
        return curve;
    }

private:
    const Case& problem_;
    double seconds_; ///< of repetitions
    int n_;
    NestedPcg reference_;
    std::vector<Vec3> solution_;
    std::vector<double> inertia_; ///< [vertices] M / dt^2 [N/m]
    PaperProjection projection_;
    BlockInverse block_;
};

/// The paper's rule for the bodies of a case.
PaperRule rule_of(const Case& problem)
{
    PaperRule::Settings settings;
    settings.voxels = half_edges_along(problem.rest(), problem.triangles());
    if (!problem.tets().empty())
        return {problem.rest(), problem.tets(), settings};
    std::vector<Vec2> uv;
    for (const Vec3& p : problem.rest())
        uv.emplace_back(p.x(), p.y());
    return {uv, problem.triangles(), settings};
}

/// Appends the curves of a case.
void add_curves(Kind kind, const std::string& name, const Effort& effort, double stiffness,
                std::vector<Curve>& curves)
{
    const Case problem(kind, effort.vertices, stiffness);
    const System& system = problem.system();
    PaperRule rule = rule_of(problem);
    // Tables of its own, none from disk: their construction is measured.
    QuadratureSolver quadrature(embedded(problem.rest()),
                                problem.tets().empty() ? QuadratureSolver::Settings{}
                                                       : scenes::kTablesOfVolumes,
                                std::make_shared<TableStore>());
    const double rule_ms = best_ms(0.0, [&] { rule.update(system.matrix(), system.fixed()); });
    const double quadrature_ms = best_ms(0.0, [&] { quadrature.update(system.matrix(), system.fixed()); });

    ContactStep step(problem, effort.seconds);
    const auto add = [&](const std::string& method, const Precondition& precondition, double setup_ms = 0.0) {
        Curve curve = step.curve_of(method, precondition);
        curve.problem =
            name + " " + std::to_string(system.vertex_count()) + ", contact " + format("%g", stiffness);
        curve.setup_ms = setup_ms;
        curves.push_back(std::move(curve));
    };
    add("P_c only (paper)", step.contact_of_paper());
    add("nested, literal rule (paper)", step.nested_of_paper(rule), rule_ms);
    add("nested, direct P_e (paper)", step.nested_of_paper(system.solver()));
    add("contact only (Toile)", step.contact_of_toile());
    add("nested, direct (Toile)", step.nested_of_toile(system.solver()));
    add("nested, quadrature (Toile)", step.nested_of_toile(quadrature), quadrature_ms);
}

} // namespace

std::vector<Curve> contact_curves(const Effort& effort)
{
    std::vector<Curve> curves;
    for (const auto& [kind, name] :
         {std::pair(Kind::Bars, "two bars"), std::pair(Kind::Stack, "five sheets")})
        for (const double stiffness : {collision::Contact::Settings{}.stiffness, 25.0})
            add_curves(kind, name, effort, stiffness, curves);
    return curves;
}

} // namespace toile::research::paper
