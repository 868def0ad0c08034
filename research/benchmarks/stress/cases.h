#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::research::stress {

/// Random start positions: every vertex uniformly in a box.
struct RandomStart {
    Vec3 lower, upper; ///< [m]
    unsigned seed = 0;
};

/// A scene made to break the simulator: one cloth, one time step per sample, nothing below the floor y = 0,
/// and no sleeping.
struct Case {
    std::string name;
    scenes::Scene scene;
    std::optional<RandomStart> start; ///< absent: start positions of the scene

    /// Energy per mass of the cloth [J/kg] that moving colliders may add, besides the energy of the start.
    double granted_energy = 0.0;

    bool starts_at_rest = false; ///< after Scene::settle: drift is then bounded too

    double dt() const { return scene.frame_duration(); }
    int steps() const { return scene.frames - 1; }
};

enum class Size {
    Full,  ///< what `toile-bench stress` runs
    Quick, ///< the same cases on coarser and shorter runs
};

/// All cases.
/// @param folder  for meshes that cases need
/// @throws InvalidInput or DeviceError if they can't be written.
std::vector<Case> make_cases(Size size, const std::filesystem::path& folder);

} // namespace toile::research::stress
