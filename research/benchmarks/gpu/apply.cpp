#include "research/benchmarks/gpu/apply.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/quadrature/cuda/quadrature.h"
#include "core/quadrature/quadrature_operator.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/gpu/copy.h"
#include "research/benchmarks/gpu/median_time.h"
#include "research/benchmarks/gpu/rough_load.h"
#include "research/benchmarks/solvers/problem.h"

namespace toile::research::gpu {

namespace {

constexpr double kMega = 1e6;

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double difference = 0.0, largest = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        difference = std::max(difference, (a[i] - b[i]).cwiseAbs().maxCoeff());
        largest = std::max(largest, b[i].cwiseAbs().maxCoeff());
    }
    return difference / largest;
}

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Apply measure_apply(const CudaSpace& space, int vertices, double stiffness, double dt)
{
    const solvers::Problem problem = solvers::Problem::sheet(vertices, stiffness, dt);
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(dt, problem.fixed);
    const std::vector<EmbeddedPoint> points = problem.points();

    Apply result;
    result.vertices = problem.vertex_count();
    const auto start = std::chrono::steady_clock::now();
    const std::shared_ptr<const QuadratureTables> tables =
        build_tables({system->matrix(), problem.fixed, points, {}}, {});
    result.build_s = seconds_since(start);
    result.gathers = tables->kernel.gathers_per_node();

    const std::vector<Vec3> load = rough_load(result.vertices);
    std::vector<Vec3> on_cpu(load.size());
    const QuadratureOperator cpu(tables);
    result.cpu_us = 1e3 * best_ms(0.2, [&] { cpu.solve(load, on_cpu); });

    const Eigen::VectorXd diagonal = system->matrix().diagonal();
    DeviceQuadrature device(space, *tables, {consecutive_rows(0, result.vertices)},
                            {{diagonal.data(), int(diagonal.size())}, KernelTable::Settings().tolerance});
    result.table_mb = double(device.table_bytes()) / kMega;
    DeviceArray<Vec3> b(space, "benchmarks/b"), x(space, "benchmarks/x", result.vertices);
    b.upload(load);
    device.solve(b.view(), x.view());
    result.difference = largest_difference(x.downloaded(), on_cpu);
    result.moments_us = median_us(space, [&] { device.gather_moments(b.view()); });
    result.gather_us = median_us(space, [&] { device.gather(x.view()); });
    result.solve_us = median_us(space, [&] { device.solve(b.view(), x.view()); });
    return result;
}

double copy_bandwidth(const CudaSpace& space, int megabytes)
{
    const int items = int(megabytes * kMega / sizeof(Floats<4>));
    DeviceArray<Floats<4>> from(space, "benchmarks/from", items), to(space, "benchmarks/to", items);
    from.fill_zero();
    const double us = median_us(space, [&] { launch(space, CopyItems{from.view(), to.view()}); });
    return 2.0 * megabytes * kMega / us * 1e-3;
}

} // namespace toile::research::gpu
