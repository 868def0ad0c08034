#include "core/pd/energy/curvature.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/energies_on_gpu.h"
#include "tests/garment/cuda/entries_on_gpu.h"
#include "tests/garment/cuda/two_cloths.h"

/// Second derivatives of the cloth energies on a GPU compared with the CPU.
namespace toile::test {

namespace {

void expect_equal_scalars(const Entries& on_gpu, const HessianPattern& pattern, const SparseMatrix& S)
{
    double scale = 0.0, worst = 0.0;
    std::vector<unsigned char> is_entry(on_gpu.scalars.size(), 0);
    for (int i = 0; i < int(S.rows()); ++i)
        for (SparseMatrix::InnerIterator entry(S, i); entry; ++entry) {
            if (entry.col() == i)
                continue;
            const int at = pattern.scalar_position(i, int(entry.col()));
            ASSERT_GE(at, 0);
            is_entry[at] = 1;
            scale = std::max(scale, std::abs(entry.value()));
            worst = std::max(worst, std::abs(double(on_gpu.scalars[at]) - entry.value()));
        }
    EXPECT_GT(scale, 0.0);
    EXPECT_LT(worst, 1e-6 * scale);
    for (size_t at = 0; at < is_entry.size(); ++at)
        EXPECT_TRUE(is_entry[at] || on_gpu.scalars[at] == 0.0F) << at;
}

/// S is what a rigid translation meets: the sum of a row of blocks and numbers.
void expect_equal_sums(const Entries& on_gpu, const Curvature& curvature)
{
    for (int i = 0; i < curvature.blocks().rows(); ++i) {
        Mat3 row = Mat3::Zero();
        for (const Mat3& block : curvature.blocks().blocks(i))
            row += block;
        for (SparseMatrix::InnerIterator entry(curvature.isotropic(), i); entry; ++entry)
            row.diagonal().array() += entry.value();
        const Mat3 expected = (on_gpu.sum[i] - EntriesOnGpu::kInertia) * Mat3::Identity();
        EXPECT_LT((row - expected).cwiseAbs().maxCoeff(), 1e-9) << i;
    }
}

class DeviceCurvatureTest : public OnDevice {
protected:
    TwoCloths cloths_;
};

TEST_F(DeviceCurvatureTest, IsThatOfTheCpu)
{
    const TwoCloths::Energies on_cpu = cloths_.energies(), on_gpu = cloths_.energies();
    Curvature curvature(cloths_.size(), on_cpu.all);
    const HessianPattern pattern(curvature.blocks(), curvature.isotropic());
    EnergiesOnGpu gpu(space(), cloths_.size());
    for (const auto& energy : on_gpu.all)
        ASSERT_TRUE(energy->add_to(gpu.energies, 0));
    for (const auto& energy : gpu.energies.all())
        energy->find_entries(pattern);
    EntriesOnGpu entries(space(), pattern, cloths_.size());

    // Before the first step, in one that compresses the cloth, and in one that stretches it beyond its limit.
    const std::vector<Vec3> start = cloths_.positions(1.03, 1);
    bool has_begun = false;
    for (const double stretch : {1.0, 0.97, 1.09}) {
        if (has_begun) {
            on_cpu.begin_step(start, TwoCloths::kDt);
            gpu.begin_step(start, TwoCloths::kDt);
        }
        has_begun = true;
        const std::vector<Vec3> x = cloths_.positions(stretch, 2);
        curvature.assemble(x, Definiteness::Projected);
        const Entries found = entries.of(gpu.energies, x);
        expect_equal_blocks(found, pattern, curvature.blocks());
        expect_equal_scalars(found, pattern, curvature.isotropic());
        expect_equal_sums(found, curvature);
    }
}

TEST_F(DeviceCurvatureTest, HasTheSameBitsTwiceAndAllocatesNothing)
{
    const auto run = [&] {
        const TwoCloths::Energies energies = cloths_.energies();
        const Curvature curvature(cloths_.size(), energies.all);
        const HessianPattern pattern(curvature.blocks(), curvature.isotropic());
        EnergiesOnGpu gpu(space(), cloths_.size());
        for (const auto& energy : energies.all)
            energy->add_to(gpu.energies, 0);
        for (const auto& energy : gpu.energies.all())
            energy->find_entries(pattern);
        EntriesOnGpu entries(space(), pattern, cloths_.size());
        Entries found;
        const auto step = [&] {
            gpu.begin_step(cloths_.positions(1.03, 1), TwoCloths::kDt);
            found = entries.of(gpu.energies, cloths_.positions(1.09, 2));
        };
        step();
        EXPECT_EQ(allocations_of(step), 0);
        return found;
    };
    const Entries first = run(), second = run();
    EXPECT_EQ(first.blocks, second.blocks);
    EXPECT_EQ(first.scalars, second.scalars);
    EXPECT_EQ(first.sum, second.sum);
}

} // namespace
} // namespace toile::test
