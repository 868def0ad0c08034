#pragma once

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/cuda/newton/hessian_pattern.h"
#include "core/pd/energy/curvature.h"

/// Second derivatives of energies on a GPU compared with the CPU.
namespace toile::test {

/// Off-diagonal entries by position, and S.
struct Entries {
    std::vector<Eigen::Matrix3f> blocks;
    std::vector<float> scalars;
    std::vector<double> sum;
};

/// Entries of a Hessian on a device.
class EntriesOnGpu {
public:
    static constexpr float kInertia = 2.0F; ///< S before the energies add to it

    EntriesOnGpu(const CudaSpace& space, const HessianPattern& pattern, int vertex_count)
        : pattern_(pattern), x_(space, "test/x"), first_(space, "test/first", pattern.blocks().size()),
          second_(space, "test/second", pattern.blocks().size()),
          last_(space, "test/last", pattern.blocks().size()), scalars_(space, "test/scalars"),
          sum_(space, "test/sum"), vertex_count_(vertex_count)
    {
    }

    Entries of(const DeviceEnergies& energies, const std::vector<Vec3>& x)
    {
        x_.upload(x);
        first_.fill_zero();
        second_.fill_zero();
        last_.fill_zero();
        scalars_.upload(pattern_.constant_scalars());
        sum_.upload(std::vector<double>(vertex_count_, kInertia));
        for (const auto& energy : energies.all())
            energy->add_curvature(
                {x_.view(), {first_.view(), second_.view(), last_.view()}, scalars_.view(), sum_.view()});

        std::vector<Floats<4>> first = first_.downloaded(), second = second_.downloaded();
        std::vector<float> last = last_.downloaded();
        Entries entries;
        for (int k = 0; k < pattern_.blocks().size(); ++k)
            entries.blocks.push_back(HessianBlocks{first, second, last}[k]);
        entries.scalars = scalars_.downloaded();
        entries.sum = sum_.downloaded();
        return entries;
    }

private:
    const HessianPattern& pattern_;
    DeviceArray<Vec3> x_;
    DeviceArray<Floats<4>> first_, second_;
    DeviceArray<float> last_, scalars_;
    DeviceArray<double> sum_;
    int vertex_count_;
};

inline void expect_equal_blocks(const Entries& on_gpu, const HessianPattern& pattern, const BlockMatrix& K)
{
    double scale = 0.0, worst = 0.0;
    std::vector<unsigned char> is_entry(on_gpu.blocks.size(), 0);
    for (int i = 0; i < K.rows(); ++i)
        for (int k = 0; k < K.columns(i).size(); ++k) {
            const int j = K.columns(i)[k];
            if (j == i)
                continue;
            const int at = pattern.block_position(i, j);
            ASSERT_GE(at, 0);
            is_entry[at] = 1;
            scale = std::max(scale, K.blocks(i)[k].cwiseAbs().maxCoeff());
            worst =
                std::max(worst, (on_gpu.blocks[at].cast<double>() - K.blocks(i)[k]).cwiseAbs().maxCoeff());
            EXPECT_EQ(on_gpu.blocks[at], on_gpu.blocks[pattern.block_position(j, i)].transpose());
        }
    EXPECT_GT(scale, 0.0);
    EXPECT_LT(worst, 1e-6 * scale);
    for (size_t at = 0; at < is_entry.size(); ++at)
        EXPECT_TRUE(is_entry[at] || on_gpu.blocks[at].isZero(0.0F)) << at;
}

} // namespace toile::test
