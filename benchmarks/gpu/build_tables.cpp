#include "benchmarks/gpu/build_tables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "benchmarks/solvers/problem.h"
#include "core/linear/cholesky.h"
#include "core/quadrature/device_table_builder.h"
#include "quadrature2d/geodesic_places.h"

namespace toile::gpu {

namespace {

constexpr double kMega = 1e6;

/// The first build of a process also loads the kernels.
constexpr int kBuilds = 2;

/// Wall time of work() [s].
template <typename Work>
double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What a table is built from.
struct Input {
    SparseMatrix H;
    Eigen::VectorXd diagonal;
    ClusterTree tree;
    ClusterBasis basis;

    Input(SparseMatrix matrix, const std::vector<Place>& places, std::vector<int> nodes)
        : H(std::move(matrix)), diagonal(H.diagonal()), tree(places, std::move(nodes)), basis(tree, places)
    {
    }
    View<const double> diagonal_view() const { return {diagonal.data(), int(diagonal.size())}; }
};

/// A global step that nobody takes: only its matrix is wanted.
class NoSolver : public GlobalSolver {
public:
    void update(const SparseMatrix&, View<const unsigned char>) override {}
    void solve(View<const Vec3>, View<Vec3>) const override {}
    bool is_symmetric() const override { return true; }
};

Input input_of(int vertices, double stiffness, double dt)
{
    const solvers::Problem problem = solvers::Problem::sheet(vertices, stiffness, dt);
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<NoSolver>());
    system->prepare(dt, problem.fixed);
    const RestShape& rest = *problem.cloth.rest;
    const std::vector<Place> places =
        geodesic_places(rest.vertex_count(), surface_metric(rest.triangles, rest.edges, rest.topology));
    std::vector<int> nodes;
    for (int v = 0; v < problem.vertex_count(); ++v)
        if (!problem.fixed[v])
            nodes.push_back(v);
    return {system->matrix(), places, std::move(nodes)};
}

/// Times the parts of a build, the device waited for after each.
void measure_parts(const CudaSpace& space, const InvertedFactor& factor, const Input& input,
                   TableBuild& result)
{
    DeviceTableBuilder builder(space, factor, input.diagonal_view(), input.basis, {});
    const auto timed = [&](double& seconds, const auto& work) {
        seconds += seconds_of([&] {
            work();
            space.synchronise();
        });
    };
    for (int block = 0; block < builder.block_count(); ++block) {
        timed(result.solve_s, [&] { builder.solve(block); });
        timed(result.moments_s, [&] { builder.gather_moments(); });
        timed(result.lists_s, [&] { builder.append_lists(); });
    }
    result.peak_mb = double(space.memory().device_bytes) / kMega;
}

/// Compares leaf by leaf: where lists differ, weights can't be compared.
void compare(const KernelTable& table, const KernelTable& cpu, TableBuild::OnCpu& result)
{
    double largest = 0.0;
    for (const float weight : cpu.near_weights)
        largest = std::max(largest, std::abs(double(weight)));
    const auto same = [](const std::vector<int>& a, int a_first, int a_last, const std::vector<int>& b,
                         int b_first, int b_last) {
        return std::equal(a.begin() + a_first, a.begin() + a_last, b.begin() + b_first, b.begin() + b_last);
    };
    const auto differ = [&](const std::vector<float>& a, const std::vector<float>& b, long a_first,
                            long b_first, long count) {
        for (long k = 0; k < count; ++k)
            result.difference =
                std::max(result.difference, std::abs(double(a[a_first + k]) - b[b_first + k]) / largest);
    };
    const long near = KernelTable::kNearWeights, far = long(cpu.rank) * KernelTable::kTargets;
    for (size_t leaf = 0; leaf + 1 < cpu.near_first.size(); ++leaf) {
        const int a = table.near_first[leaf], b = cpu.near_first[leaf], c = table.far_first[leaf],
                  d = cpu.far_first[leaf];
        if (!same(table.near_leaf, a, table.near_first[leaf + 1], cpu.near_leaf, b,
                  cpu.near_first[leaf + 1]) ||
            !same(table.far_cluster, c, table.far_first[leaf + 1], cpu.far_cluster, d,
                  cpu.far_first[leaf + 1])) {
            ++result.different_leaves;
            continue;
        }
        differ(table.near_weights, cpu.near_weights, a * near, b * near,
               (cpu.near_first[leaf + 1] - b) * near);
        differ(table.far_weights, cpu.far_weights, c * far, d * far, (cpu.far_first[leaf + 1] - d) * far);
    }
}

} // namespace

TableBuild measure_build(const CudaSpace& space, int vertices, double stiffness, double dt, bool is_compared)
{
    const Input input = input_of(vertices, stiffness, dt);
    TableBuild result;
    result.vertices = int(input.H.rows());
    std::optional<Cholesky> cholesky;
    result.factor_s = seconds_of([&] { cholesky.emplace(input.H); });
    const SupernodalFactor& factor = cholesky->factor();

    std::optional<InvertedFactor> inverted;
    result.invert_s = seconds_of([&] { inverted.emplace(factor); });
    measure_parts(space, *inverted, input, result);
    std::optional<DeviceKernelTable> table;
    result.gpu_s = std::numeric_limits<double>::max();
    for (int k = 0; k < kBuilds; ++k) {
        table.reset();
        result.gpu_s = std::min(result.gpu_s, seconds_of([&] {
                                    table = build_kernel_table(space, factor, input.diagonal_view(),
                                                               input.basis, {}, {});
                                    space.synchronise();
                                }));
    }
    result.table_mb = double(table->bytes()) / kMega;

    if (is_compared) {
        std::optional<KernelTable> on_cpu;
        result.cpu.emplace();
        result.cpu->seconds = seconds_of([&] {
            on_cpu = build_kernel_table(factor, input.diagonal_view(), input.basis, {}, {});
        });
        compare(table->downloaded(), *on_cpu, *result.cpu);
    }
    return result;
}

} // namespace toile::gpu
