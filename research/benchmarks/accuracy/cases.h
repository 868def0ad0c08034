#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::research::accuracy {

/// All samples of a run.
struct Trajectory {
    double frame_duration = 0.0;              ///< [s]
    std::vector<std::vector<Vec3>> positions; ///< [frames][vertices] of all cloths [m]
    std::vector<std::vector<double>> strain;  ///< [frames][triangles] largest principal stretch - 1 [-]

    const std::vector<Vec3>& last() const { return positions.back(); }
    /// Mean velocities from the sample before to this one [vertices] [m/s].
    std::vector<Vec3> velocities(int frame) const;
};

/// A quantity that a scene at default settings should meet.
struct Case {
    std::string name;
    std::string quantity; ///< with its unit
    scenes::Scene scene;
    std::function<std::vector<Vec3>(View<const Vec3>)> place; ///< start positions; empty: those of the scene

    /// Value of the quantity. `converged` is the run of `reference`, null without.
    std::function<double(const Trajectory& run, const Trajectory* converged)> measure;
    std::optional<scenes::Scene> reference; ///< the same scene, finely resolved in time and to the end

    double right = 0.0;       ///< the exact value, if the reference is not measured instead
    bool is_measured = false; ///< the right value is `measure` of the reference
    bool is_relative = false; ///< the error is relative to the right value
    double aim = 0.0;         ///< largest error that is good
};

/// A skirt that falls from its waist: a quantile of the strain of its triangles.
Case hanging_skirt(const std::string& word, double share);

/// Five stiff cloths that fall on a ball: how late.
Case pile();

/// @param folder  for meshes of scenes; must exist
/// @param quick   only those that take seconds
std::vector<Case> make_cases(const std::filesystem::path& folder, bool quick);

} // namespace toile::research::accuracy
