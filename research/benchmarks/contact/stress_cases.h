#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::research::contact_stress {

enum class Size {
    Full,  ///< what `toile-bench contact` runs
    Quick, ///< smaller, shorter, fewer seeds
};

/// Target at which the sheets of a stress case are thrown.
enum class Target {
    PinnedSheet, ///< the lowest of them, attached by its corners
    Stack,       ///< each other: two stacks that collide
    Ball,        ///< a ball on a floor
};

/// Square sheets with edges of kEdge, stacked, each rotated and shifted at random.
struct StressCase {
    std::string name;
    Target target = Target::PinnedSheet;
    double dt = 1.0 / 120.0; ///< [s]
    double thickness = 1e-3; ///< [m]
    double speed = 2.0;      ///< [m/s] relative speed of the collision
    int layers = 5;          ///< including the attached one
    double side = 0.14;      ///< [m]
    double duration = 0.2;   ///< [s] after the throw
    int seeds = 5;           ///< runs with seeds 1 to this

    int steps() const; ///< time steps including the throw
    int vertices() const;
};

/// All cases, each differing from the first as its name says.
std::vector<StressCase> stress_cases(Size size);

/// The scene of a case. In its first step the thrown sheets move at their speed, by an attachment of every
/// vertex; then they fly freely and collide within the second step.
///
/// Height 0 is the attached sheet's, the middle between two stacks, or the floor.
scenes::Scene stress_scene(const StressCase& trial, unsigned seed, int threads);

} // namespace toile::research::contact_stress
