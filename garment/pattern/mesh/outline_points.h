#pragma once

#include <array>
#include <vector>

#include "garment/pattern/edge_curve.h"
#include "garment/pattern/mesh/outline_check.h"

namespace toile::garment {

/// Point on an edge of a panel, or on a line inside of it, by its number along the edge.
struct OutlinePoint {
    int panel = 0;
    int edge = 0;  ///< as in EdgePart
    int point = 0; ///< index into OutlinePoints::fractions[panel][edge], or line_fractions

    bool operator==(const OutlinePoint&) const = default;
};

/// Points on the outlines and lines of all panels.
struct OutlinePoints {
    std::vector<std::vector<std::vector<double>>> fractions;      ///< [panels][edges][2 or more] from 0 to 1
    std::vector<std::vector<std::vector<double>>> line_fractions; ///< [panels][lines][2 or more] likewise
    std::vector<std::vector<std::array<OutlinePoint, 2>>> seams; ///< [seams][pairs] that meet, along the seam
};

/// Fractions of an edge that differ by less count as one point: three digits in a file.
inline constexpr double kSameFraction = 1e-3;

/// Corners of both sides of a seam that are nearer to each other than this fraction of it meet.
inline constexpr double kSameCorner = 5e-3;

/// How densely outlines are divided.
struct OutlineTargets {
    std::vector<double> edge; ///< [panels] largest distance of points along the outline [m]

    /// [panels][edges, then lines] least intervals between points of each stretch that is not sewn
    std::vector<std::vector<int>> free_intervals;

    /// [panels][edges, then lines] fractions at which there must be a point, ascending
    std::vector<std::vector<std::vector<double>>> marks;
};

/// Curves of the lines of all panels behind those of their outlines. [panels][edges, then lines]
PatternCurves with_lines(const Pattern& pattern, PatternCurves curves);

/// Divides all edges and lines, seams first: both sides get equally many points (see mesh_pattern).
/// @param curves  with_lines()
/// @throws InvalidInput for parts of seams that do not exist, have no length or overlap
OutlinePoints divide_outlines(const Pattern& pattern, const PatternCurves& curves,
                              const OutlineTargets& targets);

} // namespace toile::garment
