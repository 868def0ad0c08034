#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/pd/energy/system.h"
#include "core/quadrature/tables/table_store.h"
#include "research/benchmarks/solvers/ball_penalty.h"
#include "research/methods/baseline_method.h"
#include "volume/energy/elastic_solid.h"

namespace toile::research::solvers {

/// A solid in place of a cloth.
struct Solid {
    std::shared_ptr<const volume::RestTets> rest;
    volume::ElasticMaterial material;
    std::vector<double> masses; ///< [vertices] [kg]
};

/// One cloth that swings under gravity, attached at a few vertices, or falls onto a ball; or a bar.
struct Problem {
    std::string mesh;          ///< "sheet", "skirt", "drape" or "bar"
    TriangleMesh start;        ///< of a solid: all vertices, the surface's triangles
    garment::ClothModel cloth; ///< unless there is a solid
    std::optional<Solid> solid;
    std::vector<unsigned char> fixed; ///< [vertices]
    double stiffness = 0.0; ///< [N/m] of warp and weft, shear has a fifth; of a solid Young's modulus [Pa]
    double dt = 0.0;        ///< [s]
    double mean_edge = 0.0; ///< [m]
    bool is_flat = true;    ///< cloth initially in the plane y = 0
    std::optional<BallPenalty::Ball> ball;
    /// Tables of this problem alone, none from disk: their construction is measured.
    std::shared_ptr<TableStore> tables = std::make_shared<TableStore>();

    /// A square metre attached at two corners, or a skirt attached at its waist, of about `vertices`
    /// vertices.
    static Problem sheet(int vertices, double stiffness, double dt);
    static Problem skirt(int vertices, double stiffness, double dt);

    /// The sheet, free and slightly wavy, above a smooth penalty ball.
    static Problem drape(int vertices, double stiffness, double dt);

    /// A bar of tetrahedra, 0.4 m x 0.1 m x 0.1 m, attached at one end.
    static Problem bar(int vertices, double young, double dt);

    int vertex_count() const { return start.vertex_count(); }
    const std::vector<double>& masses() const { return solid ? solid->masses : cloth.masses; } ///< [kg]

    /// The Projective Dynamics objective of the body, around a global solver.
    std::unique_ptr<System> make_system(std::unique_ptr<GlobalSolver> solver) const;

    std::vector<Vec3> acceleration() const;    ///< [vertices] gravity [m/s^2]
    std::vector<EmbeddedPoint> points() const; ///< [vertices] of quadrature
    std::vector<Vec2> chart() const;           ///< [vertices] in the start plane of a flat cloth [m]
};

/// One implicit Euler step to be repeated by every method: its start and its exact end.
struct SampledStep {
    std::vector<Vec3> x, v;       ///< [vertices] at t0 [m], [m/s]
    std::vector<Vec3> prediction; ///< [vertices] q* [m]
    std::vector<Vec3> minimiser;  ///< [vertices] converged [m]
    double energy = 0.0;          ///< [J] objective at the minimiser
    double start_energy = 0.0;    ///< [J] objective at q*
    /// True if Newton's method expects no further decrease beyond 1e-10 of start_energy - energy.
    bool is_converged = false;
};

/// Minimises the step of `problem` from step.x and step.v, by L-BFGS and then by Newton's method with nearly
/// exact steps. Sets prediction, minimiser and energies.
/// @param system  of the problem around a good solver, prepared
void converge(const Problem& problem, const System& system, SampledStep& step);

/// Minimises from step.minimiser, which must be close already, by Newton's method alone. The step also counts
/// as converged if a restart of Newton's method moves no vertex by more than 1e-9 m.
void converge_near(const Problem& problem, const System& system, SampledStep& step);

/// Every `stride`-th of the first stride * count steps of the body, converged. The steps between them are
/// only minimised well enough for a smooth trajectory that provides the starts of sampled steps.
/// @throws std::runtime_error  naming the step, if an energy is not finite
std::vector<SampledStep> sample_steps(const Problem& problem, int count, int stride);

/// Inputs of the objective of a sampled step, borrowed.
/// @param system  of the problem, prepared
StepStart step_start(const Problem& problem, const System& system, const SampledStep& step);

/// Objective of a sampled step at x [J].
double objective(const Problem& problem, const System& system, const SampledStep& step,
                 const std::vector<Vec3>& x);

} // namespace toile::research::solvers
