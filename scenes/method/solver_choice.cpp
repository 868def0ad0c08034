#include "scenes/method/solver_choice.h"

#include <cstdio>

#include "core/base/error.h"
#include "core/linear/direct_solver.h"
#include "core/pd/newton/embedded_points.h"
#include "core/quadrature/auto_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "quadrature2d/geodesic_embedding.h"
#include "scenes/format/field.h"

namespace toile::scenes {

using scene::SolverMethod;

namespace {

/// Quoted names of the methods for which `holds`, for a message.
template <typename Condition>
std::string methods_that(const Condition& holds)
{
    std::string list;
    for (const auto& [word, method] : scene_format::Words<SolverMethod>::kAll)
        if (holds(method))
            list += (list.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    return list;
}

// Parts of solver_warnings_of(): empty if there is nothing to say.

std::string former_key_of(const Scene& scene)
{
    if (!scene.solver.tolerance)
        return {};
    char text[200];
    std::snprintf(
        text, sizeof text,
        "solver.tolerance [m] is solver.velocity_tolerance [m/s] now: %g m per step of %.4g s is %.3g m/s",
        *scene.solver.tolerance, scene.step_duration(), *scene.solver.tolerance / scene.step_duration());
    return text;
}

std::string ignored_friction_of(const Scene& scene)
{
    if (step_method_of(scene).outer == OuterMethod::Newton)
        return {};
    for (const auto& [name, fabric] : scene.fabrics)
        for (const auto& [key, value] : {std::pair{"stretch_damping", fabric.stretch_damping},
                                         {"shear_damping", fabric.shear_damping},
                                         {"bend_damping", fabric.bend_damping},
                                         {"bend_friction", fabric.bend_friction}})
            if (value.value_or(0.0) > 0.0)
                return "fabrics." + name + "." + key +
                       " has no effect: internal friction acts with Newton's method (solver.outer)";
    return {};
}

std::string ignored_step_error_of(const Scene& scene)
{
    const StepMethod method = step_method_of(scene);
    if (!scene.solver.step_error || method.substeps == 0)
        return {};
    return "solver.step_error has no effect: all steps are equal, " + std::to_string(method.substeps) +
           " a sample; see solver.substeps for when what moves chooses them";
}

} // namespace

StepMethod step_method_of(const Scene& scene)
{
    const scene::Solver& solver = scene.solver;
    const bool is_preview = solver.quality == scene::Quality::Preview;
    StepMethod method;
    const bool is_newton = !is_preview && !is_baseline(solver.method);
    method.outer = solver.outer.value_or(is_newton ? OuterMethod::Newton : OuterMethod::Lbfgs);
    method.integrator = solver.integrator.value_or(
        method.outer == OuterMethod::Newton ? Integrator::Bdf2 : Integrator::ImplicitEuler);
    method.velocity_tolerance = is_preview ? 0.12 : solver.quality == scene::Quality::Final ? 0.002 : 0.01;
    if (solver.tolerance)
        method.velocity_tolerance = *solver.tolerance / scene.step_duration();
    method.velocity_tolerance = solver.velocity_tolerance.value_or(method.velocity_tolerance);
    method.max_iterations = is_preview ? 30 : method.outer == OuterMethod::Newton ? 100 : 300;
    method.max_iterations = solver.max_iterations.value_or(method.max_iterations);
    // A named method prepares H for one step length; solids are rigid, and their motion has no estimate.
    const bool is_by_motion =
        method.outer == OuterMethod::Newton && solver.method == SolverMethod::Auto && scene.solids.empty();
    method.substeps = solver.substeps.value_or(is_by_motion ? 0 : scene::Solver::kSubsteps);
    method.step_error =
        solver.step_error.value_or(solver.quality == scene::Quality::Final ? 3e-5 : method.step_error);
    return method;
}

StepControl step_control_of(const Scene& scene)
{
    const StepMethod method = step_method_of(scene);
    return method.substeps > 0 ? StepControl::fixed(scene.frame_duration(), method.substeps)
                               : StepControl::by_motion(scene.frame_duration(), method.step_error);
}

std::vector<std::string> solver_warnings_of(const Scene& scene)
{
    std::vector<std::string> warnings;
    for (const std::string& text :
         {former_key_of(scene), ignored_friction_of(scene), ignored_step_error_of(scene)})
        if (!text.empty())
            warnings.push_back(scene.source.string() + ": " + text);
    return warnings;
}

std::vector<EmbeddedPoint> embedding_of(const garment::RestShape& rest)
{
    return quadrature2d::geodesic_embedding(
        rest.vertex_count(), quadrature2d::surface_metric(rest.triangles, rest.edges, rest.topology));
}

std::unique_ptr<GlobalSolver> make_global_solver(SolverMethod method,
                                                 std::shared_ptr<const garment::RestShape> rest,
                                                 const TriangleMesh& start, const std::string& source,
                                                 const TableSource& tables, const BaselineMethods* baselines)
{
    switch (method) {
    case SolverMethod::Direct:
        return std::make_unique<DirectSolver>();
    case SolverMethod::Quadrature:
        return std::make_unique<QuadratureSolver>(embedding_of(*rest), QuadratureSolver::Settings{},
                                                  tables.store, tables.listener);
    case SolverMethod::Auto:
        return std::make_unique<AutoSolver>([rest = std::move(rest)] { return embedding_of(*rest); },
                                            tables.store, tables.listener.warn);
    default:
        return baselines->make_global_solver(method, start, source);
    }
}

std::unique_ptr<GlobalSolver> make_solver_of_volume(SolverMethod method, const std::vector<Vec3>& rest,
                                                    const TableSource& tables)
{
    if (method == SolverMethod::Quadrature)
        return std::make_unique<QuadratureSolver>(embedded(rest), kTablesOfVolumes, tables.store,
                                                  tables.listener);
    return std::make_unique<DirectSolver>();
}

void require_methods(const Scene& scene, const BaselineMethods* baselines)
{
    const SolverMethod method = scene.solver.method;
    if (baselines == nullptr && is_baseline(method))
        throw InvalidInput(scene.source.string() + ": solver.method \"" + scene_format::word_of(method) +
                           "\" is a baseline to compare with; run it with toile-bench simulate, or choose " +
                           methods_that([](SolverMethod other) { return !is_baseline(other); }));
}

void require_method_supports(SolverMethod method, const scene::Attachment& attachment,
                             const std::string& location)
{
    if (attachment.stiffness && replaces_minimiser(method))
        throw InvalidInput(location + ".stiffness: solver.method \"" + scene_format::word_of(method) +
                           "\" knows no springs; remove the key to hold the vertices exactly, or choose " +
                           methods_that([](SolverMethod other) { return !replaces_minimiser(other); }));
}

} // namespace toile::scenes
