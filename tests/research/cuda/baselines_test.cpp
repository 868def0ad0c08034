#include <algorithm>
#include <cmath>
#include <memory>

#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/cuda/aggregated_jacobi.h"
#include "research/linear/cuda/chebyshev_solver.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/cuda/pinned_sheet.h"

/// Baseline global solvers on a GPU compared with the CPU.
namespace toile::test {

using namespace research;

namespace {

/// Max difference relative to the max entry.
double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max_difference = 0.0, size = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        max_difference = std::max(max_difference, (a[i] - b[i]).norm());
        size = std::max(size, b[i].norm());
    }
    return max_difference / size;
}

class DeviceBaselineTest : public OnDevice {
protected:
    template <typename Kind>
    std::vector<Vec3> solved(const PinnedSheet& pinned, const typename Kind::Settings& settings = {}) const
    {
        return pinned.solved(std::make_unique<Kind>(space(), settings));
    }
};

/// Even and odd numbers of sweeps end in different arrays.
TEST_F(DeviceBaselineTest, ChebyshevSolvesAsOnTheCpu)
{
    const PinnedSheet pinned;
    for (const int sweeps : {1, 2, 31, 32}) {
        const std::vector<Vec3> gpu = solved<DeviceChebyshevSolver>(pinned, {sweeps, 40});
        EXPECT_LT(difference(gpu, pinned.solved(std::make_unique<ChebyshevSolver>(
                                      ChebyshevSolver::Settings{sweeps, 40}))),
                  1e-5)
            << sweeps;
        EXPECT_EQ(gpu[pinned.sheet.at(0, 0)], pinned.load[pinned.sheet.at(0, 0)]);
    }
}

TEST_F(DeviceBaselineTest, AggregatedJacobiSolvesAsOnTheCpu)
{
    const PinnedSheet pinned;
    for (const int order : {1, 2, 3})
        for (const int applications : {1, 15, 16})
            EXPECT_LT(difference(solved<DeviceAggregatedJacobi>(pinned, {order, applications}),
                                 pinned.solved(std::make_unique<AggregatedJacobi>(
                                     AggregatedJacobi::Settings{order, applications}))),
                      1e-5)
                << order << " " << applications;
}

TEST_F(DeviceBaselineTest, SolveWithTheSameBitsTwice)
{
    const PinnedSheet pinned;
    EXPECT_EQ(solved<DeviceChebyshevSolver>(pinned), solved<DeviceChebyshevSolver>(pinned));
    EXPECT_EQ(solved<DeviceAggregatedJacobi>(pinned), solved<DeviceAggregatedJacobi>(pinned));
}

} // namespace
} // namespace toile::test
