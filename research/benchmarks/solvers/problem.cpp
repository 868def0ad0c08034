#include "research/benchmarks/solvers/problem.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/pd/minimiser/lbfgs.h"
#include "core/pd/minimiser/newton_direct.h"
#include "core/pd/minimiser/newton_pcg.h"
#include "core/pd/newton/embedded_points.h"
#include "core/pd/step/step_objective.h"
#include "garment/energy/membrane.h"
#include "garment/pattern/shapes.h"
#include "quadrature2d/geodesic_embedding.h"
#include "research/benchmarks/bar.h"

namespace toile::research::solvers {

namespace {

constexpr double kArealDensity = 0.15; ///< [kg/m^2]
constexpr double kRigidity = 5e-6;     ///< [N m]

constexpr double kDensity = 1000.0; ///< of a bar [kg/m^3]
constexpr double kPoisson = 0.3;
const Vec3 kBar(0.4, 0.1, 0.1); ///< [m]

/// Maximum decrease expected by Newton's method at a converged reference, as a fraction of the whole decrease
/// E(q*) - E* of the step [-]. Positions are then exact to about its square root.
constexpr double kConverged = 1e-10;

/// Limits of L-BFGS, which approaches the minimum, and of Newton's method, which finds it: maximum move in
/// the last step [m] and iterations, also of CG. If the Hessian is indefinite, on stiff cloth at long steps,
/// CG stops early and Newton's method converges slowly. L-BFGS and the projected Hessian then alternate with
/// it in several passes.
constexpr OuterLoop::Settings kApproach{0.0, 50};
constexpr OuterLoop::Settings kApproachAgain{0.0, 30};
/// Stops before convergence: a first exact step is solved too loosely to measure the remaining error.
constexpr OuterLoop::Settings kProjected{1e-5, 40};
constexpr OuterLoop::Settings kFinish{1e-9, 25};
constexpr int kFinishLinearIterations = 300;
constexpr int kMaxPasses = 8;

/// Maximum number of vertices for a last attempt with a factor of the whole Hessian, which can be projected.
constexpr int kFactorSize = 5500;
constexpr OuterLoop::Settings kFactorFinish{1e-10, 60};

/// Limits for steps between sampled ones.
constexpr OuterLoop::Settings kBetween{0.0, 20};
constexpr OuterLoop::Settings kBetweenFinish{0.0, 6};

/// Ball of the draping sheet: a cloth of 0.15 kg/m^2 penetrates it by a third of a millimetre.
const BallPenalty::Ball kBall{Vec3(0.03, -0.26, 0.05), 0.25, 5e4, 1e-3};

/// Height of the draping sheet's waves [m]. A flat sheet over the middle of a ball may fold in several
/// directions: its steps have several minimisers.
constexpr double kWave = 5e-3;

Problem make_problem(const std::string& name, TriangleMesh mesh, double stiffness, double dt)
{
    Problem problem;
    problem.mesh = name;
    problem.stiffness = stiffness;
    problem.dt = dt;
    problem.is_flat = name != "skirt";
    const Vec3 grain = problem.is_flat ? Vec3::UnitX() : Vec3::UnitY();
    problem.cloth.rest =
        std::make_shared<const garment::RestShape>(garment::rest_shape_of_surface(mesh, grain, 0.0, name));
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

TriangleMesh square_metre(int vertices)
{
    const double side = std::round(std::sqrt(double(vertices)));
    return garment::cut_rectangle(Vec2(1.0, 1.0), 1.0 / (side - 1.0));
}

/// Vertex that is farthest in a direction.
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
    Problem problem = make_problem("sheet", square_metre(vertices), stiffness, dt);
    problem.fixed[extreme(problem.start, Vec3(1, 0, 1))] = 1;
    problem.fixed[extreme(problem.start, Vec3(1, 0, -1))] = 1;
    return problem;
}

Problem Problem::skirt(int vertices, double stiffness, double dt)
{
    garment::SkirtCut cut;
    const double area = std::numbers::pi * (cut.waist_radius + cut.hem_radius) * cut.length;
    cut.resolution = std::sqrt(area / double(vertices));
    Problem problem = make_problem("skirt", cut_skirt(cut), stiffness, dt);
    const double waist = bounds(problem.start.positions).upper.y() - 0.5 * cut.resolution;
    for (int v = 0; v < problem.vertex_count(); ++v)
        problem.fixed[v] = problem.start.positions[v].y() > waist;
    return problem;
}

Problem Problem::drape(int vertices, double stiffness, double dt)
{
    Problem problem = make_problem("drape", square_metre(vertices), stiffness, dt);
    for (Vec3& p : problem.start.positions)
        p.y() = kWave * (std::sin(7.0 * p.x() + 4.0 * p.z() + 1.0) + std::sin(9.0 * p.z() - 3.0 * p.x()));
    problem.ball = kBall;
    return problem;
}

Problem Problem::bar(int vertices, double young, double dt)
{
    // 4c x c x c cells have about 4 (c + 1/2)^3 vertices.
    const int across = std::max(1, int(std::lround(std::cbrt(vertices / 4.0) - 0.5)));
    const volume::TetMesh tets = bar_of_tets(kBar, {4 * across, across, across});
    Problem problem;
    problem.mesh = "bar";
    problem.stiffness = young;
    problem.dt = dt;
    problem.is_flat = false;
    problem.start = {tets.positions, volume::boundary_triangles(tets.tets)};
    const auto rest = std::make_shared<const volume::RestTets>(rest_tets(tets, problem.mesh));
    problem.solid = Solid{rest, {young, kPoisson}, rest->vertex_volumes()};
    for (double& mass : problem.solid->masses)
        mass *= kDensity;
    for (const Vec3& p : tets.positions)
        problem.fixed.push_back(p.x() == 0.0);
    for (const volume::Tet& tet : tets.tets)
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                problem.mean_edge +=
                    (tets.positions[tet[a]] - tets.positions[tet[b]]).norm() / (6.0 * tets.tet_count());
    return problem;
}

std::unique_ptr<System> Problem::make_system(std::unique_ptr<GlobalSolver> solver) const
{
    if (solid) {
        const std::vector<volume::Lame> lame(solid->rest->tets.size(), solid->material.lame(mesh));
        return std::make_unique<System>(
            solid->masses,
            std::vector<std::shared_ptr<Energy>>{std::make_shared<volume::ElasticSolid>(solid->rest, lame)},
            std::move(solver));
    }
    const auto membrane = std::make_shared<garment::Membrane>(cloth.rest, cloth.stretch, mesh);
    const auto bending = std::make_shared<garment::Bending>(cloth.rest, cloth.bending, mesh);
    bending->leave_to(hessian_diagonal(*membrane, vertex_count()));
    std::vector<std::shared_ptr<Energy>> energies{membrane, bending};
    if (ball)
        energies.push_back(std::make_shared<BallPenalty>(*ball, cloth.rest->vertex_areas()));
    return std::make_unique<System>(cloth.masses, std::move(energies), std::move(solver));
}

std::vector<Vec2> Problem::chart() const
{
    std::vector<Vec2> uv;
    for (const Vec3& p : start.positions)
        uv.emplace_back(p.z(), p.x());
    return uv;
}

std::vector<EmbeddedPoint> Problem::points() const
{
    if (solid)
        return embedded(start.positions);
    const garment::RestShape& rest = *cloth.rest;
    return quadrature2d::geodesic_embedding(
        rest.vertex_count(), quadrature2d::surface_metric(rest.triangles, rest.edges, rest.topology));
}

std::vector<Vec3> Problem::acceleration() const
{
    return std::vector<Vec3>(start.positions.size(), Vec3(0.0, -9.81, 0.0));
}

namespace {

/// Computes q* of a step from its x and v.
void predict(const Problem& problem, SampledStep& step)
{
    const std::vector<Vec3> acceleration = problem.acceleration();
    step.prediction.resize(step.x.size());
    for (int v = 0; v < problem.vertex_count(); ++v)
        step.prediction[v] = problem.fixed[v]
                                 ? problem.start.positions[v]
                                 : Vec3(step.x[v] + problem.dt * (step.v[v] + problem.dt * acceleration[v]));
}

/// Minimises the step approximately, sufficient to continue the trajectory.
void advance(const Problem& problem, const System& system, SampledStep& step)
{
    predict(problem, step);
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    step.minimiser = step.prediction;
    (void)Lbfgs().minimise(objective, step.minimiser, kBetween);
    step.energy = NewtonPcg().minimise(objective, step.minimiser, kBetweenFinish).value;
}

/// Computes prediction and objective at q* of a step from its x and v.
void begin(const Problem& problem, const System& system, SampledStep& step)
{
    predict(problem, step);
    step.start_energy = objective(problem, system, step, step.prediction);
    step.is_converged = false;
}

/// Sets whether the decrease expected by Newton's method is negligible.
void judge(double decrement, SampledStep& step)
{
    step.is_converged = 0.5 * decrement <= kConverged * (step.start_energy - step.energy);
}

/// Minimises from step.minimiser to convergence.
OuterLoop::Outcome finish(StepObjective& objective, SampledStep& step)
{
    NewtonPcg newton(kFinishLinearIterations);
    const OuterLoop::Outcome outcome = newton.minimise(objective, step.minimiser, kFinish);
    step.energy = outcome.value;
    judge(newton.decrement(), step);
    return outcome;
}

} // namespace

void converge(const Problem& problem, const System& system, SampledStep& step)
{
    begin(problem, system, step);
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    step.minimiser = step.prediction;
    for (int pass = 0; pass < kMaxPasses && !step.is_converged; ++pass) {
        (void)Lbfgs().minimise(objective, step.minimiser, pass == 0 ? kApproach : kApproachAgain);
        if (pass > 0)
            (void)NewtonPcg(kFinishLinearIterations, Definiteness::Projected)
                .minimise(objective, step.minimiser, kProjected);
        (void)finish(objective, step);
    }
    if (!step.is_converged && problem.vertex_count() <= kFactorSize) {
        NewtonDirect newton;
        step.energy = newton.minimise(objective, step.minimiser, kFactorFinish).value;
        judge(newton.decrement(), step);
    }
}

void converge_near(const Problem& problem, const System& system, SampledStep& step)
{
    begin(problem, system, step);
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    for (int pass = 0; pass < kMaxPasses && !step.is_converged; ++pass) {
        const OuterLoop::Outcome outcome = finish(objective, step);
        // Newton's method started at the minimiser stays there, after one step too loose to measure the
        // remaining error.
        step.is_converged |= outcome.converged && outcome.iterations <= 1;
    }
}

std::vector<SampledStep> sample_steps(const Problem& problem, int count, int stride)
{
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(problem.dt, problem.fixed);
    std::vector<SampledStep> steps;
    SampledStep step;
    step.x = problem.start.positions;
    step.v.assign(step.x.size(), Vec3::Zero());
    for (int k = 1; k <= stride * count; ++k) {
        if (k % stride == 0)
            converge(problem, *system, step);
        else
            advance(problem, *system, step);
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
    return {step.x, step.prediction, system.diagonal(), system.fixed(), system.masses(), problem.dt};
}

double objective(const Problem& problem, const System& system, const SampledStep& step,
                 const std::vector<Vec3>& x)
{
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    std::vector<Vec3> gradient(x.size());
    return objective.evaluate(x, gradient);
}

} // namespace toile::research::solvers
