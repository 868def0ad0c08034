#include "research/benchmarks/gpu/rules.h"

#include <cmath>
#include <memory>
#include <utility>

#include "core/compute/cuda/array.h"
#include "core/linear/cholesky.h"
#include "core/linear/cuda/solver.h"
#include "research/benchmarks/gpu/contenders.h"
#include "research/benchmarks/gpu/median_time.h"
#include "research/benchmarks/gpu/rough_load.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::gpu {

namespace {

/// Load by inertia of a smooth wave.
std::vector<Vec3> smooth_load(const solvers::Problem& problem)
{
    std::vector<Vec3> load;
    for (int i = 0; i < problem.vertex_count(); ++i) {
        const Vec3& p = problem.start.positions[i];
        const Vec3 wave(0.01 * std::sin(4.0 * p.z()), 0.1 * std::cos(3.0 * p.x() + 2.0 * p.z()),
                        0.01 * std::cos(5.0 * p.x()));
        load.push_back(problem.fixed[i] ? Vec3::Zero()
                                        : Vec3(problem.cloth.masses[i] / (problem.dt * problem.dt) * wave));
    }
    return load;
}

/// A load and its exact solution H^-1 b.
struct Exact {
    std::vector<Vec3> b, x;

    Exact(const SparseMatrix& H, std::vector<Vec3> load) : b(std::move(load)), x(b.size())
    {
        Cholesky(H).solve(b, x);
    }
    double error_of(const GlobalSolver& solver) const
    {
        std::vector<Vec3> found(b.size());
        solver.solve(b, found);
        double error = 0.0, size = 0.0;
        for (size_t i = 0; i < x.size(); ++i) {
            error += (found[i] - x[i]).squaredNorm();
            size += x[i].squaredNorm();
        }
        return std::sqrt(error / size);
    }
};

std::vector<Row> rows_of(const std::vector<RuleApply>& rules)
{
    std::vector<Row> rows;
    rows.reserve(rules.size());
    for (const RuleApply& rule : rules)
        rows.push_back({std::to_string(rule.vertices), rule.name, format("%.1f", rule.solve_us),
                        format("%.2g", rule.smooth_error), format("%.2g", rule.rough_error)});
    return rows;
}

} // namespace

void measure_rules(const CudaSpace& space, int vertices, double stiffness, double dt,
                   std::vector<RuleApply>& rules)
{
    const auto problem = solvers::Problem::sheet(vertices, stiffness, dt);
    for (const NamedSolver& solver : device_solvers(problem)) {
        const std::unique_ptr<System> system = problem.make_system(solver.make(space, problem));
        system->prepare(dt, problem.fixed);
        const SparseMatrix& H = system->matrix();
        DeviceSolver& device_solver = *system->solver().on_device();
        std::vector<Vec3> rough = rough_load(problem.vertex_count());
        for (size_t i = 0; i < rough.size(); ++i)
            if (problem.fixed[i])
                rough[i].setZero();

        RuleApply rule{solver.name, problem.vertex_count()};
        rule.smooth_error = Exact(H, smooth_load(problem)).error_of(device_solver);
        rule.rough_error = Exact(H, rough).error_of(device_solver);
        DeviceArray<Vec3> b(space, "benchmarks/b"), x(space, "benchmarks/x", problem.vertex_count());
        b.upload(rough);
        rule.solve_us = median_us(space, [&] { device_solver.solve_on_device(b.view(), x.view()); });
        rules.push_back(rule);
    }
}

std::string markdown_of(const std::vector<RuleApply>& rules)
{
    return markdown({"vertices", "solver", "solve us", "error, smooth load", "error, rough load"},
                    rows_of(rules));
}

std::string csv_of(const std::vector<RuleApply>& rules)
{
    return csv({"vertices", "solver", "solve_us", "smooth_error", "rough_error"}, rows_of(rules));
}

} // namespace toile::research::gpu
