#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/compute/types.h"

namespace toile::garment {

/// Points of a panel that a mesh of it has to keep.
struct PanelFrame {
    std::vector<Vec2> points; ///< the outline, counter-clockwise and simple, then those inside [m]
    int outline_count = 0;    ///< how many of them are on the outline, at least 3
    std::vector<std::array<int, 2>> inner_edges; ///< of lines inside: pairs of points, which cross nothing
};

/// All edges that a mesh of the frame has to keep: those of lines, then the sides of the outline.
std::vector<std::array<int, 2>> edges_of(const PanelFrame& frame);

/// Triangulation of a panel: the points of its frame stay, others are placed inside for triangles that are as
/// equilateral as the frame allows.
///
///   1. insert centres of the largest empty circles until none is large    [Chew 1989; Eldar et al. 1997]
///   2. move points to the centroids of their stars, flip to Delaunay      [Chen and Holst 2011]
///   3. remove points that crowd, split edges that are long; repeat 2
///   4. move points for the largest smallest angle, remove those that hinder it [Freitag et al. 1995]
///
/// CGAL's Mesh_2 is not used: it places points on the outline, and leaves angles and edges of wider range.
/// Sizes grow from the frame's spacing to the target by 30 % of the distance.
class PanelFill {
public:
    /// @param edge  [m] target of edge lengths
    PanelFill(const PanelFrame& frame, double edge);
    ~PanelFill();
    PanelFill(PanelFill&&) noexcept;
    PanelFill& operator=(PanelFill&&) noexcept;

    /// Splits edges between vertices of vertices() in the middle. Those of the frame may not be among them.
    void split(const std::vector<std::array<int, 2>>& edges);

    /// [vertices] the frame, then the inside in rows from bottom to top [m]
    const std::vector<Vec2>& vertices() const;
    /// [triangles] counter-clockwise, sorted
    const std::vector<Triangle>& triangles() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace toile::garment
