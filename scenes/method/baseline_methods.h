#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pd/step/point_masses.h"
#include "garment/energy/cloth_model.h"
#include "scenes/format/scene.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::scenes {

/// Methods of the literature that a scene can select as baselines. The product contains none of them; a
/// program that does passes them to its worlds (WorldOptions::baselines).
class BaselineMethods {
public:
    virtual ~BaselineMethods() = default;

    /// Makes the global solver of a baseline that keeps the minimiser: is_baseline() and not
    /// replaces_minimiser().
    /// @param start   the cloth as placed, its rest shape in space
    /// @param source  of the cloth, for messages
    /// @throws InvalidInput if the method does not support this cloth
    virtual std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method,
                                                             const TriangleMesh& start,
                                                             const std::string& source) const = 0;

    /// Makes the same on a GPU, for all cloths and bodies at once: runs_on_gpu() and is_baseline().
    virtual std::unique_ptr<DeviceSolver> make_device_solver(scene::SolverMethod method,
                                                             const CudaSpace& space) const = 0;

    /// Makes the body of a method that replaces the minimiser: replaces_minimiser().
    virtual std::unique_ptr<PointMasses> make_body(const scene::Solver& solver, std::vector<Vec3> positions,
                                                   garment::ClothModel cloth) const = 0;
};

} // namespace toile::scenes
