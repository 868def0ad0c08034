#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/solvers/problem.h"
#include "core/backend/cuda/device.h"
#include "core/pd/point_masses.h"

namespace toile::gpu {

/// A step that every method repeats, how fast the cloth was a step before, and where it would be after ever
/// smaller steps.
struct Sample {
    solvers::SampledStep step;
    std::vector<Vec3> v_before; ///< [vertices] [m/s]
    std::vector<Vec3> limit;    ///< [vertices] [m]
};

/// A method on a GPU, ready to step one problem.
struct Contender {
    std::unique_ptr<PointMasses> masses;
    std::function<void(const Sample&)> begin; ///< puts the masses where a sample starts
};

/// A method with a budget of work per step.
struct DeviceMethod {
    std::string name; ///< "xpbd 20": the method, and iterations, sweeps or substeps
    int parts = 1;    ///< steps that it cuts a sampled step into; where more, that is its budget
    std::function<Contender(const CudaSpace&, const solvers::Problem&)> make;
};

/// Our body with quadrature, at most so many iterations a step.
std::unique_ptr<PointMasses> make_ours(const CudaSpace& space, const solvers::Problem& problem,
                                       double tolerance, int max_iterations);

/// XPBD in double precision, whose limit of ever more substeps is that of every method.
std::unique_ptr<PointMasses> make_xpbd(const CudaSpace& space, const solvers::Problem& problem, int substeps);

/// A global solver that runs on a GPU.
struct NamedSolver {
    std::string name;
    std::function<std::unique_ptr<GlobalSolver>(const CudaSpace&, const solvers::Problem&)> make;
};

/// Ours ("quadrature") and other people's that can be made for the problem.
std::vector<NamedSolver> device_solvers(const solvers::Problem& problem);

/// Ours, the same L-BFGS around other people's global solvers, and their whole methods.
std::vector<DeviceMethod> device_methods(const solvers::Problem& problem);

} // namespace toile::gpu
