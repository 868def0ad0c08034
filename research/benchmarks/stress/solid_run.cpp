#include "research/benchmarks/stress/solid_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "core/pd/step/body.h"
#include "scenes/method/solver_choice.h"
#include "volume/mesh/quality.h"

namespace toile::research::stress {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDensity = 1000.0;   ///< [kg/m^3]
const Vec3 kGravity(0.0, -9.81, 0.0); ///< [m/s^2]

/// Newton's method with direct solves ends below this speed [m/s], or after this number of iterations.
constexpr double kExact = 1e-7;
constexpr int kMaxIterations = 200;

/// A body at one time.
struct State {
    std::vector<Vec3> x, v; ///< [vertices] [m], [m/s]
};

/// Tetrahedra with their masses, and the minimum that a step must reach. It shares the energy with the
/// solver, and no minimiser.
class Solid {
public:
    explicit Solid(const SolidCase& trial)
        : held_(trial.held), rest_(std::make_shared<volume::RestTets>(rest_tets(trial.mesh, trial.name))),
          elastic_(std::make_shared<volume::ElasticSolid>(
              rest_, std::vector<volume::Lame>(trial.mesh.tets.size(), trial.material.lame(trial.name)))),
          masses_(rest_->vertex_volumes()), curvature_(trial.mesh.vertex_count(), {elastic_})
    {
        for (double& mass : masses_)
            mass *= kDensity;
    }

    const std::shared_ptr<volume::ElasticSolid>& elastic() const { return elastic_; }
    const std::vector<double>& masses() const { return masses_; }

    double elastic_energy(View<const Vec3> x) const ///< [J]
    {
        std::vector<Vec3> unused(masses_.size(), Vec3::Zero());
        return elastic_->add_gradient(x, unused);
    }
    double energy(const State& at) const ///< kinetic, elastic and potential [J]
    {
        double sum = elastic_energy(at.x);
        for (size_t i = 0; i < masses_.size(); ++i)
            sum += masses_[i] * (0.5 * at.v[i].squaredNorm() - kGravity.dot(at.x[i]));
        return sum;
    }

    /// How far the end of a step is from the minimum of its objective.
    struct Error {
        double newton;   ///< [m/s] RMS of the exact Newton step there, over the step
        double distance; ///< [m/s] likewise of the distance
    };
    /// @param before, begin  states one step before and at the begin
    Error error(const Bdf2& scheme, const State& before, const State& begin, const std::vector<Vec3>& end);

private:
    /// 1/2 c |x - y|^2 + W(x), y where motion and gravity lead.
    struct Objective {
        std::vector<double> c; ///< [vertices] [N/m]
        std::vector<Vec3> y;   ///< [vertices] [m]
        double h;              ///< [s]
    };
    Objective objective_of(const Bdf2& scheme, const State& before, const State& begin) const;
    double evaluate(const Objective& objective, const std::vector<Vec3>& x, Eigen::VectorXd& gradient) const;
    struct Minimum {
        std::vector<Vec3> x;     ///< [vertices] [m]
        double first_step = 0.0; ///< [m/s] RMS of the first Newton step
    };
    Minimum minimum_near(const Objective& objective, std::vector<Vec3> x);
    double speed(const Eigen::VectorXd& displacement, double h) const;

