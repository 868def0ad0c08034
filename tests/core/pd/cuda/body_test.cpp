#include "core/pd/cuda/body.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/linear/block_diagonal_solver.h"
#include "core/linear/cuda/solver.h"
#include "core/pd/energy/sliced_energy.h"
#include "core/pd/step/body.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/energy/springs.h"
#include "quadrature2d/geodesic_embedding.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/sheets.h"
#include "tests/garment/touching_plane.h"

/// Whole steps on a GPU compared with the CPU, both with quadrature.
namespace toile::test {

using namespace garment;
using namespace quadrature2d;

namespace {

constexpr double kDt = 1.0 / 60.0;

/// Swinging sheet: two corners fixed, one pulled by a spring.
struct Swing {
    Sheet sheet = make_sheet(Vec2(0.6, 0.4), 24, 16, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<unsigned char> fixed = std::vector<unsigned char>(sheet.uv.size(), 0);
    double bending = 1e-6;

    Swing()
    {
        fixed[sheet.at(0, 0)] = 1;
        fixed[sheet.at(24, 0)] = 1;
    }
    std::vector<std::shared_ptr<Energy>> energies(const Vec3& pull) const
    {
        const auto springs = std::make_shared<Springs>(
            std::vector<Springs::Spring>{{sheet.at(0, 16), 4.0}, {sheet.at(0, 16), 2.0}});
        springs->hold(0, pull);
        springs->hold(1, 2.0 * pull);
        return {std::make_shared<Membrane>(rest, Membrane::Settings{30.0, 20.0, 5.0}, "sheet"),
                std::make_shared<Bending>(rest, Bending::Settings{bending, 0.5 * bending}, "sheet"), springs};
    }
    std::vector<EmbeddedPoint> points() const
    {
        return geodesic_embedding(rest->vertex_count(),
                                  surface_metric(rest->triangles, rest->edges, rest->topology));
    }
};

/// Several equal sheets in one body, pulled in different directions.
class Swings {
public:
    explicit Swings(int count) : count_(count)
    {
        for (int k = 0; k < count; ++k) {
            const std::vector<Vec3> flat = swing_.sheet.flat();
            x_.insert(x_.end(), flat.begin(), flat.end());
            fixed_.insert(fixed_.end(), swing_.fixed.begin(), swing_.fixed.end());
        }
    }

    std::unique_ptr<System> system(std::unique_ptr<GlobalSolver> solver) const
    {
        std::vector<std::shared_ptr<Energy>> all;
        std::vector<double> masses;
        const int n = int(swing_.fixed.size());
        for (int k = 0; k < count_; ++k) {
            for (const auto& energy : swing_.energies(Vec3(0.1 + 0.05 * k, 0.3, 0.5)))
                all.push_back(std::make_shared<SlicedEnergy>(energy, k * n, n));
            const std::vector<double> swing_masses = masses_of(*swing_.rest, 0.2);
            masses.insert(masses.end(), swing_masses.begin(), swing_masses.end());
        }
        return std::make_unique<System>(masses, all, std::move(solver));
    }
    std::unique_ptr<GlobalSolver> solver() const
    {
        std::vector<BlockDiagonalSolver::Block> blocks;
        blocks.reserve(count_);
        for (int k = 0; k < count_; ++k)
            blocks.push_back(
                {consecutive_rows(k * int(swing_.fixed.size()), int(swing_.fixed.size())),
                 std::make_unique<QuadratureSolver>(swing_.points(), QuadratureSolver::Settings{})});
        return std::make_unique<BlockDiagonalSolver>(std::move(blocks));
    }
    /// @param weights  single ones for the iterates of the CPU
    std::unique_ptr<GlobalSolver>
    solver(const CudaSpace& space,
           DeviceQuadratureSolver::Weights weights = DeviceQuadratureSolver::Weights::Single) const
    {
        return std::make_unique<DeviceQuadratureSolver>(
            space, std::vector<DeviceQuadratureSolver::Part>(count_, {swing_.points(), {}}),
            TableStore::of_process(), weights);
    }

