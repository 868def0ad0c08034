#include "core/compute/cuda/runtime/graph.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/energies_on_gpu.h"
#include "tests/garment/cuda/two_cloths.h"

/// Internal friction of membrane and bending on a GPU compared with the CPU.
namespace toile::test {

namespace {

constexpr double kRounding = 2e-6; // forces are gathered in single precision

/// Sum of several energies.
Pull pull_of(const std::vector<std::shared_ptr<Energy>>& energies, const std::vector<Vec3>& x)
{
    Pull sum{0.0, std::vector<Vec3>(x.size(), Vec3::Zero())};
    for (const auto& energy : energies)
        sum.energy += energy->add_gradient(x, sum.gradient);
    return sum;
}

class DeviceFriction : public OnDevice {
protected:
    /// Energies of a kind on both machines.
    struct Both {
        TwoCloths::Energies on_cpu;
        std::vector<std::shared_ptr<Energy>> kind; ///< of on_cpu
        EnergiesOnGpu on_gpu;
    };
    std::unique_ptr<Both> both(std::vector<std::shared_ptr<Energy>> TwoCloths::Energies::*kind) const
    {
        const TwoCloths::Energies energies = cloths_.energies();
        auto both =
            std::make_unique<Both>(Both{energies, energies.*kind, EnergiesOnGpu(space(), cloths_.size())});
        for (const auto& energy : both->kind)
            EXPECT_TRUE(energy->add_to(both->on_gpu.energies, 0));
        return both;
    }
    void begin_step(Both& both, const std::vector<Vec3>& x, double dt) const
    {
        both.on_cpu.begin_step(x, dt);
        both.on_gpu.begin_step(x, dt);
    }

    /// Compares before the first step, and in steps of different lengths.
    void expect_as_on_the_cpu(std::vector<std::shared_ptr<Energy>> TwoCloths::Energies::*kind) const
    {
        const auto machines = both(kind);
        const std::vector<Vec3> start = cloths_.positions(1.0, 1), end = cloths_.positions(1.02, 2);
        const Pull before = pull_of(machines->kind, end);
        expect_equal(machines->on_gpu.pull(end), before, kRounding);
        double previous = before.energy;
        for (const double dt : {0.02, 0.005}) {
            begin_step(*machines, start, dt);
            const Pull friction = pull_of(machines->kind, end);
            EXPECT_GT(friction.energy, previous);
            previous = friction.energy;
            expect_equal(machines->on_gpu.pull(end), friction, kRounding);
        }
    }

    TwoCloths cloths_;
};

TEST_F(DeviceFriction, OfTheMembraneIsThatOfTheCpu) { expect_as_on_the_cpu(&TwoCloths::Energies::membranes); }

TEST_F(DeviceFriction, OfBendingIsThatOfTheCpu) { expect_as_on_the_cpu(&TwoCloths::Energies::frictions); }

TEST_F(DeviceFriction, OfBendingIsExactlyZeroBeforeTheFirstStep)
{
    const auto machines = both(&TwoCloths::Energies::frictions);
    const Pull pull = machines->on_gpu.pull(cloths_.positions(1.02, 2));
    EXPECT_EQ(pull.energy, 0.0);
    EXPECT_EQ(largest_of(pull.gradient), 0.0);
}

TEST_F(DeviceFriction, FollowsTheStepInARecordedEvaluation)
{
    const auto machines = both(&TwoCloths::Energies::all);
    EnergiesOnGpu& gpu = machines->on_gpu;
    const std::vector<Vec3> end = cloths_.positions(1.02, 2);
    gpu.place(end);
    CudaGraph graph(space(), "test/gradient");
    graph.record([&] { gpu.energies.add_gradient(gpu.at()); });
    for (const double dt : {0.02, 0.005}) {
        const std::vector<Vec3> start = cloths_.positions(0.98 + dt, 1);
        gpu.begin_step(start, dt);
        const Pull direct = gpu.pull(end);
        gpu.place(end);
        EXPECT_EQ(allocations_of([&] { graph.launch(); }), 0);
        const Pull recorded = gpu.pulled();
        EXPECT_GT(direct.energy, 0.0);
        EXPECT_EQ(recorded.energy, direct.energy);
        EXPECT_EQ(recorded.gradient, direct.gradient);
    }
}

TEST_F(DeviceFriction, HasTheSameBitsTwice)
{
    const auto run = [&] {
        const auto machines = both(&TwoCloths::Energies::frictions);
        machines->on_gpu.begin_step(cloths_.positions(1.0, 1), TwoCloths::kDt);
        return machines->on_gpu.pull(cloths_.positions(1.02, 2));
    };
    const Pull first = run(), second = run();
    EXPECT_GT(first.energy, 0.0);
    EXPECT_EQ(first.energy, second.energy);
    EXPECT_EQ(first.gradient, second.gradient);
}

} // namespace
} // namespace toile::test
