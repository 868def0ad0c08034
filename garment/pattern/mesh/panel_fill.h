#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/compute/types.h"

namespace toile::garment {

/// Triangulation of a simple polygon: its corners stay, points inside are placed for triangles that are as
/// equilateral as the outline allows.
///
///   1. insert centres of the largest empty circles until none is large    [Chew 1989; Eldar et al. 1997]
///   2. move points to the centroids of their stars, flip to Delaunay      [Chen and Holst 2011]
///   3. remove points that crowd, split edges that are long; repeat 2
///   4. move points for the largest smallest angle                         [Freitag et al. 1995]
///
/// CGAL's Mesh_2 is not used: it places points on the outline, and leaves angles and edges of wider range.
/// Sizes grow from the outline's spacing to the target by 30 % of the distance.
class PanelFill {
public:
    /// @param outline  [3 or more] counter-clockwise, simple [m]
    /// @param edge     [m] target of edge lengths
    PanelFill(const std::vector<Vec2>& outline, double edge);
    ~PanelFill();
    PanelFill(PanelFill&&) noexcept;
    PanelFill& operator=(PanelFill&&) noexcept;

    /// Splits edges between vertices of vertices() in the middle. Sides of the outline may not be among them.
    void split(const std::vector<std::array<int, 2>>& edges);

    /// [vertices] the outline, then the inside in rows from bottom to top [m]
    const std::vector<Vec2>& vertices() const;
    /// [triangles] counter-clockwise, sorted
    const std::vector<Triangle>& triangles() const;

private:
    class Triangulation;
    std::unique_ptr<Triangulation> triangulation_;
};

} // namespace toile::garment
