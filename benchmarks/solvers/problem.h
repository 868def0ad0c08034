#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/solvers/ball_penalty.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pd/system.h"
#include "core/quadrature/table_store.h"
#include "garment/rivals/rival.h"

namespace toile::solvers {

/// One cloth that swings under gravity, held by a few vertices, or falls onto a ball: what every method
/// steps.
struct Problem {
    std::string mesh; ///< "sheet", "skirt" or "drape"
    TriangleMesh start;
    ClothModel cloth;
    std::vector<unsigned char> fixed; ///< [vertices]
    double stiffness = 0.0;           ///< [N/m] of warp and weft; shear has a fifth
    double dt = 0.0;                  ///< [s]
    double mean_edge = 0.0;           ///< [m]
    bool is_flat = true;              ///< lies in the plane y = 0 before it falls
    std::optional<BallPenalty::Ball> ball;
    /// Of this problem alone and none from disk: their making is measured.
    std::shared_ptr<TableStore> tables = std::make_shared<TableStore>();

    /// A square metre held at two corners, or a skirt held at its waist, of about `vertices` vertices.
    static Problem sheet(int vertices, double stiffness, double dt);
    static Problem skirt(int vertices, double stiffness, double dt);

    /// The sheet, free and slightly wavy, above a smooth penalty ball.
    static Problem drape(int vertices, double stiffness, double dt);

    int vertex_count() const { return start.vertex_count(); }

    /// The Projective Dynamics objective of the cloth, around a global solver.
    std::unique_ptr<System> make_system(std::unique_ptr<GlobalSolver> solver) const;

    std::vector<Vec3> acceleration() const; ///< [vertices] gravity [m/s^2]
    std::vector<Place> places() const;      ///< [vertices] of quadrature
    std::vector<Vec2> chart() const;        ///< [vertices] the plane in which a flat cloth starts [m]
};

/// One implicit Euler step to be repeated by every method: from where it starts, and the exact end.
struct SampledStep {
    std::vector<Vec3> x, v;       ///< [vertices] at t0 [m], [m/s]
    std::vector<Vec3> prediction; ///< [vertices] q* [m]
    std::vector<Vec3> minimiser;  ///< [vertices] converged [m]
    double energy = 0.0;          ///< [J] objective there
    double start_energy = 0.0;    ///< [J] objective at q*
    /// Newton's method expects no further decrease beyond 1e-10 of start_energy - energy.
    bool is_converged = false;
};

/// Takes the step of `problem` from step.x and step.v: fills in prediction, minimiser and energies, by L-BFGS
/// and then by Newton's method with nearly exact steps.
/// @param system  of the problem around a good solver, prepared
void converge(const Problem& problem, const System& system, SampledStep& step);

/// The same from step.minimiser, which is close already, by Newton's method alone. It counts as converged too
/// where Newton's method, begun there again, moves no vertex by more than 1e-9 m.
void converge_near(const Problem& problem, const System& system, SampledStep& step);

/// Every `stride`-th of the first stride * count steps of the cloth, converged. The steps between them are
/// only minimised well enough for a trajectory that is smooth: they are where sampled steps start from.
/// @throws std::runtime_error  naming the step, where an energy is not finite
std::vector<SampledStep> sample_steps(const Problem& problem, int count, int stride);

/// A sampled step as an objective needs it, borrowed.
/// @param system  of the problem, prepared
StepStart step_start(const Problem& problem, const System& system, const SampledStep& step);

/// Objective of a sampled step at x [J].
double objective(const Problem& problem, const System& system, const SampledStep& step,
                 const std::vector<Vec3>& x);

} // namespace toile::solvers
