#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::research::sheet {

/// A square metre of cotton, initially horizontal, attached at two neighbouring corners: it swings down and
/// hangs. No contact, one implicit Euler step per sample.
struct Sheet {
    int side = 100;                         ///< vertices along each side
    int steps = 120;                        ///< of kStep
    std::vector<int> compared{30, 60, 120}; ///< steps after which positions are compared, ascending

    double edge() const { return 1.0 / (side - 1); } ///< [m]
};

inline constexpr double kStep = 1.0 / 120.0; ///< [s]

/// The measured sheet, and one with fewer vertices for a quarter of the time.
Sheet full_sheet();
Sheet quick_sheet();

/// Stopping criteria of the solver for a step.
struct Setting {
    std::string name;
    double tolerance = 1e-4; ///< [m]
    int max_iterations = 300;
    bool limits_strain = false; ///< with cotton's strain limit; else with none
    bool is_reference = false;  ///< converged reference of the settings with the same limits
};

/// All settings: references first, then from fast to slow. The second reference without a limit measures how
/// far apart two converged runs are; smaller errors are meaningless.
std::vector<Setting> ladder();

/// False for converged references.
bool is_timed(const Setting& setting);

scenes::Scene make_scene(const Sheet& sheet, const Setting& setting);

} // namespace toile::research::sheet
