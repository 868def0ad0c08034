#include "tests/garment/pattern/mesh/patterns.h"

#include <numbers>

#include "garment/pattern/mesh/mesh_quality.h"

namespace toile::garment::test {

namespace {

PanelEdge arc(int start, int end, double radius, bool counter_clockwise)
{
    return {start, end, CircularArc{radius, false, counter_clockwise}, ""};
}

} // namespace

Panel polygon(const std::string& name, const std::vector<Vec2>& corners)
{
    Panel panel;
    panel.name = name;
    panel.corners = corners;
    for (int i = 0; i < int(corners.size()); ++i)
        panel.edges.push_back({i, (i + 1) % int(corners.size()), Bezier{}, ""});
    return panel;
}

Panel rectangle(const std::string& name, double width, double height)
{
    return polygon(name, {{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}});
}

Panel half_disc(const std::string& name, double radius)
{
    Panel panel = polygon(name, {{-radius, 0.0}, {radius, 0.0}});
    panel.edges[1] = arc(1, 0, radius, true);
    return panel;
}

Panel disc(const std::string& name, double radius)
{
    Panel panel = half_disc(name, radius);
    panel.edges[0] = arc(0, 1, radius, true);
    return panel;
}

Panel half_ring(const std::string& name, double inner, double outer)
{
    Panel panel = polygon(name, {{outer, 0.0}, {-outer, 0.0}, {-inner, 0.0}, {inner, 0.0}});
    panel.edges[0] = arc(0, 1, outer, true);
    panel.edges[2] = arc(2, 3, inner, false);
    return panel;
}

Panel mirrored(Panel panel, const std::string& name)
{
    panel.name = name;
    for (Vec2& corner : panel.corners)
        corner.x() = -corner.x();
    for (PanelEdge& edge : panel.edges)
        if (auto* bezier = std::get_if<Bezier>(&edge.curve))
            for (Vec2& control : bezier->controls)
                control.x() = -control.x();
        else
            std::get<CircularArc>(edge.curve).counter_clockwise ^= true;
    return panel;
}

Pattern pattern_of(const Panel& panel)
{
    Pattern pattern;
    pattern.source = "test.json";
    pattern.panels = {panel};
    return pattern;
}

Seam seam(const std::string& name, int panel_a, int edge_a, int panel_b, int edge_b)
{
    return {{{panel_a, edge_a, 0.0, 1.0}}, {{panel_b, edge_b, 1.0, 0.0}}, name, {}};
}

Pattern front_and_back(const Panel& front, const std::vector<int>& sewn_edges)
{
    Pattern pattern = pattern_of(front);
    // Seen from outside, the back's loop is counter-clockwise too: the front's edges, in reverse order.
    Panel back = front;
    back.name = "back";
    back.edges.assign(front.edges.rbegin(), front.edges.rend());
    for (PanelEdge& edge : back.edges) {
        std::swap(edge.start, edge.end);
        if (auto* arc = std::get_if<CircularArc>(&edge.curve))
            arc->counter_clockwise = !arc->counter_clockwise;
    }
    pattern.panels.push_back(back);
    const int last = int(front.edges.size()) - 1;
    for (const int e : sewn_edges)
        pattern.seams.push_back(seam("seam " + std::to_string(e), 0, e, 1, last - e));
    return pattern;
}

Pattern tee()
{
    const Panel front = polygon("front", {{-0.25, 0.0},
                                          {0.25, 0.0},
                                          {0.25, 0.4},
                                          {0.42, 0.3},
                                          {0.48, 0.42},
                                          {0.1, 0.6},
                                          {-0.1, 0.6},
                                          {-0.48, 0.42},
                                          {-0.42, 0.3},
                                          {-0.25, 0.4}});
    return front_and_back(front, {1, 2, 4, 6, 8, 9});
}

Pattern trousers()
{
    const Panel front = polygon(
        "front", {{-0.25, 0.0}, {-0.05, 0.0}, {0.0, 0.6}, {0.05, 0.0}, {0.25, 0.0}, {0.2, 0.9}, {-0.2, 0.9}});
    return front_and_back(front, {1, 2, 4, 6});
}

double area_of(const PatternMesh& mesh, int panel)
{
    double twice = 0.0;
    for (int t = mesh.first_triangle[panel]; t < mesh.first_triangle[panel + 1]; ++t) {
        const Vec2 &a = mesh.uv[mesh.triangles[t][0]], &b = mesh.uv[mesh.triangles[t][1]],
                   &c = mesh.uv[mesh.triangles[t][2]];
        twice += (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    }
    return 0.5 * twice;
}

double smallest_angle_deg(const PatternMesh& mesh)
{
    return quality_of(mesh).smallest_angle * 180.0 / std::numbers::pi;
}

} // namespace toile::garment::test
