#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::stress {

/// Start positions without any order: every vertex somewhere in a box.
struct RandomStart {
    Vec3 lower, upper; ///< [m]
    unsigned seed = 0;
};

/// A scene made to break the simulator: one cloth, one time step per sample, nothing below the floor y = 0,
/// and cloth never put to sleep.
struct Case {
    std::string name;
    Scene scene;
    std::optional<RandomStart> start; ///< absent: the rest shape's

    /// Energy per mass of the cloth [J/kg] that moving obstacles may bring in, besides what the start holds.
    double granted_energy = 0.0;

    bool starts_at_rest = false; ///< after Scene::settle: drift is then bounded too

    double dt() const { return scene.frame_duration(); }
    int steps() const { return scene.frames - 1; }
};

enum class Size {
    Full,  ///< what `toile bench stress` runs
    Quick, ///< the same cases on coarser cloth for less time
};

/// All cases.
/// @param folder  where the meshes that cases need are written
/// @throws InvalidInput or DeviceError when they can't be written.
std::vector<Case> make_cases(Size size, const std::filesystem::path& folder);

} // namespace toile::stress