    const std::vector<Vec3>& start() const { return x_; }
    const std::vector<unsigned char>& fixed() const { return fixed_; }
    std::vector<Vec3> gravity() const { return std::vector<Vec3>(x_.size(), Vec3(0.0, -9.81, 0.3)); }

private:
    Swing swing_;
    int count_;
    std::vector<Vec3> x_;
    std::vector<unsigned char> fixed_;
};

Body::Settings exact()
{
    Body::Settings settings;
    settings.tolerance = 1e-5;
    settings.max_iterations = 500;
    return settings;
}

/// One step under gravity, with the start's fixed vertices.
StepReport step(PointMasses& body, const Swings& swings, ActiveSetEnergy* active = nullptr)
{
    return body.step(kDt, swings.gravity(), swings.fixed(), swings.start(), active, nullptr);
}

/// Copies positions and velocities of another body.
void start_where(const PointMasses& other, PointMasses& body)
{
    body.set_positions(other.positions());
    body.set_velocities(other.velocities());
}

std::vector<Vec3> copy_of(View<const Vec3> field) { return {field.begin(), field.end()}; }

double max_distance(View<const Vec3> a, View<const Vec3> b)
{
    double max = 0.0;
    for (int i = 0; i < a.size(); ++i)
        if (const double apart = (a[i] - b[i]).norm(); !(apart <= max)) // true for NaN too
            max = apart;
    return max;
}

/// Solver without an interface beyond that of any GPU solver.
class SomeSolver final : public DeviceSolver {
public:
    SomeSolver(const CudaSpace& space, std::unique_ptr<GlobalSolver> solver)
        : DeviceSolver(space), solver_(std::move(solver))
    {
    }
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override
    {
        solver_->update(H, fixed);
    }
    void solve_on_device(View<const Vec3> b, View<Vec3> x) const override
    {
        dynamic_cast<const DeviceSolver&>(*solver_).solve_on_device(b, x);
    }

private:
    std::unique_ptr<GlobalSolver> solver_;
};

/// A rough floor through the middle of the sheets.
TouchingPlane::Settings rough_floor()
{
    TouchingPlane::Settings floor;
    floor.height = 0.19;
    floor.stiffness = 50.0;
    floor.friction = 0.4;
    floor.normal_force = 0.01;
    return floor;
}

class DeviceBodyTest : public OnDevice {
protected:
    std::unique_ptr<DeviceBody> make_body(const Swings& swings, DeviceBody::Settings settings) const
    {
        return std::make_unique<DeviceBody>(space(), swings.start(), swings.system(swings.solver(space())),
                                            settings);
    }
};

/// Each step starts at the CPU's result: wrinkling cloth is chaotic in its last bits.
TEST_F(DeviceBodyTest, MovesAsOnTheCpu)
{
    for (const int count : {1, 3}) {
        const Swings swings(count);
        Body cpu(swings.start(), swings.system(swings.solver()), exact());
        const auto gpu = make_body(swings, {1e-5, 500});
        for (int k = 0; k < 20; ++k) {
            start_where(cpu, *gpu);
            const StepReport expected = step(cpu, swings), report = step(*gpu, swings);
            ASSERT_EQ(expected.status, StepReport::Status::Converged) << k;
            ASSERT_EQ(report.status, StepReport::Status::Converged)
                << k << ": " << report.iterations << " and " << expected.iterations << " iterations";
            EXPECT_NEAR(report.iterations, expected.iterations, 5 + 0.3 * expected.iterations) << k;
            EXPECT_NEAR(report.energy, expected.energy, 1e-5 * std::abs(expected.energy)) << k;
            EXPECT_LT(report.gradient_norm, 10.0 * expected.gradient_norm + 1e-6) << k;
            EXPECT_LT(max_distance(gpu->positions(), cpu.positions()), 5e-4) << count << ", step " << k;
        }
    }
}

/// So few iterations that rounding errors do not grow.
TEST_F(DeviceBodyTest, TakesTheIterationsOfTheCpu)
{
    const Swings swings(3);
    Body::Settings settings = exact();
    settings.max_iterations = 15;
    Body cpu(swings.start(), swings.system(swings.solver()), settings);
    const auto gpu = make_body(swings, {1e-5, 15});
    for (int k = 0; k < 10; ++k) {
        start_where(cpu, *gpu);
        const StepReport expected = step(cpu, swings), report = step(*gpu, swings);
        EXPECT_EQ(report.iterations, expected.iterations) << k;
        EXPECT_LT(max_distance(gpu->positions(), cpu.positions()), 1e-6) << k;
    }
}

TEST_F(DeviceBodyTest, StopsByItsMoveAsOnTheCpu)
{
    const Swings swings(2);
    Body::Settings settings = exact();
    settings.tolerance = 1e-3;
    settings.stop = StepStop::Move;
    DeviceBody::Settings device_settings{settings.tolerance, settings.max_iterations};
    device_settings.stop = StepStop::Move;
    Body cpu(swings.start(), swings.system(swings.solver()), settings);
    const auto gpu = make_body(swings, device_settings);
    int iterations = 0, by_error = 0;
    for (int k = 0; k < 10; ++k) {
        start_where(cpu, *gpu);
        const StepReport expected = step(cpu, swings), report = step(*gpu, swings);
        EXPECT_EQ(report.iterations, expected.iterations) << k;
        iterations += report.iterations;
    }
    const auto by_its_error = make_body(swings, {settings.tolerance, settings.max_iterations});
    for (int k = 0; k < 10; ++k)
        by_error += step(*by_its_error, swings).iterations;
    EXPECT_LT(iterations, by_error);
}

TEST_F(DeviceBodyTest, HandlesContactAsOnTheCpu)
{
    const Swings swings(2);
    TouchingPlane plane(swings.start(), rough_floor());
    Body::Settings settings = exact();
    settings.max_iterations = 15;
    Body cpu(swings.start(), swings.system(swings.solver()), settings);
    const auto gpu = make_body(swings, {1e-5, 15});
    for (int k = 0; k < 10; ++k) {
        start_where(cpu, *gpu);
        const StepReport expected = step(cpu, swings, &plane), report = step(*gpu, swings, &plane);
        EXPECT_GT(plane.pressing(copy_of(cpu.positions())), 5) << k;
        EXPECT_EQ(report.iterations, expected.iterations) << k;
        EXPECT_NEAR(report.linear_iterations, expected.linear_iterations, 2) << k;
        // Truncated after 15 iterations; PCG is in single precision on the GPU.
        EXPECT_LT(max_distance(gpu->positions(), cpu.positions()), 5e-5) << k;
    }
}

/// PCG's kernels then do not depend on the solver.
/// Both converge to the same minimiser, from the same start, by different preconditioners.
TEST_F(DeviceBodyTest, MinimisesByNewtonAsOnTheCpu)
{
    constexpr double kTolerance = 1e-4;
    Body::Settings settings = exact();
    settings.outer = OuterMethod::Newton;
    settings.speed_tolerance = kTolerance;
    DeviceBody::Settings device_settings;
    device_settings.outer = OuterMethod::Newton;
    device_settings.speed_tolerance = kTolerance;
    device_settings.max_iterations = settings.max_iterations;
    int equal = 0;
    for (const bool touches : {false, true}) {
        const Swings swings(3);
        TouchingPlane plane(swings.start(), rough_floor());
        Body cpu(swings.start(), swings.system(swings.solver()), settings);
        const auto gpu = make_body(swings, device_settings);
        for (int k = 0; k < 12; ++k) {
            start_where(cpu, *gpu);
            const StepReport expected = step(cpu, swings, touches ? &plane : nullptr);
            const StepReport report = step(*gpu, swings, touches ? &plane : nullptr);
            ASSERT_EQ(expected.status, StepReport::Status::Converged) << k;
            ASSERT_EQ(report.status, StepReport::Status::Converged)
                << k << ": " << report.iterations << " and " << expected.iterations << " iterations";
            EXPECT_NEAR(report.iterations, expected.iterations, 3 + 0.5 * expected.iterations) << k;
            EXPECT_LT(report.linear_iterations, 20 + 4 * expected.linear_iterations) << k;
            EXPECT_NEAR(report.energy, expected.energy, 1e-5 * std::abs(expected.energy)) << k;
            equal += max_distance(gpu->positions(), cpu.positions()) < 1e-4 ? 1 : 0;
        }
    }
    // Cloth may buckle to either side: out of the flat start, and where the plane presses it.
    EXPECT_GE(equal, 19);
}

DeviceBody::Settings second_order()
{
    DeviceBody::Settings settings;
    settings.outer = OuterMethod::Newton;
    settings.integrator = Integrator::Bdf2;
    return settings;
}

/// Steps of second order, so exact that CPU and GPU end at the same positions.
struct ExactSecondOrder {
    Body::Settings cpu = exact();
    DeviceBody::Settings gpu = second_order();

