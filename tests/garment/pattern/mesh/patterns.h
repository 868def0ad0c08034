#pragma once

#include <string>
#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment::test {

/// Panel with straight edges along a closed polygon. [m]
Panel polygon(const std::string& name, const std::vector<Vec2>& corners);

/// Panel with straight edges from (0, 0): bottom, right, top, left. [m]
Panel rectangle(const std::string& name, double width, double height);

/// Half of a disc: its diameter from (-radius, 0) to (radius, 0), then the arc above. [m]
Panel half_disc(const std::string& name, double radius);

/// Disc of two arcs, counter-clockwise. [m]
Panel disc(const std::string& name, double radius);

/// Half of a circle skirt: outer arc, waist arc and two straight sides. [m]
Panel half_ring(const std::string& name, double inner, double outer);

/// The same panel in a mirror: its loop runs clockwise.
Panel mirrored(Panel panel, const std::string& name);

/// Pattern of one panel.
Pattern pattern_of(const Panel& panel);

/// Joins two whole edges, the start of one to the end of the other, as panel files have it.
Seam seam(const std::string& name, int panel_a, int edge_a, int panel_b, int edge_b);

/// Front and back of a garment: two panels sewn along some of their edges. The back is in a mirror.
Pattern front_and_back(const Panel& front, const std::vector<int>& sewn_edges);

/// T-shirt of a front and a back; its edges from the left of the hem, counter-clockwise. Neck, hem and both
/// cuffs stay open.
Pattern tee();

/// Trousers of a front and a back; waist and both hems stay open.
Pattern trousers();

/// Area of all triangles in the panel's plane, signed. [m^2]
double area_of(const PatternMesh& mesh, int panel = 0);

/// Smallest angle of a triangle. [degrees]
double smallest_angle_deg(const PatternMesh& mesh);

} // namespace toile::garment::test
