#pragma once

namespace toile::garment {

/// Stiffness of folds where nothing tells it [N]: moment per length of the fold and radian.
inline constexpr double kFoldStiffness = 0.05;

/// Edge of a cloth that is folded at rest.
struct FoldEdge {
    int edge = 0;                      ///< index into Topology::edges; it has two triangles
    double angle = 0.0;                ///< [rad] at rest, outer sides towards each other; from -pi to pi
    double stiffness = kFoldStiffness; ///< [N] positive
};

} // namespace toile::garment
