#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::contact {

enum class Size {
    Full,  ///< what `toile bench contact` runs
    Quick, ///< smaller, shorter, fewer seeds
};

/// What the sheets of a stress case are thrown at.
enum class Target {
    HeldSheet, ///< the lowest of them, held by its corners
    Stack,     ///< each other: two halves that fly at each other
    Ball,      ///< a ball on a floor
};

/// Square sheets with edges of kEdge, one above the other, each turned and shifted at random.
struct StressCase {
    std::string name;
    Target target = Target::HeldSheet;
    double dt = 1.0 / 120.0; ///< [s]
    double thickness = 1e-3; ///< [m]
    double speed = 2.0;      ///< [m/s] at which they approach each other
    int layers = 5;          ///< with the held one
    double side = 0.14;      ///< [m]
    double duration = 0.2;   ///< [s] after the throw
    int seeds = 5;           ///< runs with seeds 1 to this

    int steps() const; ///< time steps with the one that throws
    int vertices() const;
};

/// All cases, each differing from the first in what its name says.
std::vector<StressCase> stress_cases(Size size);

/// The scene of a case. In its first step the sheets to be thrown are led along at their speed, by a hold on
/// every vertex; then they fly, and meet within the second step.
///
/// Height 0 is the held sheet's, the middle between two stacks, or the floor.
Scene stress_scene(const StressCase& trial, unsigned seed, int threads);

} // namespace toile::contact
