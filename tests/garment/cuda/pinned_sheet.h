#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/pd/energy/system.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

/// Sheet fixed at two corners, and a load.
struct PinnedSheet {
    Sheet sheet = make_sheet(Vec2(0.6, 0.4), 30, 20, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<unsigned char> fixed = std::vector<unsigned char>(sheet.uv.size(), 0);
    std::vector<Vec3> load;

    PinnedSheet()
    {
        fixed[sheet.at(0, 0)] = fixed[sheet.at(30, 0)] = 1;
        for (const Vec3& p : sheet.flat())
            load.emplace_back(std::sin(9.0 * p.x()), std::cos(31.0 * p.z()), 1.0 + p.x());
    }

    std::unique_ptr<System> system(std::unique_ptr<GlobalSolver> solver) const
    {
        const std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(rest, Membrane::Settings{300.0, 200.0, 50.0}, "sheet"),
            std::make_shared<Bending>(rest, Bending::Settings{1e-5, 1e-5}, "sheet")};
        return std::make_unique<System>(masses_of(*rest, 0.2), energies, std::move(solver));
    }

    /// Solution for the load by this solver.
    std::vector<Vec3> solved(std::unique_ptr<GlobalSolver> solver) const
    {
        const std::unique_ptr<System> system = this->system(std::move(solver));
        system->prepare(1.0 / 60.0, fixed);
        std::vector<Vec3> x(load.size());
        system->solver().solve(load, x);
        return x;
    }
};

} // namespace toile::test
