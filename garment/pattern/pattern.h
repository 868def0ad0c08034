#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "core/compute/types.h"
#include "garment/energy/fold/fold_edge.h"

/// Sewing pattern: flat panels with curved edges, the seams between them, and where each panel starts.
namespace toile::garment {

/// Bezier curve of degree 1 + number of control points: none is a straight edge.
struct Bezier {
    std::vector<Vec2> controls; ///< [0..2] in the panel's plane [m]
};

/// Arc of a circle. Of the two arcs through both ends that turn the same way, `large` chooses the longer.
struct CircularArc {
    double radius = 0.0; ///< [m] at least half the distance of the ends
    bool large = false;  ///< over 180 degrees
    bool counter_clockwise =
        false; ///< direction of travel about the centre; then a short arc is to the right
};

/// Side of a panel, from one corner to another.
struct PanelEdge {
    int start = 0; ///< index into Panel::corners
    int end = 0;   ///< index into Panel::corners
    std::variant<Bezier, CircularArc> curve;
    std::string label; ///< meaning of the edge, such as lower_interface; empty for most
};

/// Part of the body that panels are laid around.
enum class BodySegment { Torso, Neck, LeftArm, RightArm, LeftLeg, RightLeg };

/// Start of a panel on the cylinder around a segment of the body, in place of Panel::placement.
struct BodyPlacement {
    BodySegment at = BodySegment::Torso;
    double angle_deg = 0.0; ///< of its middle about the segment's axis: 0 in front, 90 at the body's left
    double height = 0.5;    ///< [-] of its middle: 0 at hand, foot, crotch or collarbone, 1 at the other end
    double distance = 0.03; ///< [m] from the skin
    bool wrap = true;       ///< bent onto the cylinder; otherwise flat
};

/// Line inside of a panel, to which others may be sewn, as pockets are.
struct PanelLine {
    std::string name;
    std::vector<Vec2> points; ///< [2 or more] in the panel's plane; the last is the first of a closed one [m]
};

/// Piece of cloth, cut along its edges.
struct Panel {
    std::string name;
    std::vector<Vec2> corners;    ///< [m] in the panel's plane, x right, y up
    std::vector<PanelEdge> edges; ///< one closed loop: each ends where the next starts
    std::vector<PanelLine> lines; ///< of different names
    std::string label;            ///< part of the body that it covers, such as body, arm, leg; may be empty

    /// World from panel: where the panel starts, flat, before it is sewn. The normal of its loop, counter-
    /// clockwise, points away from the body.
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    std::optional<BodyPlacement> place; ///< absent: by `placement`

    std::string fabric;                ///< name of a preset; empty: the garment's
    std::optional<double> edge_length; ///< [m] of the mesh's edges; absent: the garment's
    double grain_deg = 0.0;            ///< warp from the panel's y axis, counter-clockwise in its own plane
    double shrink_warp = 1.0;          ///< [-] length at rest over that of the cut panel, along the warp
    double shrink_weft = 1.0;          ///< [-] along the weft
    int layer = 0;                     ///< higher is further outside where panels lie on each other
};

/// Line that an index of edges stands for: those past Panel::edges are Panel::lines. Null for an edge.
inline const PanelLine* line_of(const Panel& panel, int edge)
{
    return edge < int(panel.edges.size()) ? nullptr : &panel.lines[size_t(edge) - panel.edges.size()];
}

/// Part of a panel's edge, by arc length. from > to runs against the edge.
struct EdgePart {
    int panel = 0;     ///< index into Pattern::panels
    int edge = 0;      ///< index into Panel::edges, or past them into Panel::lines
    double from = 0.0; ///< [-] fraction of the edge's length at which the part starts
    double to = 1.0;   ///< [-] at which it ends
};

/// Side of a seam that keeps its length; the other one is gathered or stretched to it.
enum class Gather { Short, Long };

/// Two chains of edges that are sewn to each other, point by point in proportion to arc length: the start of
/// `a` meets the start of `b`.
struct Seam {
    std::vector<EdgePart> a; ///< consecutive parts
    std::vector<EdgePart> b;
    std::string name;              ///< for messages: how the file calls it
    std::string flip;              ///< for messages: the change of the file that joins the other ends
    double fold_deg = 0.0;         ///< fold along the seam at rest, outer sides towards each other; 0: flat
    int order = 0;                 ///< lower ones are sewn first
    Gather gather = Gather::Short; ///< length of the sewn line, where one side is longer
};

/// Elastic sewn along edges, which gathers the cloth as it contracts.
struct Elastic {
    std::vector<EdgePart> edges;
    double ratio = 0.8;      ///< [-] of its length at rest over that of the edges
    double stiffness = 20.0; ///< [N] tension per unit of its strain
};

/// Line on a panel along which its cloth is folded at rest, as a pleat is.
struct PanelFold {
    int panel = 0;                     ///< index into Pattern::panels
    std::vector<Vec2> points;          ///< [2 or more] in the panel's plane [m]
    double angle_deg = 0.0;            ///< outer sides towards each other
    double stiffness = kFoldStiffness; ///< [N] moment per length of the fold and radian
    std::string name;                  ///< for messages: how the file calls it
};

/// Point of a panel.
struct PanelPoint {
    int panel = 0;             ///< index into Pattern::panels
    Vec2 point = Vec2::Zero(); ///< in the panel's plane [m]
};

/// Tack or button: two points that are pulled together and then held.
struct Closure {
    PanelPoint a, b;
    double close_at = 0.0; ///< [s] after gravity begins to act on the garment; 0: while it is sewn
    std::string name;      ///< for messages: how the file calls it
};

/// What is held softly on the body.
struct BodyAttachment {
    std::vector<EdgePart> edges;
    std::vector<PanelPoint> points;
    bool is_released = false; ///< once the garment rests
};

struct Pattern {
    std::string source; ///< file, for messages
    std::string description;
    std::vector<Panel> panels;
    std::vector<Seam> seams;
    std::vector<Elastic> elastics;
    std::vector<PanelFold> folds;
    std::vector<Closure> closures;
    std::vector<BodyAttachment> attachments;
    std::vector<std::filesystem::path> files; ///< that it was read from
};

} // namespace toile::garment
