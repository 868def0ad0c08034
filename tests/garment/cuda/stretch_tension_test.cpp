#include "garment/energy/strain_limit/cuda/stretch_tension.h"

#include <algorithm>
#include <cmath>

#include "core/pd/cuda/body.h"
#include "core/pd/step/body.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "garment/energy/membrane.h"
#include "garment/energy/strain_limit/strain_limit.h"
#include "garment/energy/strain_limit/stretch_tension.h"
#include "quadrature2d/geodesic_embedding.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/energies_on_gpu.h"
#include "tests/garment/sheets.h"

/// Tension of strain limits on a GPU compared with the CPU.
namespace toile::test {

using namespace garment;
using namespace quadrature2d;

namespace {

constexpr double kLimit = 0.06;
constexpr double kStiffness = 250.0; // [N/m]
constexpr double kDt = 1.0 / 60.0;
constexpr double kRounding = 1e-12;

/// Positions stretched along u by the factor `stretch`, with waves across.
std::vector<Vec3> pulled(const Sheet& sheet, double stretch)
{
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p = Vec3(stretch * p.x(), 0.004 * std::sin(40 * p.x() + 9 * p.z()), p.z());
    return x;
}

std::shared_ptr<StretchTension> tension_of(const std::shared_ptr<const RestShape>& rest)
{
    return std::make_shared<StretchTension>(rest, StretchTension::Settings{kLimit, kStiffness, 1.0});
}

using DeviceStretchTensionTest = OnDevice;

TEST_F(DeviceStretchTensionTest, KeepsItsTensionFromStepToStepAsOnTheCpu)
{
    const Sheet sheet = make_sheet(Vec2(0.4, 0.3), 20, 15, Pattern::Irregular);
    const auto rest = sheet.rest();
    const auto on_cpu = tension_of(rest), on_gpu = tension_of(rest);
    EnergiesOnGpu gpu(space(), rest->vertex_count());
    ASSERT_TRUE(on_gpu->add_to(gpu.energies, 0));
    for (const double stretch : {1.1, 1.08, 1.05, 1.02, 3.0, 0.9, 0.9}) {
        const std::vector<Vec3> start = pulled(sheet, stretch), end = pulled(sheet, stretch + 0.01);
        on_cpu->begin_step(start);
        gpu.begin_step(start, kDt);
        expect_equal(gpu.pull(end), pull_of(*on_cpu, end), kRounding);
        on_cpu->remember(end);
        gpu.end_minimisation(end);
    }
}

TEST_F(DeviceStretchTensionTest, IsExactlyZeroOnASlackSheet)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 8, 8, Pattern::Irregular);
    const auto rest = sheet.rest();
    EnergiesOnGpu gpu(space(), rest->vertex_count());
    const auto tension = tension_of(rest);
    tension->add_to(gpu.energies, 0);
    for (int step = 0; step < 2; ++step) {
        gpu.begin_step(pulled(sheet, 1.0), kDt);
        const Pull pull = gpu.pull(pulled(sheet, 1.2)); // stretched within the step: visible in the next
        EXPECT_EQ(pull.energy, 0.0);
        EXPECT_EQ(largest_of(pull.gradient), 0.0);
        gpu.end_minimisation(pulled(sheet, 1.02));
    }
}

