#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"
#include "core/pd/step/point_masses.h"
#include "research/benchmarks/solvers/problem.h"

namespace toile::research::gpu {

/// A step to be repeated by every method, with the velocities one step before and the end positions in the
/// limit of ever smaller steps.
struct Sample {
    solvers::SampledStep step;
    std::vector<Vec3> v_before; ///< [vertices] [m/s]
    std::vector<Vec3> limit;    ///< [vertices] [m]
};

/// A method on a GPU, ready to step one problem.
struct Contender {
    std::unique_ptr<PointMasses> masses;
    std::function<void(const Sample&)> begin; ///< sets the masses to the start of a sample
};

/// A method with a budget of work per step.
struct DeviceMethod {
    std::string name; ///< "xpbd 20": the method, and iterations, sweeps or substeps
    int parts = 1;    ///< steps into which it splits a sampled step; above 1 the number in its name
    std::function<Contender(const CudaSpace&, const solvers::Problem&)> make;
};

/// Our body with quadrature and an iteration limit per step.
std::unique_ptr<PointMasses> make_ours(const CudaSpace& space, const solvers::Problem& problem,
                                       double tolerance, int max_iterations);

/// XPBD in double precision; with ever more substeps it converges to the same limit as every method.
std::unique_ptr<PointMasses> make_xpbd(const CudaSpace& space, const solvers::Problem& problem, int substeps);

/// A global solver that runs on a GPU.
struct NamedSolver {
    std::string name;
    std::function<std::unique_ptr<GlobalSolver>(const CudaSpace&, const solvers::Problem&)> make;
};

/// Our solver ("quadrature") and the baselines that support the problem.
std::vector<NamedSolver> device_solvers(const solvers::Problem& problem);

/// Our method, the same L-BFGS around the baselines' global solvers, and complete baseline methods.
std::vector<DeviceMethod> device_methods(const solvers::Problem& problem);

} // namespace toile::research::gpu
