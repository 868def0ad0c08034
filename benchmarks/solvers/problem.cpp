#include "benchmarks/solvers/problem.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/pd/lbfgs.h"
#include "core/pd/newton_direct.h"
#include "garment/pattern/shapes.h"

namespace toile::solvers {

namespace {

constexpr double kArealDensity = 0.15; ///< [kg/m^2]
constexpr double kRigidity = 5e-6;     ///< [N m]

/// Share of the step's whole decrease E(q*) - E* that Newton's method may still expect when a reference
/// counts as converged [-]: positions are then exact to about the root of it.
constexpr double kConverged = 1e-10;

/// L-BFGS finds the valley, Newton's method its bottom: the longest move of its last step [m], where it gives
/// up.
constexpr OuterLoop::Settings kApproach{0.0, 50};
constexpr OuterLoop::Settings kFinish{1e-10, 60};

Problem make_problem(const std::string& name, TriangleMesh mesh, double stiffness, double dt)
{
    Problem problem;
    problem.mesh = name;
    problem.stiffness = stiffness;
    problem.dt = dt;
    const Vec3 grain = name == "sheet" ? Vec3::UnitX() : Vec3::UnitY();
    problem.cloth.rest = std::make_shared<const RestShape>(rest_shape_of_surface(mesh, grain, 0.0, name));
    problem.cloth.stretch = {stiffness, stiffness, 0.2 * stiffness};
    problem.cloth.bending = {kRigidity, kRigidity};
    problem.cloth.masses = problem.cloth.rest->vertex_areas();
    for (double& mass : problem.cloth.masses)
        mass *= kArealDensity;
    const std::vector<Edge>& edges = problem.cloth.rest->topology.edges;
    for (const Edge& edge : edges)
        problem.mean_edge +=
            (mesh.positions[edge.vertex[0]] - mesh.positions[edge.vertex[1]]).norm() / double(edges.size());
    problem.fixed.assign(mesh.positions.size(), 0);
    problem.start = std::move(mesh);
    return problem;
}

/// The vertex farthest in a direction.
int extreme(const TriangleMesh& mesh, const Vec3& direction)
{
    return int(
        std::max_element(mesh.positions.begin(), mesh.positions.end(),
                         [&](const Vec3& a, const Vec3& b) { return direction.dot(a) < direction.dot(b); }) -
        mesh.positions.begin());
}

} // namespace

Problem Problem::sheet(int vertices, double stiffness, double dt)
{
    const double side = std::round(std::sqrt(double(vertices)));
    Problem problem = make_problem("sheet", cut_rectangle(Vec2(1.0, 1.0), 1.0 / (side - 1.0)), stiffness, dt);
    problem.fixed[extreme(problem.start, Vec3(1, 0, 1))] = 1;
    problem.fixed[extreme(problem.start, Vec3(1, 0, -1))] = 1;
    return problem;
}

Problem Problem::skirt(int vertices, double stiffness, double dt)
{
    SkirtCut cut;
    const double area = std::numbers::pi * (cut.waist_radius + cut.hem_radius) * cut.length;
    cut.resolution = std::sqrt(area / double(vertices));
    Problem problem = make_problem("skirt", cut_skirt(cut), stiffness, dt);
    const double waist = bounds(problem.start.positions).upper.y() - 0.5 * cut.resolution;
    for (int v = 0; v < problem.vertex_count(); ++v)
        problem.fixed[v] = problem.start.positions[v].y() > waist;
    return problem;
}

std::unique_ptr<System> Problem::make_system(std::unique_ptr<GlobalSolver> solver) const
{
    const auto membrane = std::make_shared<Membrane>(cloth.rest, cloth.stretch, mesh);
    const auto bending = std::make_shared<Bending>(cloth.rest, cloth.bending, mesh);
    bending->leave_to(hessian_diagonal(*membrane, vertex_count()));
    return std::make_unique<System>(cloth.masses, std::vector<std::shared_ptr<Energy>>{membrane, bending},
                                    std::move(solver));
}

std::vector<Vec3> Problem::acceleration() const
{
    return std::vector<Vec3>(start.positions.size(), Vec3(0.0, -9.81, 0.0));
}

namespace {

/// Fills in prediction, minimiser and energies of a step whose x and v are set.
void converge(const Problem& problem, const System& system, SampledStep& step)
{
    const std::vector<Vec3> acceleration = problem.acceleration();
    step.prediction.resize(step.x.size());
    for (int v = 0; v < problem.vertex_count(); ++v)
        step.prediction[v] = problem.fixed[v]
                                 ? problem.start.positions[v]
                                 : Vec3(step.x[v] + problem.dt * (step.v[v] + problem.dt * acceleration[v]));

    StepObjective objective(system, step_start(problem, system, step), nullptr, Pcg::Settings{});
    step.minimiser = step.prediction;
    step.start_energy = Lbfgs().minimise(objective, step.minimiser, {0.0, 0}).value;
    (void)Lbfgs().minimise(objective, step.minimiser, kApproach);
    NewtonDirect newton;
    step.energy = newton.minimise(objective, step.minimiser, kFinish).value;
    step.is_converged = 0.5 * newton.decrement() <= kConverged * (step.start_energy - step.energy);
}

} // namespace

std::vector<SampledStep> sample_steps(const Problem& problem, int count, int stride)
{
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(problem.dt, problem.fixed);
    std::vector<SampledStep> steps;
    SampledStep step;
    step.x = problem.start.positions;
    step.v.assign(step.x.size(), Vec3::Zero());
    for (int k = 1; k <= stride * count; ++k) {
        converge(problem, *system, step);
        if (!std::isfinite(step.energy))
            throw std::runtime_error("solvers: step " + std::to_string(k) + " of the reference on " +
                                     problem.mesh + " is not finite");
        if (k % stride == 0)
            steps.push_back(step);
        for (size_t v = 0; v < step.x.size(); ++v)
            step.v[v] = (step.minimiser[v] - step.x[v]) / problem.dt;
        step.x = step.minimiser;
    }
    return steps;
}

StepStart step_start(const Problem& problem, const System& system, const SampledStep& step)
{
    return {step.x, step.prediction, system.diagonal(), system.fixed(), problem.dt};
}

double objective(const Problem& problem, const System& system, const SampledStep& step,
                 const std::vector<Vec3>& x)
{
    StepObjective objective(system, step_start(problem, system, step), nullptr, Pcg::Settings{});
    std::vector<Vec3> gradient(x.size());
    return objective.evaluate(x, gradient);
}

} // namespace toile::solvers