TEST_F(DeviceStretchTensionTest, KeepsClothsApartAndForgetsOneByOne)
{
    // A taut sheet behind vertices of no cloth, then a slack one with other settings.
    const int gap = 3;
    const Sheet taut = make_sheet(Vec2(0.2, 0.3), 7, 9, Pattern::Irregular);
    const Sheet other = make_sheet(Vec2(0.3, 0.1), 9, 3, Pattern::Irregular);
    const auto taut_rest = taut.rest(), other_rest = other.rest();
    const int n = taut_rest->vertex_count(), m = other_rest->vertex_count();
    const StretchTension::Settings stiff{0.02, 900.0, 0.01};
    const auto on_cpu = tension_of(taut_rest), on_gpu = tension_of(taut_rest);
    StretchTension other_host(other_rest, stiff);
    const auto other_device = std::make_shared<StretchTension>(other_rest, stiff);
    EnergiesOnGpu gpu(space(), gap + n + m);
    on_gpu->add_to(gpu.energies, gap);
    other_device->add_to(gpu.energies, gap + n);
    ASSERT_EQ(gpu.energies.all().size(), 1u);

    const auto together = [&](double stretch, double other_stretch) {
        std::vector<Vec3> x(gap, Vec3(7.0, 8.0, 9.0));
        for (const auto& part : {pulled(taut, stretch), pulled(other, other_stretch)})
            x.insert(x.end(), part.begin(), part.end());
        return x;
    };
    for (int step = 0; step < 3; ++step) {
        const std::vector<Vec3> x = together(1.09, step == 0 ? 1.0 : 1.05);
        const View<const Vec3> x_part = View<const Vec3>(x).subview(gap, n);
        const View<const Vec3> others = View<const Vec3>(x).subview(gap + n, m);
        if (step == 2) {
            on_cpu->forget();
            on_gpu->forget();
        }
        on_cpu->begin_step(x_part);
        other_host.begin_step(others);
        gpu.begin_step(x, kDt);
        Pull expected{0.0, std::vector<Vec3>(gap, Vec3::Zero())};
        for (const Pull& part : {pull_of(*on_cpu, x_part), pull_of(other_host, others)}) {
            expected.energy += part.energy;
            expected.gradient.insert(expected.gradient.end(), part.gradient.begin(), part.gradient.end());
        }
        expect_equal(gpu.pull(x), expected, kRounding);
        on_cpu->remember(x_part);
        other_host.remember(others);
        gpu.end_minimisation(x);
    }
}

TEST_F(DeviceStretchTensionTest, StoresNothingIfTheLimitIsElastic)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 8, 8, Pattern::Irregular);
    const auto rest = sheet.rest();
    const auto elastic = StretchTension::Settings::elastic(kLimit, kStiffness, 0.0);
    const auto on_cpu = std::make_shared<StretchTension>(rest, elastic),
               on_gpu = std::make_shared<StretchTension>(rest, elastic);
    EnergiesOnGpu gpu(space(), rest->vertex_count());
    on_gpu->add_to(gpu.energies, 0);
    for (const double stretch : {1.2, 1.0, 1.08}) {
        // Stretched within the step: visible at once.
        const std::vector<Vec3> start = pulled(sheet, 1.0), end = pulled(sheet, stretch);
        on_cpu->begin_step(start);
        gpu.begin_step(start, kDt);
        const Pull pull = gpu.pull(end);
        expect_equal(pull, pull_of(*on_cpu, end), kRounding);
        EXPECT_EQ(pull.energy > 0.0, stretch > 1.0 + kLimit);
        on_cpu->remember(end);
        gpu.end_minimisation(end);
    }
}

TEST_F(DeviceStretchTensionTest, IgnoresSlivers)
{
    // Two wide triangles, and one on the border whose altitude is a five-hundredth of its edge.
    const std::vector<Vec2> uv{{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.1}, {0.0, 0.1}, {0.05, -0.0002}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};
    const auto rest = std::make_shared<const RestShape>(rest_shape_of_pattern(uv, triangles, "test"));
    ASSERT_TRUE(rest->is_sliver(2));
    const auto tension = tension_of(rest);
    EnergiesOnGpu gpu(space(), 5);
    tension->add_to(gpu.energies, 0);
    std::vector<Vec3> x;
    x.reserve(uv.size());
    for (const Vec2& p : uv)
        x.emplace_back(p.x(), 0.0, p.y());
    x[4].z() = -0.002;
    gpu.begin_step(x, kDt);
    EXPECT_EQ(gpu.pull(x).energy, 0.0);
    x[2].x() += 0.02;
    gpu.begin_step(x, kDt);
    const Pull pull = gpu.pull(x);
    EXPECT_GT(pull.energy, 0.0);
    EXPECT_EQ(pull.gradient[4], Vec3(0.0, 0.0, 0.0));
}

TEST_F(DeviceStretchTensionTest, HasTheSameBitsTwiceAndAllocatesNothingInSteps)
{
    const Sheet sheet = make_sheet(Vec2(0.4, 0.3), 40, 30, Pattern::Irregular);
    const auto rest = sheet.rest();
    const auto run = [&] {
        EnergiesOnGpu gpu(space(), rest->vertex_count());
        const auto tension = tension_of(rest);
        tension->add_to(gpu.energies, 0);
        Pull pull;
        const auto step = [&](double stretch) {
            const std::vector<Vec3> x = pulled(sheet, stretch);
            gpu.begin_step(x, kDt);
            pull = gpu.pull(x);
            gpu.end_minimisation(x);
        };
        step(1.1);
        EXPECT_EQ(allocations_of([&] {
                      for (int k = 1; k < 5; ++k)
                          step(1.1 - 0.01 * k);
                  }),
                  0);
        return pull;
    };
    const Pull first = run(), second = run();
    EXPECT_GT(first.energy, 0.0);
    EXPECT_EQ(first.energy, second.energy);
    EXPECT_EQ(first.gradient, second.gradient);
}

