#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/pd/energy/sliced_energy.h"
#include "garment/energy/bend_damping.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/energy/springs.h"
#include "garment/energy/strain_limit/stretch_tension.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

/// Two woven sheets behind vertices of no cloth. Only the first has internal friction. Both have a limit of
/// their strain: the first an elastic one, the second one with memory, and an anchor.
struct TwoCloths {
    static constexpr int kGap = 3; ///< vertices of no cloth before the first
    static constexpr double kDt = 1.0 / 120.0;

    std::vector<Sheet> sheets{make_sheet(Vec2(0.4, 0.3), 13, 11, Pattern::Irregular),
                              make_sheet(Vec2(0.2, 0.3), 5, 7, Pattern::Irregular)};

    /// Energies of one machine.
    struct Energies {
        std::vector<std::shared_ptr<Energy>> membranes, frictions, all; ///< all of both cloths
        std::vector<std::function<void(View<const Vec3>, double)>> starts;

        void begin_step(const std::vector<Vec3>& x, double dt) const
        {
            for (const auto& start : starts)
                start(x, dt);
        }
    };

    int first(int sheet) const { return sheet == 0 ? kGap : kGap + int(sheets[0].uv.size()); }
    int size() const { return first(1) + int(sheets[1].uv.size()); }

    /// Noisy positions, stretched along the warp.
    std::vector<Vec3> positions(double stretch, int seed) const
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> some(-1.0, 1.0);
        std::vector<Vec3> x(kGap, Vec3(7.0, 8.0, 9.0));
        for (const Sheet& sheet : sheets)
            for (const Vec3& p : sheet.flat())
                x.push_back(Vec3(stretch * p.x(), 0.01 * std::sin(30.0 * p.x() + 9.0 * p.z()), p.z()) +
                            0.001 * Vec3(some(random), some(random), some(random)));
        return x;
    }

    Energies energies() const
    {
        Energies made;
        for (int k = 0; k < 2; ++k) {
            const auto rest = sheets[k].rest();
            const auto membrane =
                std::make_shared<Membrane>(rest,
                                           k == 0 ? Membrane::Settings{300.0, 200.0, 40.0, 0.003, 0.01}
                                                  : Membrane::Settings{900.0, 700.0, 60.0},
                                           "sheet");
            const Bending::Settings rigidity{2e-5, 1e-5};
            const auto tension = std::make_shared<StretchTension>(
                rest, k == 0 ? StretchTension::Settings::elastic(0.06, 300.0, 0.0)
                             : StretchTension::Settings{0.06, 900.0});
            add(membrane, k, made.membranes);
            add(std::make_shared<Bending>(rest, rigidity, "sheet"), k, made.all);
            add(tension, k, made.all);
            start(membrane, k, made);
            start_tension(tension, k, made);
            if (k == 0) {
                const auto damping = std::make_shared<BendDamping>(
                    *rest, BendDamping::Settings{rigidity, 0.03, 12.0}, "sheet");
                add(damping, k, made.frictions);
                start(damping, k, made);
            } else {
                add(std::make_shared<Springs>(std::vector<Springs::Spring>{{4, 20.0}, {9, 30.0}, {4, 7.0}}),
                    k, made.all);
            }
        }
        made.all.insert(made.all.end(), made.membranes.begin(), made.membranes.end());
        made.all.insert(made.all.end(), made.frictions.begin(), made.frictions.end());
        return made;
    }

private:
    int count(int sheet) const { return int(sheets[sheet].uv.size()); }

    void add(const std::shared_ptr<Energy>& energy, int sheet,
             std::vector<std::shared_ptr<Energy>>& energies) const
    {
        energies.push_back(std::make_shared<SlicedEnergy>(energy, first(sheet), count(sheet)));
    }
    template <typename Kind>
    void start(const std::shared_ptr<Kind>& energy, int sheet, Energies& made) const
    {
        made.starts.push_back(
            [energy, first = first(sheet), count = count(sheet)](View<const Vec3> x, double dt) {
                energy->begin_step(x.subview(first, count), dt);
            });
    }
    void start_tension(const std::shared_ptr<StretchTension>& energy, int sheet, Energies& made) const
    {
        made.starts.push_back(
            [energy, first = first(sheet), count = count(sheet)](View<const Vec3> x, double) {
                energy->begin_step(x.subview(first, count));
            });
    }
};

} // namespace toile::test
