#pragma once

#include <array>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "garment/pattern/mesh/panel_fill.h"

/// For sources of this folder alone: it shows CGAL.
namespace toile::garment {

/// Constrained Delaunay triangulation of a panel with vertices that may move, come and go inside. Exact: it
/// stays a triangulation whatever the rounding.
class PanelTriangulation {
public:
    struct VertexData {
        int index = -1;    ///< set by number_vertices()
        double size = 0.0; ///< length that edges here should have [m]
        bool is_fixed = false;
    };
    struct FaceData {
        int stamp = 0; ///< of whoever works through faces
        bool is_inside = true;
    };

    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexData, Kernel>;
    using FaceBase =
        CGAL::Triangulation_face_base_with_info_2<FaceData, Kernel,
                                                  CGAL::Constrained_triangulation_face_base_2<Kernel>>;
    using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
    using Cdt =
        CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
    using Vertex = Cdt::Vertex_handle;
    using Face = Cdt::Face_handle;
    using Corners = std::array<Vec2, 3>;

    PanelTriangulation(const PanelFrame& frame, double edge);

    double edge() const { return edge_; }
    /// Vertices that may move, in the order of their insertion or of memory.
    const std::vector<Vertex>& inside() const { return inside_; }
    std::vector<Face> inside_faces() const;
    /// Edges between faces inside, without those of the frame.
    std::vector<std::array<Vertex, 2>> free_edges() const;

    static Vec2 position(Vertex v) { return {v->point().x(), v->point().y()}; }
    static Corners corners(Face f);

    template <typename Visit>
    void for_each_face(Vertex v, const Visit& visit) const
    {
        auto f = cdt_.incident_faces(v);
        const auto start = f;
        do
            visit(Face(f));
        while (++f != start);
    }

    /// Face that holds x, by a walk straight from another; none where the frame is in between.
    Face find_face(Face from, const Vec2& x) const;
    /// Size at x by those of the corners of a face near it. [m]
    double size_at(Face f, const Vec2& x) const;
    /// True if x is nearer than `distance` [m] to an edge of the frame.
    /// @param f  face that holds x
    bool is_near_frame(Face f, const Vec2& x, double distance) const;
    /// True if all triangles around a vertex stay counter-clockwise when it moves to x.
    bool may_move(Vertex v, const Vec2& x) const;

    /// @param f  face that holds x
    Vertex insert(const Vec2& x, Face f);
    /// Inserts the middle of an edge if it still exists.
    void split_edge(Vertex a, Vertex b);
    /// Moves a vertex; may_move() must be true. Edges are not flipped.
    void move(Vertex v, const Vec2& x);
    /// Removes vertices inside.
    void remove(const std::vector<Vertex>& vertices);
    /// Flips edges until the triangulation is constrained Delaunay [Lawson 1977].
    void flip_to_delaunay();

    /// Lets sizes grow from the frame's spacing along edges.
    void propagate_sizes();
    /// Builds the triangulation anew with neighbours near each other in memory: with a million vertices,
    /// sweeps then take a fifth of the time.
    void order_in_memory();
    /// Numbers the frame as it came, then the inside in rows.
    /// @return [vertices] by their number
    std::vector<Vertex> number_vertices();

private:
    void insert_frame();
    void mark_outside();

    PanelFrame frame_;
    double edge_; ///< [m]
    Cdt cdt_;
    std::vector<Vertex> fixed_, inside_;
};

} // namespace toile::garment
