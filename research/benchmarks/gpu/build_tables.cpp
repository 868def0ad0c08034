#include "research/benchmarks/gpu/build_tables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/linear/cholesky.h"
#include "core/quadrature/cuda/table_builder.h"
#include "research/benchmarks/solvers/problem.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::gpu {

namespace {

constexpr double kMega = 1e6;

/// Number of builds; the first one of a process also loads the kernels.
constexpr int kBuilds = 2;

/// Wall time of work() [s].
template <typename Work>
double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Inputs of a table build.
struct Input {
    SparseMatrix H;
    Eigen::VectorXd diagonal;
    ClusterTree tree;
    ClusterBasis basis;

    Input(const SparseMatrix& matrix, const std::vector<EmbeddedPoint>& points, std::vector<int> nodes)
        : H(matrix), diagonal(H.diagonal()), tree(points, std::move(nodes)), basis(tree, points)
    {
    }
    View<const double> diagonal_view() const { return {diagonal.data(), int(diagonal.size())}; }
};

/// Placeholder of a global solver: only the system's matrix is used.
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
    const std::vector<EmbeddedPoint> points = problem.points();
    std::vector<int> nodes;
    for (int v = 0; v < problem.vertex_count(); ++v)
        if (!problem.fixed[v])
            nodes.push_back(v);
    return {system->matrix(), points, std::move(nodes)};
}

/// Times the parts of a build, waiting for the device after each.
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
    result.held_mb = double(space.memory().device_bytes) / kMega;
}

/// Entries of a leaf in a table, near or far.
struct LeafEntries {
    const int* entries;
    const float* weights;
    int count;
};

/// @param weights_of_entry  number of weights per entry
LeafEntries part_of(const std::vector<int>& first, const std::vector<int>& entries,
                    const std::vector<float>& weights, int weights_of_entry, int leaf)
{
    return {entries.data() + first[leaf], weights.data() + std::size_t(first[leaf]) * weights_of_entry,
            first[leaf + 1] - first[leaf]};
}

bool have_equal_entries(const LeafEntries& a, const LeafEntries& b)
{
    return std::equal(a.entries, a.entries + a.count, b.entries, b.entries + b.count);
}

double largest_difference(const LeafEntries& a, const LeafEntries& b, int weights_of_entry)
{
    double largest = 0.0;
    for (int k = 0; k < a.count * weights_of_entry; ++k)
        largest = std::max(largest, std::abs(double(a.weights[k]) - double(b.weights[k])));
    return largest;
}

/// Compares tables leaf by leaf; weights can only be compared if the lists are equal.
void compare(const KernelTable& table, const KernelTable& cpu, CpuBuild& result)
{
    constexpr int kNear = KernelTable::kNearWeights;
    const int far_weights = cpu.rank * KernelTable::kTargets;
    double largest = 0.0;
    for (const float weight : cpu.near_weights)
        largest = std::max(largest, std::abs(double(weight)));
    for (int leaf = 0; leaf + 1 < int(cpu.near_first.size()); ++leaf) {
        const LeafEntries near = part_of(table.near_first, table.near_leaf, table.near_weights, kNear, leaf);
        const LeafEntries cpu_near = part_of(cpu.near_first, cpu.near_leaf, cpu.near_weights, kNear, leaf);
        const LeafEntries far =
            part_of(table.far_first, table.far_cluster, table.far_weights, far_weights, leaf);
        const LeafEntries cpu_far =
            part_of(cpu.far_first, cpu.far_cluster, cpu.far_weights, far_weights, leaf);
        if (!have_equal_entries(near, cpu_near) || !have_equal_entries(far, cpu_far)) {
            ++result.different_leaves;
            continue;
        }
        result.difference = std::max({result.difference, largest_difference(near, cpu_near, kNear) / largest,
                                      largest_difference(far, cpu_far, far_weights) / largest});
    }
}

std::vector<Row> rows_of(const std::vector<TableBuild>& builds)
{
    std::vector<Row> rows;
    for (const TableBuild& b : builds) {
        const auto of_cpu = [&](const char* form, double value) { return b.cpu ? format(form, value) : "-"; };
        const CpuBuild cpu = b.cpu.value_or(CpuBuild{});
        rows.push_back({std::to_string(b.vertices), format("%.2f", b.factor_s), of_cpu("%.2f", cpu.seconds),
                        format("%.3f", b.gpu_s), format("%.3f", b.invert_s), format("%.3f", b.solve_s),
                        format("%.3f", b.moments_s), format("%.3f", b.lists_s),
                        of_cpu("%.1f", cpu.seconds / b.gpu_s), format("%.0f", b.table_mb),
                        format("%.0f", b.held_mb), of_cpu("%.0f", cpu.different_leaves),
                        of_cpu("%.1e", cpu.difference)});
    }
    return rows;
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
        result.cpu->seconds = seconds_of(
            [&] { on_cpu = build_kernel_table(factor, input.diagonal_view(), input.basis, {}, {}); });
        compare(table->downloaded(), *on_cpu, *result.cpu);
    }
    return result;
}

std::string markdown_of(const std::vector<TableBuild>& builds)
{
    return markdown({"vertices", "factor s", "CPU s", "GPU s", "invert s", "solve s", "moments s", "lists s",
                     "CPU / GPU", "table MB", "held MB", "other lists", "difference"},
                    rows_of(builds));
}

std::string csv_of(const std::vector<TableBuild>& builds)
{
    return csv({"vertices", "factor_s", "cpu_s", "gpu_s", "invert_s", "solve_s", "moments_s", "lists_s",
                "cpu_over_gpu", "table_mb", "held_mb", "other_lists", "difference"},
               rows_of(builds));
}

} // namespace toile::research::gpu
