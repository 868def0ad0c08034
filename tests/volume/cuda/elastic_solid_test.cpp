#include <random>

#include "core/pd/energy/sliced_energy.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/energies_on_gpu.h"
#include "tests/garment/cuda/entries_on_gpu.h"
#include "tests/volume/blocks.h"
#include "volume/energy/elastic_solid.h"

/// Elasticity of solids on a GPU compared with the CPU.
namespace toile::test {

using namespace volume;

namespace {

/// Vertices of the body before the first solid and between the two: they belong to something else.
constexpr int kGap = 5;

class DeviceElasticSolidTest : public OnDevice {
protected:
    DeviceElasticSolidTest()
    {
        for (const auto& [poisson, disorder] : {std::pair(0.3, 0.1), std::pair(0.49, 0.0)}) {
            const Block block = make_block({1.0, 0.5, 0.5}, {4, 2, 3}, disorder);
            const Lame lame = ElasticMaterial{1e4, poisson}.lame("block");
            first_.push_back(int(rest_.size()) + kGap);
            rest_.resize(first_.back(), Vec3::Zero());
            rest_.insert(rest_.end(), block.mesh.positions.begin(), block.mesh.positions.end());
            solids_.push_back(
                std::make_shared<ElasticSolid>(std::make_shared<RestTets>(rest_tets(block.mesh, "block")),
                                               std::vector<Lame>(block.mesh.tets.size(), lame)));
            counts_.push_back(int(block.mesh.positions.size()));
        }
    }

    int size() const { return int(rest_.size()); }
    std::vector<std::shared_ptr<Energy>> energies() const
    {
        std::vector<std::shared_ptr<Energy>> energies;
        for (size_t i = 0; i < solids_.size(); ++i)
            energies.push_back(std::make_shared<SlicedEnergy>(solids_[i], first_[i], counts_[i]));
        return energies;
    }

    /// @param noise  [m] from 0.2 on, some tetrahedra are inside out
    std::vector<Vec3> deformed(double noise) const
    {
        std::mt19937 random(7);
        std::normal_distribution<double> normal(0.0, noise);
        std::vector<Vec3> x = rest_;
        for (Vec3& point : x)
            point += Vec3(normal(random), normal(random), normal(random));
        return x;
    }

private:
    std::vector<Vec3> rest_;
    std::vector<int> first_, counts_;
    std::vector<std::shared_ptr<ElasticSolid>> solids_;
};

constexpr double kNoise[] = {1e-6, 0.02, 0.3};

TEST_F(DeviceElasticSolidTest, HasValueAndGradientOfTheCpu)
{
    EnergiesOnGpu gpu(space(), size());
    for (const auto& energy : energies())
        ASSERT_TRUE(energy->add_to(gpu.energies, 0));
    for (const double noise : kNoise) {
        const std::vector<Vec3> x = deformed(noise);
        Pull on_cpu;
        on_cpu.gradient.assign(x.size(), Vec3::Zero());
        for (const auto& energy : energies())
            on_cpu.energy += energy->add_gradient(x, on_cpu.gradient);
        // Strains of 1e-6 have lost six digits of the positions already.
        expect_equal(gpu.pull(x), on_cpu, noise < 1e-5 ? 1e-8 : 1e-12);
    }
}

TEST_F(DeviceElasticSolidTest, HasTheProjectedHessianOfTheCpu)
{
    const std::vector<std::shared_ptr<Energy>> energies = this->energies();
    Curvature curvature(size(), energies);
    const HessianPattern pattern(curvature.blocks(), curvature.isotropic());
    EnergiesOnGpu gpu(space(), size());
    for (const auto& energy : energies)
        ASSERT_TRUE(energy->add_to(gpu.energies, 0));
    for (const auto& energy : gpu.energies.all())
        energy->find_entries(pattern);
    EntriesOnGpu entries(space(), pattern, size());
    for (const double noise : kNoise) {
        const std::vector<Vec3> x = deformed(noise);
        curvature.assemble(x, Definiteness::Projected);
        const Entries found = entries.of(gpu.energies, x);
        expect_equal_blocks(found, pattern, curvature.blocks());
        for (const double sum : found.sum)
            EXPECT_EQ(sum, double(EntriesOnGpu::kInertia)); // rigid motion costs nothing
    }
}

TEST_F(DeviceElasticSolidTest, HasTheSameBitsTwiceAndAllocatesNothing)
{
    EnergiesOnGpu gpu(space(), size());
    for (const auto& energy : energies())
        energy->add_to(gpu.energies, 0);
    const std::vector<Vec3> x = deformed(0.3);
    const Pull first = gpu.pull(x);
    Pull second;
    EXPECT_EQ(allocations_of([&] { second = gpu.pull(x); }), 0);
    EXPECT_EQ(first.gradient, second.gradient);
    EXPECT_EQ(first.energy, second.energy);
}

} // namespace
} // namespace toile::test
