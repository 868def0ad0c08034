#include <algorithm>
#include <cmath>
#include <memory>

#include "core/linear/baselines/aggregated_jacobi.h"
#include "core/linear/baselines/chebyshev_solver.h"
#include "core/linear/baselines/device_aggregated_jacobi.h"
#include "core/linear/baselines/device_chebyshev_solver.h"
#include "core/pd/system.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "tests/core/cuda/on_device.h"
#include "tests/garment/sheets.h"

/// Other people's global solvers on a GPU against the same on the CPU.
namespace toile::test {
namespace {

/// H of a sheet held at two corners, and a load.
struct Held {
    Sheet sheet = make_sheet(Vec2(0.6, 0.4), 30, 20, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<unsigned char> fixed = std::vector<unsigned char>(sheet.uv.size(), 0);
    std::vector<Vec3> load;

    Held()
    {
        fixed[sheet.at(0, 0)] = fixed[sheet.at(30, 0)] = 1;
        for (const Vec3& p : sheet.flat())
            load.emplace_back(std::sin(9.0 * p.x()), std::cos(31.0 * p.z()), 1.0 + p.x());
    }

    /// The load as this solver has it.
    std::vector<Vec3> solved(std::unique_ptr<GlobalSolver> solver) const
    {
        const std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(rest, Membrane::Settings{300.0, 200.0, 50.0}, "sheet"),
            std::make_shared<Bending>(rest, Bending::Settings{1e-5, 1e-5}, "sheet")};
        System system(masses_of(*rest, 0.2), energies, std::move(solver));
        system.prepare(1.0 / 60.0, fixed);
        std::vector<Vec3> x(load.size());
        system.solver().solve(load, x);
        return x;
    }
};

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
    std::vector<Vec3> solved(const Held& held, const typename Kind::Settings& settings = {}) const
    {
        return held.solved(std::make_unique<Kind>(space(), settings));
    }
};

/// Even and odd numbers of sweeps end in different arrays.
TEST_F(DeviceBaselineTest, ChebyshevSolvesAsOnTheCpu)
{
    const Held held;
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
    const Held held;
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
    const Held held;
    EXPECT_EQ(solved<DeviceChebyshevSolver>(held), solved<DeviceChebyshevSolver>(held));
    EXPECT_EQ(solved<DeviceAggregatedJacobi>(held), solved<DeviceAggregatedJacobi>(held));
}

} // namespace
} // namespace toile::test
