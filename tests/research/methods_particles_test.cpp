#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "garment/energy/membrane.h"
#include "research/methods/vbd/sweep_kernels.h"
#include "research/methods/vbd/vertex_block_descent.h"
#include "research/methods/xpbd/xpbd.h"
#include "research/methods/xpbd/xpbd_kernels.h"
#include "tests/core/compute/teams_on_cpu.h"
#include "tests/garment/sheets.h"

/// GPU kernels of the baselines, run on the CPU and compared with the CPU's baselines, which process eight
/// items at a time.
namespace toile::test {

using namespace garment;
using namespace research;

namespace {

/// Sheet with random velocities, fixed at one corner and pulled at another.
struct Stirred {
    Sheet sheet = make_sheet(Vec2(0.3, 0.25), 12, 10, Pattern::Irregular);
    ClothModel cloth;
    std::vector<Vec3> x = sheet.flat(), v, acceleration, targets;
    std::vector<unsigned char> fixed;
    std::vector<double> mobility;
    double dt = 1.0 / 120.0;

    Stirred()
    {
        cloth.rest = sheet.rest();
        cloth.masses = masses_of(*cloth.rest, 0.2);
        cloth.stretch = {300.0, 120.0, 20.0};
        cloth.bending = {5e-5, 2e-5};
        acceleration.assign(x.size(), Vec3(0.0, -9.81, 0.4));
        fixed.assign(x.size(), 0);
        fixed[sheet.at(0, 0)] = fixed[sheet.at(12, 0)] = 1;
        targets = x;
        targets[sheet.at(12, 0)].x() += 1e-3;
        for (size_t i = 0; i < x.size(); ++i) {
            v.push_back(0.5 * Vec3(std::sin(30.0 * x[i].z() + 1.0), std::cos(25.0 * x[i].x()),
                                   std::cos(35.0 * x[i].x() + 9.0 * x[i].z())));
            mobility.push_back(fixed[i] ? 0.0 : 1.0 / cloth.masses[i]);
        }
    }
    int size() const { return int(x.size()); }
    MembraneWeights weights() const { return Membrane(cloth.rest, cloth.stretch, "sheet").weights(); }
    SparseMatrix bending_matrix() const { return Bending(cloth.rest, cloth.bending, "sheet").matrix(); }

    /// Positions after a step of a baseline on the CPU.
    std::vector<Vec3> after(BaselineMethod& baseline) const
    {
        baseline.set_velocities(v);
        (void)baseline.step(dt, acceleration, fixed, targets);
        return {baseline.positions().begin(), baseline.positions().end()};
    }
};

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        max = std::max(max, (a[i] - b[i]).norm());
    return max;
}

template <typename Kernel>
void run_each(int count, const Kernel& kernel)
{
    for (int i = 0; i < count; ++i)
        kernel(i);
}

/// One step of XPBD by the GPU kernels.
template <typename T>
std::vector<Vec3> xpbd_step(const Stirred& from, int substeps, bool bends_by_forces)
{
    const ConstraintTable<T> table(from.cloth);
    const SlicedRows rows = sliced_rows_of(from.bending_matrix());
    std::vector<Vec3> x = from.x, v = from.v;
    std::vector<Particle> before(x.size()), after(x.size());
    const double h = from.dt / substeps;
    run_each(from.size(), BeginParticle{x, from.mobility, after, before});
    for (int s = 1; s <= substeps; ++s) {
        before.swap(after);
        run_teams<SlicedRows::kThreads>(
            from.size(), PredictParticle{bends_by_forces ? View<const int>(rows.first) : View<const int>(),
                                         rows.entries, v, from.acceleration, x, from.targets, h,
                                         double(s) / substeps, s == 1, before, after});
        const View<const CurvatureItem<T>> curvatures(table.curvatures);
        if (!bends_by_forces)
            for (const BlockRange& colour : table.curvature_colours)
                run_each(colour.count, ProjectCurvatureItem<T>{curvatures.subview(colour.first, colour.count),
                                                               table.entries, h, after});
        const View<const StrainItem<T>> strains(table.strains);
        for (const BlockRange& colour : table.strain_colours)
            run_each(colour.count, ProjectStrainItem<T>{strains.subview(colour.first, colour.count),
                                                        from.weights(), h, after});
    }
    run_each(from.size(), EndParticle{before, after, h, x, v});
    return x;
}

TEST(XpbdKernels, StepAsXpbd)
{
    const Stirred from;
    for (const bool by_forces : {true, false}) {
        Xpbd xpbd(from.x, from.cloth, {12, by_forces});
        const std::vector<Vec3> expected = from.after(xpbd);
        EXPECT_LT(max_distance(xpbd_step<double>(from, 12, by_forces), expected), 1e-10) << by_forces;
        EXPECT_LT(max_distance(xpbd_step<float>(from, 12, by_forces), expected), 2e-7) << by_forces;
    }
}

/// One step of vertex block descent by the GPU kernels.
template <typename T>
std::vector<Vec3> descent_step(const Stirred& from, int sweeps, double rho, bool lags_bending)
{
    const SweepTable<T> table(from.cloth, lags_bending);
    const SlicedRows rows = sliced_rows_of(from.bending_matrix());
    std::vector<Vec3> x = from.x, v = from.v, v_before(x.size(), Vec3::Zero());
    std::vector<Vec3> prediction(x.size()), last(x.size()), before_last(x.size());
    std::vector<Particle> particles(x.size());
    std::vector<PaddedVec3> lagged(lags_bending ? x.size() : 0);
    run_each(from.size(), BeginSweeps{x, v, v_before, from.acceleration, from.targets, from.mobility, from.dt,
                                      particles, prediction, last, before_last});
    double omega = 1.0;
    for (int sweep = 1; sweep <= sweeps; ++sweep) {
        if (lags_bending)
            run_teams<SlicedRows::kThreads>(from.size(),
                                            LagBending{rows.first, rows.entries, particles, lagged});
        const View<const SweepItem<T>> items(table.items);
        for (const BlockRange& colour : table.colours)
            run_teams<8>(colour.count, DescendVertex<T>{items.subview(colour.first, colour.count),
                                                        table.triangles, table.bends, lagged, from.weights(),
                                                        from.dt, prediction, particles});
        if (rho == 0.0)
            continue;
        omega = sweep == 1 ? 1.0 : sweep == 2 ? 2.0 / (2.0 - rho * rho) : 4.0 / (4.0 - rho * rho * omega);
        run_each(from.size(), AccelerateSweep{omega, particles, last, before_last});
    }
    run_each(from.size(), EndSweeps{particles, from.dt, x, v, v_before});
    return x;
}

TEST(SweepKernels, StepAsVertexBlockDescent)
{
    const Stirred from;
    for (const double rho : {0.0, 0.9}) {
        VertexBlockDescent descent(from.x, from.cloth, {20, 0.0, rho});
        const std::vector<Vec3> expected = from.after(descent);
        EXPECT_LT(max_distance(descent_step<double>(from, 20, rho, false), expected), 1e-10) << rho;
        EXPECT_LT(max_distance(descent_step<float>(from, 20, rho, false), expected), 2e-7) << rho;
    }
}

TEST(SweepKernels, WithLaggedBendingFindTheSameMinimiser)
{
    const Stirred from;
    const int sweeps = 1500;
    VertexBlockDescent descent(from.x, from.cloth, {sweeps, 0.0, 0.0});
    const std::vector<Vec3> expected = from.after(descent);
    EXPECT_LT(max_distance(descent_step<double>(from, sweeps, 0.0, true), expected), 1e-6);
}

} // namespace
} // namespace toile::test