    ExactSecondOrder()
    {
        cpu.outer = gpu.outer;
        cpu.integrator = gpu.integrator;
        cpu.speed_tolerance = gpu.speed_tolerance = 1e-4;
        gpu.max_iterations = cpu.max_iterations;
    }
};

/// Sheets after six steps on the CPU: out of the flat start, cloth may buckle to either side.
std::unique_ptr<Body> buckled(const Swings& swings, const Body::Settings& settings)
{
    auto body = std::make_unique<Body>(swings.start(), swings.system(swings.solver()), settings);
    for (int k = 0; k < 6; ++k)
        step(*body, swings);
    return body;
}

/// A plane far below, and a vertex that touches something from when it is told to.
class TouchingVertex : public TouchingPlane {
public:
    bool touches = false;

    /// @param gpu  that makes the steps; null: the CPU does
    TouchingVertex(const Swings& swings, const CudaSpace* gpu)
        : TouchingPlane(swings.start(), far_below()), gpu_(gpu)
    {
    }
    void mark_touching(StepField, View<unsigned char> marks) override
    {
        if (!touches)
            return;
        unsigned char* mark = marks.data() + 40;
        if (gpu_)
            EXPECT_TRUE(cuda::fill(0, gpu_->stream(), mark, 1, 1) == cuda::Status::Good);
        else
            *mark = 1;
    }

private:
    static Settings far_below()
    {
        Settings plane;
        plane.height = -10.0;
        return plane;
    }

