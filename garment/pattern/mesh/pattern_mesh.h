#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "garment/pattern/pattern.h"

namespace toile::garment {

/// Vertex on the edge of a panel.
struct EdgeVertex {
    int vertex = 0;        ///< index into PatternMesh::uv
    double fraction = 0.0; ///< [-] of the edge's arc length, from its start
};

/// Triangles of all panels of a pattern, flat, before sewing.
///
/// Triangles run along their panel's loop. The loop of most back panels is clockwise in the panel's plane
/// (negative signed_area), and so are their triangles in `uv`; placed in space, all normals point away from
/// the body. In each panel the vertices of the outline come first, along the loop from the start of edge 0,
/// then those of lines inside.
struct PatternMesh {
    std::vector<Vec2> uv;            ///< [vertices] in the panel's plane, as in the file [m]
    std::vector<Triangle> triangles; ///< [triangles] along the panel's loop
    std::vector<int> first_vertex;   ///< [panels + 1]
    std::vector<int> first_triangle; ///< [panels + 1]

    /// [panels][edges][2 or more] from the edge's start to its end
    std::vector<std::vector<std::vector<EdgeVertex>>> edge_vertices;

    /// [panels][lines][2 or more] of Panel::lines, likewise
    std::vector<std::vector<std::vector<EdgeVertex>>> panel_lines;

    /// [seams][pairs] vertices of `a` and `b` to join, from the start of the seam to its end. A vertex that
    /// meets itself, as the tip of a dart does, is left out. Where a chain goes on at another vertex, there
    /// are two pairs.
    std::vector<std::vector<std::array<int, 2>>> stitches;

    std::vector<bool> is_inner_seam; ///< [seams] whether it is on a line inside of a panel

    std::vector<std::vector<int>> line_vertices; ///< [lines][2 or more] along each line
    std::vector<std::vector<int>> fold_vertices; ///< [folds of the pattern][2 or more] along each

    std::vector<double> edge; ///< [panels] target of edge lengths [m]; less than asked for in narrow panels

    /// Vertices along an edge of a panel, or a line of it.
    /// @param number  EdgePart::edge
    const std::vector<EdgeVertex>& vertices_along(int panel, int number) const
    {
        const size_t edges = edge_vertices[size_t(panel)].size();
        return size_t(number) < edges ? edge_vertices[size_t(panel)][size_t(number)]
                                      : panel_lines[size_t(panel)][size_t(number) - edges];
    }

    int vertex_count() const { return int(uv.size()); }
    int triangle_count() const { return int(triangles.size()); }
    int panel_count() const { return int(edge.size()); }
    int panel_of_vertex(int vertex) const;
    int panel_of_triangle(int triangle) const;
};

/// Line in a panel that edges of the mesh have to follow: a fold, the place of a pocket.
struct InnerLine {
    int panel = 0;            ///< index into Pattern::panels
    std::vector<Vec2> points; ///< [2 or more] in the panel's plane; the last is the first of a closed one [m]
    std::string name;         ///< for messages
};

struct PatternMeshSettings {
    double edge = 0.01;              ///< [m] target of edge lengths; none is much longer
    std::vector<double> panel_edges; ///< [panels] targets of their own [m]; empty: `edge` for all

    /// Lines besides those of the panels and the folds of the pattern. They cross neither each other, nor
    /// folds, nor the outline. Ends nearer to the outline than 1/1000 of its length are put on it, and so on
    /// what is sewn to it.
    std::vector<InnerLine> lines;
};

/// Most vertices of a mesh. More are taken for a mistake in the unit or the target.
inline constexpr double kMaxPatternVertices = 4e6;

/// Meshes all panels with triangles that are as equilateral as the outlines allow; the same bits in every
/// run.
///
/// Points on the outline are set first and stay. Along a seam both sides have equally many, at the same
/// fractions of its arc length, close enough for the longer side and the finer panel. Corners and ends of
/// parts of one side are points of the other. Where two corners of opposite sides are nearer than 0.5 % of
/// the seam, they meet and fractions are counted between them.
///
/// A panel that is narrower than the target gets a smaller one: three times its area over its outline, or a
/// thousandth of the outline if that is more. Once the pattern is sewn, no edge of one panel has both ends in
/// common with an edge of another but along the seam: the sewn surface stays manifold.
/// @throws InvalidInput naming source, panel, edge or seam, and value: an outline that is open, crosses or
///         touches itself, has no area or an edge without length; parts of seams that overlap; lines that
///         cross; targets that are not positive or ask for more than kMaxPatternVertices
PatternMesh mesh_pattern(const Pattern& pattern, const PatternMeshSettings& settings);

} // namespace toile::garment
