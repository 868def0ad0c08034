#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pd/minimiser/outer_method.h"
#include "core/pd/step/bdf2.h"
#include "core/quadrature/tables/table_store.h"
#include "garment/energy/rest_shape.h"
#include "scenes/format/solver_methods.h"
#include "scenes/method/baseline_methods.h"
#include "scenes/method/step_control.h"

namespace toile::scenes {

/// Source of a solver's quadrature tables, and listener to their construction.
struct TableSource {
    std::shared_ptr<TableStore> store = TableStore::of_process();
    TableListener listener;
};

/// Makes the global solver of a scene's method.
/// @param rest       kept by auto, which may need it later
/// @param start      the cloth as placed, its rest shape in space
/// @param tables     used by quadrature and auto; auto builds in the background and reports no progress
/// @param baselines  null: none; see require_methods()
/// @throws InvalidInput naming `source` if the method does not support this cloth
std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method,
                                                 std::shared_ptr<const garment::RestShape> rest,
                                                 const TriangleMesh& start, const std::string& source,
                                                 const TableSource& tables, const BaselineMethods* baselines);

/// Makes the global solver of a soft body: quadrature where the scene's method is, else the factor.
/// @param rest  [vertices] undeformed positions [m]
std::unique_ptr<GlobalSolver> make_solver_of_volume(scene::SolverMethod method, const std::vector<Vec3>& rest,
                                                    const TableSource& tables);

/// Quadrature in a volume. Its accuracy was measured in docs/journal/quadrature.md.
constexpr QuadratureTables::Settings kTablesOfVolumes{{0.07}, Extent::Volume};

/// Embedded points of a cloth's vertices for quadrature.
std::vector<EmbeddedPoint> embedding_of(const garment::RestShape& rest);

/// Minimiser of a scene's steps and its limits, where the scene leaves them open.
struct StepMethod {
    OuterMethod outer = OuterMethod::Newton;
    Integrator integrator = Integrator::Bdf2;
    double velocity_tolerance = 0.01; ///< [m/s]
    int max_iterations = 100;
    int substeps = 0;         ///< time steps of a sample; 0: chosen by what moves
    double step_error = 1e-4; ///< [m] of those, see StepControl
};
StepMethod step_method_of(const Scene& scene);

/// Division of a scene's samples into steps.
StepControl step_control_of(const Scene& scene);

/// Messages about keys of the scene that have another name now, or no effect: internal friction that its
/// minimiser ignores, an error of steps whose length nothing chooses.
std::vector<std::string> solver_warnings_of(const Scene& scene);

/// @throws InvalidInput if the scene's method is a baseline and there are none
void require_methods(const Scene& scene, const BaselineMethods* baselines);

/// @param location  of the attachment in its file, for the message
/// @throws InvalidInput if the method does not support attachments of this kind
void require_method_supports(scene::SolverMethod method, const scene::Attachment& attachment,
                             const std::string& location);

} // namespace toile::scenes