    const CudaSpace* gpu_;
};

/// Motion and rest of the second order, with its touch rule.
TEST_F(DeviceBodyTest, TakesStepsOfSecondOrderAsOnTheCpu)
{
    const ExactSecondOrder settings;
    const Swings swings(2);
    const auto first = buckled(swings, settings.cpu);
    Body cpu(swings.start(), swings.system(swings.solver()), settings.cpu);
    const auto gpu = make_body(swings, settings.gpu);
    start_where(*first, cpu);
    start_where(*first, *gpu);
    for (int k = 0; k < 6; ++k) {
        step(cpu, swings);
        step(*gpu, swings);
        EXPECT_LT(max_distance(gpu->positions(), cpu.positions()), 1e-4 * (k + 1)) << k;
    }
}

TEST_F(DeviceBodyTest, GoesOnAsIfARefusedStepHadNotBeenTried)
{
    const Swings swings(3);
    TouchingPlane plane(swings.start(), rough_floor());
    const auto first = make_body(swings, second_order()), second = make_body(swings, second_order());
    for (int k = 0; k < 6; ++k) {
        if (k % 2 == 1) {
            second->refuse_steps_beyond(1e-12);
            EXPECT_EQ(step(*second, swings, &plane).refused, 1) << k;
            second->refuse_steps_beyond(kAnyStepError);
        }
        step(*first, swings, k > 3 ? &plane : nullptr);
        step(*second, swings, k > 3 ? &plane : nullptr);
        ASSERT_EQ(copy_of(first->positions()), copy_of(second->positions())) << k;
    }
}

/// The first step in which a vertex of a stiff part touches is one of implicit Euler in all of it.
TEST_F(DeviceBodyTest, BeginsStiffPartsAnewAsOnTheCpu)
{
    const ExactSecondOrder settings;
    const Swings swings(2);
    const auto first = buckled(swings, settings.cpu);
    Body loose(swings.start(), swings.system(swings.solver()), settings.cpu);
    Body stiff(swings.start(), swings.system(swings.solver()), settings.cpu);
    const auto gpu = make_body(swings, settings.gpu);
    const std::vector<int> one_part(swings.start().size(), 0);
    stiff.set_stiff_parts(one_part);
    gpu->set_stiff_parts(one_part);
    for (PointMasses* body : {static_cast<PointMasses*>(&loose), static_cast<PointMasses*>(&stiff),
                              static_cast<PointMasses*>(gpu.get())})
        start_where(*first, *body);
    TouchingVertex of_cpu(swings, nullptr), of_gpu(swings, &space());
    for (int k = 0; k < 5; ++k) {
        of_cpu.touches = of_gpu.touches = k >= 2;
        step(loose, swings, &of_cpu);
        step(stiff, swings, &of_cpu);
        step(*gpu, swings, &of_gpu);
        EXPECT_LT(max_distance(gpu->positions(), stiff.positions()), 1e-4 * (k + 1)) << k;
        EXPECT_EQ(max_distance(loose.positions(), stiff.positions()) > 1e-3, k >= 2) << k;
    }
}

TEST_F(DeviceBodyTest, HasTheSameBitsOfNewtonEveryTime)
{
    const Swings swings(3);
    TouchingPlane plane(swings.start(), rough_floor());
    const auto first = make_body(swings, second_order()), second = make_body(swings, second_order());
    for (int k = 0; k < 8; ++k) {
        step(*first, swings, k > 3 ? &plane : nullptr);
        step(*second, swings, k > 3 ? &plane : nullptr);
        ASSERT_EQ(copy_of(first->positions()), copy_of(second->positions())) << k;
    }
}

TEST_F(DeviceBodyTest, HasTheSameContactBitsWithAnySolver)
{
    const Swings swings(2);
    TouchingPlane plane(swings.start(), rough_floor()), same(swings.start(), rough_floor());
    const auto known = make_body(swings, {1e-5, 15});
    DeviceBody unknown(space(), swings.start(),
                       swings.system(std::make_unique<SomeSolver>(space(), swings.solver(space()))),
                       {1e-5, 15});
    int of_pcg = 0;
    for (int k = 0; k < 3; ++k) {
        of_pcg += step(*known, swings, &plane).linear_iterations;
        (void)step(unknown, swings, &same);
        EXPECT_EQ(copy_of(known->positions()), copy_of(unknown.positions())) << k;
    }
    EXPECT_GT(of_pcg, 30);
}

TEST_F(DeviceBodyTest, ConvergesAsWellWithByteWeights)
{
    const Swings swings(2);
    const auto single = make_body(swings, {1e-5, 500});
    DeviceBody bytes(space(), swings.start(),
                     swings.system(swings.solver(space(), DeviceQuadratureSolver::Weights::Bytes)),
                     {1e-5, 500});
    int iterations = 0, expected = 0;
    for (int k = 0; k < 10; ++k) {
        const StepReport report = step(bytes, swings);
        ASSERT_EQ(report.status, StepReport::Status::Converged) << k;
        iterations += report.iterations;
        expected += step(*single, swings).iterations;
    }
    EXPECT_LT(iterations, 1.3 * expected);
}

TEST_F(DeviceBodyTest, HasTheSameBitsEveryTimeAndAllocatesNothingOnceWarm)
{
    const Swings swings(2);
    const auto first = make_body(swings, {1e-5, 30}), second = make_body(swings, {1e-5, 30});
    (void)step(*first, swings);
    EXPECT_EQ(allocations_of([&] {
                  for (int k = 0; k < 5; ++k)
                      (void)step(*first, swings);
              }),
              0);
    for (int k = 0; k < 6; ++k)
        (void)step(*second, swings);
    EXPECT_EQ(copy_of(first->positions()), copy_of(second->positions()));
    EXPECT_EQ(copy_of(first->velocities()), copy_of(second->velocities()));
}

TEST_F(DeviceBodyTest, ReleasesAndMovesFixedVertices)
{
    const Swings swings(1);
    Body cpu(swings.start(), swings.system(swings.solver()), exact());
    const auto gpu = make_body(swings, {1e-5, 500});
    std::vector<unsigned char> fixed = swings.fixed();
    std::vector<Vec3> targets = swings.start();
    for (int k = 0; k < 8; ++k) {
        if (k == 4)
            fixed[0] = 0;
        for (Vec3& target : targets)
            target.y() += 1e-3;
        (void)cpu.step(kDt, swings.gravity(), fixed, targets, nullptr, nullptr);
        ASSERT_EQ(gpu->step(kDt, swings.gravity(), fixed, targets, nullptr, nullptr).status,
                  StepReport::Status::Converged);
    }
    EXPECT_LT(max_distance(gpu->positions(), cpu.positions()), 2e-4);
    EXPECT_EQ(gpu->positions()[24], targets[24]);
}

TEST_F(DeviceBodyTest, ReportsAnEnergyThatIsNotFinite)
{
    const Swings swings(1);
    const auto body = make_body(swings, {1e-5, 30});
    std::vector<Vec3> x = swings.start();
    x[100].y() = std::numeric_limits<double>::quiet_NaN();
    body->set_positions(x);
    const StepReport report = step(*body, swings);
    EXPECT_EQ(report.status, StepReport::Status::NonFinite);
    EXPECT_NE(report.message.find("not finite"), std::string::npos);
}

TEST_F(DeviceBodyTest, RefusesSolversAndEnergiesOfTheCpu)
{
    const Swings swings(1);
    const CudaSpace other(0);
    EXPECT_NE(message_of<InvalidInput>([&] {
                  DeviceBody(space(), swings.start(), swings.system(swings.solver(other)), {});
              }).find("another stream"),
              std::string::npos);
    EXPECT_NE(message_of<InvalidInput>([&] {
                  DeviceBody(space(), swings.start(), swings.system(swings.solver()), {});
              }).find("does not run on a GPU"),
              std::string::npos);
}

} // namespace
} // namespace toile::test
