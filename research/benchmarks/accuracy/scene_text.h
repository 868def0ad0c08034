#pragma once

#include <string>

#include "scenes/format/scene.h"

/// Scenes of cases as text with numbers in it.
namespace toile::research::accuracy {

inline constexpr double kGravity = 9.81; ///< [m/s^2]

std::string number(double value);

/// @param keys  of the scene's JSON object, without "toile"
scenes::Scene scene_of(const std::string& name, const std::string& keys);

/// Key "fabrics" with a fabric "f" of equal threads without internal friction and strain limit.
/// @param areal_density  [kg/m^2]
/// @param stretch        [N/m] of warp and weft; shear has half of it
/// @param bend           [N m]
/// @param damping        [1/s] decay of velocities
std::string lossless_fabric(double areal_density, double stretch, double bend, double damping = 0.0);

/// The same scene in equal, finer steps, each minimised much further.
/// @param finer  steps for each of four a sample, or of the scene's own number
scenes::Scene converged(scenes::Scene scene, int finer, double velocity_tolerance = 1e-4);

} // namespace toile::research::accuracy
