#include "garment/energy/bending_kernels.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "garment/energy/bending.h"
#include "tests/garment/sheets.h"

/// GPU kernels of bending, run on the CPU and compared with Bending. No GPU is needed.
namespace toile::test {

using namespace garment;

namespace {

struct OneThread {
    int thread;
};

TEST(BendByTeam, GivesTheGradientAndEnergyOfTheCpu)
{
    // Rows of different lengths, and a last slice that is not full.
    const Sheet sheet = make_sheet(Vec2(0.3, 0.2), 12, 7, Pattern::Irregular);
    Bending bending(sheet.rest(), Bending::Settings{0.02, 0.01}, "sheet");
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p +=
            Vec3(20.0, 30.0, 40.0) + 0.02 * Vec3(std::sin(31 * p.x() + 7 * p.z()), std::cos(23 * p.z()), 0.0);
    const int n = int(x.size());
    std::vector<Vec3> expected(n, Vec3(1.0, 2.0, 3.0)), found = expected;
    const double value = bending.add_gradient(x, expected);

    const SparseMatrix& K = bending.matrix();
    const std::vector<float> values(K.valuePtr(), K.valuePtr() + K.nonZeros());
    const SlicedRows rows(View<const int>(K.outerIndexPtr(), n + 1),
                          View<const int>(K.innerIndexPtr(), int(values.size())), values);
    EXPECT_EQ(int(rows.first.size()), (n + SlicedRows::kRows - 1) / SlicedRows::kRows + 1);
    std::vector<double> energy(n, 0.5);
    const BendByTeam bending_of{rows.first, rows.entries, x};
    for (int i = 0; i < n; ++i)
        for (int thread = 0; thread < SlicedRows::kThreads; ++thread) {
            const BendByTeam::Partial partial = bending_of.of_thread(i, OneThread{thread});
            found[i] += partial.gradient;
            energy[i] += partial.energy;
        }

    double largest = 0.0, difference = 0.0;
    for (int i = 0; i < n; ++i) {
        largest = std::max(largest, (expected[i] - Vec3(1.0, 2.0, 3.0)).norm());
        difference = std::max(difference, (found[i] - expected[i]).norm());
    }
    EXPECT_LT(difference, 5e-6 * largest); // entries in single precision, whose sums cancel
    EXPECT_NEAR(std::accumulate(energy.begin(), energy.end(), -0.5 * n), value, 1e-6 * value);
}

} // namespace
} // namespace toile::test