/// Observes minimisers, like a strain limit that never clamps.
class OnlyObserves : public StrainLimit {
public:
    using StrainLimit::StrainLimit;
    void project(View<Vec3>, View<const double>, const std::function<bool()>&) override {}
};

/// Sheet too heavy for its stiffness, on two pins.
class HeavySheet {
public:
    std::unique_ptr<System> system(std::shared_ptr<StretchTension> tension,
                                   std::unique_ptr<GlobalSolver> solver) const
    {
        std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(rest_, Membrane::Settings{30.0, 30.0, 10.0}, "sheet")};
        if (tension)
            energies.push_back(std::move(tension));
        return std::make_unique<System>(masses_of(*rest_, 0.4), energies, std::move(solver));
    }
    std::vector<EmbeddedPoint> points() const
    {
        return geodesic_embedding(rest_->vertex_count(),
                                  surface_metric(rest_->triangles, rest_->edges, rest_->topology));
    }
    std::unique_ptr<DeviceBody> body(const CudaSpace& space, std::shared_ptr<StretchTension> tension) const
    {
        auto solver = std::make_unique<DeviceQuadratureSolver>(
            space, std::vector<DeviceQuadratureSolver::Part>{{points(), {}}});
        return std::make_unique<DeviceBody>(space, flat(), system(std::move(tension), std::move(solver)),
                                            DeviceBody::Settings{1e-5, 500});
    }
    const std::shared_ptr<const RestShape>& rest() const { return rest_; }
    std::vector<Vec3> flat() const { return sheet_.flat(); }
    std::vector<Vec3> gravity() const { return std::vector<Vec3>(sheet_.uv.size(), Vec3(0.0, -9.81, 0.3)); }
    std::vector<unsigned char> fixed() const
    {
        std::vector<unsigned char> fixed(sheet_.uv.size(), 0);
        fixed[sheet_.at(0, 0)] = fixed[sheet_.at(sheet_.columns, 0)] = 1;
        return fixed;
    }

private:
    Sheet sheet_ = make_sheet(Vec2(0.6, 0.4), 18, 12, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest_ = sheet_.rest();
};

TEST_F(DeviceStretchTensionTest, LimitsASheetOnTwoPinsAsOnTheCpu)
{
    const HeavySheet heavy;
    const auto on_cpu =
        std::make_shared<StretchTension>(heavy.rest(), StretchTension::Settings{0.06, 30.0, 1.0});
    const auto on_gpu =
        std::make_shared<StretchTension>(heavy.rest(), StretchTension::Settings{0.06, 30.0, 1.0});
    OnlyObserves limit(heavy.rest(), StrainLimit::Settings{0.06}, "sheet");
    limit.set_tension(on_cpu);
    Body::Settings settings;
    settings.tolerance = 1e-5;
    settings.max_iterations = 500;
    Body cpu(heavy.flat(),
             heavy.system(on_cpu,
                          std::make_unique<QuadratureSolver>(heavy.points(), QuadratureSolver::Settings{})),
             settings);
    const auto gpu = heavy.body(space(), on_gpu), without = heavy.body(space(), nullptr);
    const auto step = [&](PointMasses& body, StepProjection* projection) {
        return body.step(kDt, heavy.gravity(), heavy.fixed(), heavy.flat(), nullptr, projection).status;
    };
    double apart = 0.0;
    for (int k = 0; k < 20; ++k) {
        on_cpu->begin_step(cpu.positions());
        ASSERT_EQ(step(cpu, &limit), StepReport::Status::Converged) << k;
        ASSERT_EQ(step(*gpu, nullptr), StepReport::Status::Converged) << k;
        step(*without, nullptr);
        for (int v = 0; v < cpu.positions().size(); ++v)
            apart = std::max(apart, (gpu->positions()[v] - cpu.positions()[v]).norm());
    }
    EXPECT_LT(apart, 1e-3);
    EXPECT_NEAR(limit.max_strain(gpu->positions()), limit.max_strain(cpu.positions()), 1e-2);
    EXPECT_LT(limit.max_strain(gpu->positions()), 0.5 * limit.max_strain(without->positions()));
}

} // namespace
} // namespace toile::test
