#include <algorithm>
#include <cmath>
#include <memory>

#include "core/linear/baselines/aggregated_jacobi.h"
#include "core/linear/baselines/chebyshev_solver.h"
#include "core/linear/baselines/device_aggregated_jacobi.h"
#include "core/linear/baselines/device_chebyshev_solver.h"
#include "tests/core/cuda/held_sheet.h"
#include "tests/core/cuda/on_device.h"

/// Other people's global solvers on a GPU against the same on the CPU.
namespace toile::test {
namespace {

/// Of the largest entry.
double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double most = 0.0, size = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, (a[i] - b[i]).norm());
        size = std::max(size, b[i].norm());
    }
    return most / size;
}

class DeviceBaselineTest : public OnDevice {
protected:
    template <typename Kind>
    std::vector<Vec3> solved(const HeldSheet& held, const typename Kind::Settings& settings = {}) const
    {
        return held.solved(std::make_unique<Kind>(space(), settings));
    }
};

/// Even and odd numbers of sweeps end in different arrays.
TEST_F(DeviceBaselineTest, ChebyshevSolvesAsOnTheCpu)
{
    const HeldSheet held;
    for (const int sweeps : {1, 2, 31, 32}) {
        const std::vector<Vec3> there = solved<DeviceChebyshevSolver>(held, {sweeps, 40});
        EXPECT_LT(difference(there, held.solved(std::make_unique<ChebyshevSolver>(
                                        ChebyshevSolver::Settings{sweeps, 40}))),
                  1e-5)
            << sweeps;
        EXPECT_EQ(there[held.sheet.at(0, 0)], held.load[held.sheet.at(0, 0)]);
    }
}

TEST_F(DeviceBaselineTest, AggregatedJacobiSolvesAsOnTheCpu)
{
    const HeldSheet held;
    for (const int order : {1, 2, 3})
        for (const int applications : {1, 15, 16})
            EXPECT_LT(difference(solved<DeviceAggregatedJacobi>(held, {order, applications}),
                                 held.solved(std::make_unique<AggregatedJacobi>(
                                     AggregatedJacobi::Settings{order, applications}))),
                      1e-5)
                << order << " " << applications;
}

TEST_F(DeviceBaselineTest, SolveWithTheSameBitsTwice)
{
    const HeldSheet held;
    EXPECT_EQ(solved<DeviceChebyshevSolver>(held), solved<DeviceChebyshevSolver>(held));
    EXPECT_EQ(solved<DeviceAggregatedJacobi>(held), solved<DeviceAggregatedJacobi>(held));
}

} // namespace
} // namespace toile::test