    std::vector<unsigned char> held_;
    std::shared_ptr<const volume::RestTets> rest_;
    std::shared_ptr<volume::ElasticSolid> elastic_;
    std::vector<double> masses_; ///< [vertices] [kg]
    Curvature curvature_;
};

Solid::Objective Solid::objective_of(const Bdf2& scheme, const State& before, const State& begin) const
{
    const double step = scheme.implicit_step();
    Objective objective{{}, {}, scheme.h};
    for (size_t i = 0; i < masses_.size(); ++i) {
        const Vec3 v = scheme.a0 * begin.v[i] - scheme.a1 * before.v[i];
        objective.c.push_back(masses_[i] / (step * step));
        objective.y.emplace_back(scheme.a0 * begin.x[i] - scheme.a1 * before.x[i] +
                                 step * (v + step * kGravity));
    }
    return objective;
}

/// @param gradient  out: [3 vertices], zero where held [N]
double Solid::evaluate(const Objective& objective, const std::vector<Vec3>& x,
                       Eigen::VectorXd& gradient) const
{
    std::vector<Vec3> forces(x.size(), Vec3::Zero());
    double value = elastic_->add_gradient(x, forces);
    for (size_t i = 0; i < x.size(); ++i) {
        const Vec3 moved = held_[i] ? Vec3(Vec3::Zero()) : Vec3(x[i] - objective.y[i]);
        value += 0.5 * objective.c[i] * moved.squaredNorm();
        gradient.segment<3>(3 * Eigen::Index(i)) =
            held_[i] ? Vec3(Vec3::Zero()) : Vec3(objective.c[i] * moved + forces[i]);
    }
    return value;
}

/// RMS by mass of what is not held [m/s].
double Solid::speed(const Eigen::VectorXd& displacement, double h) const
{
    double sum = 0.0, mass = 0.0;
    for (size_t i = 0; i < masses_.size(); ++i)
        if (!held_[i]) {
            sum += masses_[i] * displacement.segment<3>(3 * Eigen::Index(i)).squaredNorm();
            mass += masses_[i];
        }
    return std::sqrt(sum / mass) / h;
}

/// The minimum that Newton's method with direct solves finds from x.
Solid::Minimum Solid::minimum_near(const Objective& objective, std::vector<Vec3> x)
{
    StepHessian hessian(curvature_, objective.c, held_);
    Eigen::VectorXd g(3 * Eigen::Index(x.size())), g_trial = g;
    double value = evaluate(objective, x, g), first_step = 0.0;
    for (int k = 0; k < kMaxIterations; ++k) {
        hessian.linearise(x, Definiteness::Projected);
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(hessian.matrix());
        const Eigen::VectorXd d = factor.solve(g);
        const double full = speed(d, objective.h);
        if (k == 0)
            first_step = full;
        if (full < kExact)
            break;
        // Halve the step until the value falls.
        double length = 2.0, value_trial = value;
        std::vector<Vec3> trial;
        do {
            length *= 0.5;
            trial = x;
            for (size_t i = 0; i < x.size(); ++i)
                trial[i] -= length * d.segment<3>(3 * Eigen::Index(i));
            value_trial = evaluate(objective, trial, g_trial);
        } while (!(value_trial < value) && length * full > kExact);
        if (!(value_trial < value))
            break;
        x = std::move(trial);
        value = value_trial;
        std::swap(g, g_trial);
    }
    return {std::move(x), first_step};
}

Solid::Error Solid::error(const Bdf2& scheme, const State& before, const State& begin,
                          const std::vector<Vec3>& end)
{
    const Minimum minimum = minimum_near(objective_of(scheme, before, begin), end);
    Eigen::VectorXd away(3 * Eigen::Index(end.size()));
    for (size_t i = 0; i < end.size(); ++i)
        away.segment<3>(3 * Eigen::Index(i)) = end[i] - minimum.x[i];
    return {minimum.first_step, speed(away, scheme.h)};
}

Body make_body(const SolidCase& trial, const Solid& solid, const scenes::StepMethod& method)
{
    Body::Settings settings;
    settings.tolerance = method.velocity_tolerance * trial.dt;
    settings.speed_tolerance = method.velocity_tolerance;
    settings.max_iterations = method.max_iterations;
    settings.outer = method.outer;
    settings.integrator = method.integrator;
    settings.extent = Extent::Volume;
    settings.begins_by_local_global = false;
    return Body(
        trial.start,
        std::make_unique<System>(solid.masses(), std::vector<std::shared_ptr<Energy>>{solid.elastic()}),
        settings);
}

bool is_finite(const State& at)
{
    const auto finite = [](const Vec3& p) { return p.allFinite(); };
    return std::all_of(at.x.begin(), at.x.end(), finite) && std::all_of(at.v.begin(), at.v.end(), finite);
}

State state_of(const Body& body)
{
    return {{body.positions().begin(), body.positions().end()},
            {body.velocities().begin(), body.velocities().end()}};
}

} // namespace

SolidResult run(const SolidCase& trial, const SolidLimits& limits, const std::function<bool(int)>& after_step)
{
    const scenes::StepMethod method = scenes::step_method_of(scenes::Scene{});
    const double tolerance = StepLimits::kCalm * method.velocity_tolerance; // [m/s]
    Solid solid(trial);
    Body body = make_body(trial, solid, method);
    const std::vector<Vec3> gravity(trial.start.size(), kGravity);
    const double weight = kDensity * quality_of(trial.mesh).volume * kGravity.norm(); // [N]
    const double scale = solid.elastic_energy(trial.start) + weight * bounds(trial.mesh.positions).diagonal();

    SolidResult result;
    result.name = trial.name;
    State before, begin = state_of(body);
    const double start_energy = solid.energy(begin);
    long iterations = 0;
    double seconds = 0.0;
    while (result.steps < trial.steps && result.is_finite) {
        const Clock::time_point start = Clock::now();
        const StepReport report =
            body.step(trial.dt, gravity, trial.held, trial.mesh.positions, nullptr, nullptr);
        seconds += std::chrono::duration<double>(Clock::now() - start).count();
        iterations += report.iterations;
        const State end = state_of(body);
        const double energy = solid.energy(end);
        result.is_finite =
            report.status != StepReport::Status::NonFinite && is_finite(end) && std::isfinite(energy);
        result.energy_gain = std::max(result.energy_gain, (energy - start_energy) / scale);
        if (report.status != StepReport::Status::Converged)
            ++result.unfinished;
        else {
            const Bdf2 scheme = Bdf2::make(result.steps == 0 ? Integrator::ImplicitEuler : method.integrator,
                                           trial.dt, trial.dt);
            const Solid::Error error = solid.error(scheme, result.steps == 0 ? begin : before, begin, end.x);
            result.newton = std::max(result.newton, error.newton / tolerance);
            result.distance = std::max(result.distance, error.distance / tolerance);
            result.wrong += error.distance <= limits.distance * tolerance ? 0 : 1;
        }
        before = std::move(begin);
        begin = end;
        ++result.steps;
        if (!after_step(result.steps))
            break;
    }
    result.iterations_per_step = double(iterations) / result.steps;
    result.ms_per_step = 1e3 * seconds / result.steps;
    volume::TetMesh at_end = trial.mesh;
    at_end.positions = begin.x;
    result.inverted = quality_of(at_end).inverted;
    result.holds = result.is_finite && result.wrong == 0 && result.energy_gain <= limits.energy_gain;
    return result;
}

} // namespace toile::research::stress
