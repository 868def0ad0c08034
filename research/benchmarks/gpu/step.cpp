#include "research/benchmarks/gpu/step.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/linear/block_diagonal_solver.h"
#include "core/pd/cuda/body.h"
#include "core/pd/energy/sliced_energy.h"
#include "core/pd/step/body.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "research/benchmarks/solvers/problem.h"

namespace toile::research::gpu {

namespace {

/// Warm-up steps that set the cloth swinging, and steps whose median counts.
constexpr int kWarmUp = 5, kSteps = 25, kCpuSteps = 3;

/// Equal sheets side by side, as one body.
class Cloths {
public:
    explicit Cloths(const StepCase& what)
        : what_(what), one_(solvers::Problem::sheet(what.vertices, what.stiffness, what.dt))
    {
        for (int k = 0; k < what.cloths; ++k) {
            start.insert(start.end(), one_.start.positions.begin(), one_.start.positions.end());
            fixed.insert(fixed.end(), one_.fixed.begin(), one_.fixed.end());
        }
        for (int v = 0; v < int(start.size()); ++v) {
            const int cloth = v / one_.vertex_count();
            start[v].x() += 2.0 * cloth;
        }
    }

    std::unique_ptr<System> system(std::unique_ptr<GlobalSolver> solver) const
    {
        const std::unique_ptr<System> one_system = one_.make_system(std::make_unique<DirectSolver>());
        std::vector<double> masses;
        std::vector<std::shared_ptr<Energy>> energies;
        for (int k = 0; k < what_.cloths; ++k) {
            masses.insert(masses.end(), one_system->masses().begin(), one_system->masses().end());
            for (const auto& energy : one_system->energies())
                energies.push_back(
                    std::make_shared<SlicedEnergy>(energy, k * one_.vertex_count(), one_.vertex_count()));
        }
        return std::make_unique<System>(std::move(masses), std::move(energies), std::move(solver));
    }

    std::unique_ptr<GlobalSolver> cpu_solver() const
    {
        std::vector<BlockDiagonalSolver::Block> blocks;
        blocks.reserve(what_.cloths);
        for (int k = 0; k < what_.cloths; ++k)
            blocks.push_back({consecutive_rows(k * one_.vertex_count(), one_.vertex_count()),
                              std::make_unique<QuadratureSolver>(one_.points(), QuadratureSolver::Settings{},
                                                                 one_.tables)});
        return std::make_unique<BlockDiagonalSolver>(std::move(blocks));
    }
    std::unique_ptr<GlobalSolver> device_solver(const CudaSpace& space,
                                                DeviceQuadratureSolver::Weights weights) const
    {
        return std::make_unique<DeviceQuadratureSolver>(
            space, std::vector<DeviceQuadratureSolver::Part>(what_.cloths, {one_.points(), {}}), one_.tables,
            weights);
    }

    std::vector<Vec3> start;
    std::vector<unsigned char> fixed;

private:
    StepCase what_;
    solvers::Problem one_;
};

/// Median over `count` calls [ms].
template <typename Work>
double median_ms(int count, const Work& work)
{
    std::vector<double> times;
    for (int k = 0; k < count; ++k) {
        const auto start = std::chrono::steady_clock::now();
        work();
        times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(times.begin(), times.begin() + count / 2, times.end());
    return times[count / 2];
}

double largest_difference(View<const Vec3> a, View<const Vec3> b)
{
    double largest = 0.0;
    for (int i = 0; i < a.size(); ++i)
        largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

} // namespace

Step measure_step(const CudaSpace& space, const StepCase& what)
{
    const Cloths cloths(what);
    const std::vector<Vec3> gravity(cloths.start.size(), Vec3(0.0, -9.81, 0.0));

    // No move is below a tolerance of zero: every step takes all its iterations.
    Body::Settings settings;
    settings.tolerance = 0.0;
    settings.max_iterations = what.iterations;
    Body cpu(cloths.start, cloths.system(cloths.cpu_solver()), settings);
    const auto step = [&](PointMasses& body) {
        return body.step(what.dt, gravity, cloths.fixed, cloths.start, nullptr, nullptr).iterations;
    };
    step(cpu); // builds the tables, once for both

    using Weights = DeviceQuadratureSolver::Weights;
    const auto body_with = [&](Weights weights) {
        auto body = std::make_unique<DeviceBody>(
            space, cloths.start, cloths.system(cloths.device_solver(space, weights)),
            DeviceBody::Settings{settings.tolerance, settings.max_iterations});
        step(*body);
        return body;
    };
    const std::unique_ptr<DeviceBody> body = body_with(Weights::Bytes);
    DeviceBody& device = *body;

    Step result;
    result.cloths = what.cloths;
    result.vertices = int(cloths.start.size()) / what.cloths;
    result.difference = largest_difference(body_with(Weights::Single)->positions(), cpu.positions());
    result.bytes_difference = largest_difference(device.positions(), cpu.positions());
    for (int k = 0; k < kWarmUp; ++k)
        step(device);
    int iterations = 0;
    result.device_ms = median_ms(kSteps, [&] { iterations += step(device); });
    result.iterations = double(iterations) / kSteps;
    result.cpu_ms = median_ms(kCpuSteps, [&] { step(cpu); });
    return result;
}

} // namespace toile::research::gpu
