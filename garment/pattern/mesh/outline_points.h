#pragma once

#include <array>
#include <vector>

#include "garment/pattern/edge_curve.h"
#include "garment/pattern/mesh/outline_check.h"

namespace toile::garment {

/// Point on an edge of a panel, by its number along the edge.
struct OutlinePoint {
    int panel = 0;
    int edge = 0;
    int point = 0; ///< index into OutlinePoints::fractions[panel][edge]

    bool operator==(const OutlinePoint&) const = default;
};

/// Points on the outlines of all panels.
struct OutlinePoints {
    std::vector<std::vector<std::vector<double>>> fractions;     ///< [panels][edges][2 or more] from 0 to 1
    std::vector<std::vector<std::array<OutlinePoint, 2>>> seams; ///< [seams][pairs] that meet, along the seam
};

/// Fractions of an edge that differ by less count as one point: three digits in a file.
inline constexpr double kSameFraction = 1e-3;

/// Corners of both sides of a seam that are nearer to each other than this fraction of it meet.
inline constexpr double kSameCorner = 5e-3;

/// How densely outlines are divided.
struct OutlineTargets {
    std::vector<double> edge; ///< [panels] largest distance of points along the outline [m]

    /// [panels][edges] least intervals between points of each stretch that is not sewn
    std::vector<std::vector<int>> free_intervals;

    /// [panels][edges] fractions at which there must be a point, ascending
    std::vector<std::vector<std::vector<double>>> marks;
};

/// Divides all edges, seams first: both sides get equally many points (see mesh_pattern).
/// @throws InvalidInput for parts of seams that do not exist, have no length or overlap
OutlinePoints divide_outlines(const Pattern& pattern, const PatternCurves& curves,
                              const OutlineTargets& targets);

} // namespace toile::garment
