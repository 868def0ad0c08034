#pragma once

#include <random>
#include <string>

#include "scenes/format/scene.h"

namespace toile::research::contact_stress {

/// Edge length [m] of all sheets.
inline constexpr double kEdge = 0.01;

/// Random numbers that are equal on every platform, unlike std::uniform_real_distribution.
class Random {
public:
    explicit Random(unsigned seed) : bits_(seed) {}

    double between(double lower, double upper)
    {
        return lower + (upper - lower) * double(bits_()) / double(std::mt19937::max());
    }

private:
    std::mt19937 bits_;
};

/// A scene without cloth: one time step per sample, the direct solver (so that every run has the same bits),
/// no sleeping, no repair of start poses, no air.
/// @param dt         [s]
/// @param thickness  [m] of the fabric that add_sheet() uses
scenes::Scene empty_scene(const std::string& name, double dt, int steps, double thickness, int threads);

/// Adds a square, horizontal sheet of `side` [m] and returns its name.
/// @param rotate_deg  about Y
std::string add_sheet(scenes::Scene& scene, double side, const Vec3& translate, double rotate_deg);

} // namespace toile::research::contact_stress
