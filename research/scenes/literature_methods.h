#pragma once

#include "scenes/method/baseline_methods.h"

namespace toile::research {

/// Baselines available to scenes: global solvers from linear/ and paper_rule/, bodies from methods/.
class LiteratureMethods : public scenes::BaselineMethods {
public:
    std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method, const TriangleMesh& start,
                                                     const std::string& source) const override;

    std::unique_ptr<DeviceSolver> make_device_solver(scene::SolverMethod method,
                                                     const CudaSpace& space) const override;

    std::unique_ptr<PointMasses> make_body(const scene::Solver& solver, std::vector<Vec3> positions,
                                           garment::ClothModel cloth) const override;
};

} // namespace toile::research
