#pragma once

#include "scenes/format/field.h"
#include "scenes/garment_format/garment_file.h"

namespace toile::scene_format {

template <>
struct Words<garment_format::SeamJoin> {
    static constexpr std::array<std::pair<const char*, garment_format::SeamJoin>, 2> kAll{
        {{"start-end", garment_format::SeamJoin::StartEnd},
         {"start-start", garment_format::SeamJoin::StartStart}}};
};

template <>
struct Words<garment::Gather> {
    static constexpr std::array<std::pair<const char*, garment::Gather>, 2> kAll{
        {{"short", garment::Gather::Short}, {"long", garment::Gather::Long}}};
};

template <>
struct Words<garment::BodySegment> {
    static constexpr std::array<std::pair<const char*, garment::BodySegment>, 6> kAll{
        {{"torso", garment::BodySegment::Torso},
         {"neck", garment::BodySegment::Neck},
         {"left_arm", garment::BodySegment::LeftArm},
         {"right_arm", garment::BodySegment::RightArm},
         {"left_leg", garment::BodySegment::LeftLeg},
         {"right_leg", garment::BodySegment::RightLeg}}};
};

} // namespace toile::scene_format

namespace toile::garment {

template <typename V>
void describe(V& v, BodyPlacement& p)
{
    using scene_format::between;
    v.required("at", p.at, "Part of the body, seen by its wearer.");
    v.field("angle_deg", p.angle_deg, scene_format::kAngle,
            "Position of the panel's middle about the part: 0 in front, 90 at the body's left, 180 behind.");
    v.field("height", p.height, between(0.0, 1.0),
            "Position of the panel's middle along the part: 0 at hand, foot, crotch or the neck's base, 1 at "
            "the other end.");
    v.field("distance", p.distance, between(0.0, 1.0, "m"), "From the skin.");
    v.field("wrap", p.wrap, "Bend the panel about the part; otherwise it starts flat.");
}

} // namespace toile::garment

/// Single description of the garment file (see scenes/format/describe.h).
namespace toile::garment_format {

template <typename V>
void describe(V& v, PatternFile& p)
{
    v.required("file", p.file, "Panel JSON of GarmentCode or of the garment pattern generator.");
    v.field("unit", p.unit, "Length unit of the file; absent: what its units_in_meter says.");
}

template <typename V>
void describe(V& v, LineEntry& l)
{
    v.required("points", l.points, scene_format::between(-100.0, 100.0, "m"),
               "Corners [x, y] in the panel's plane; the last is the first of a closed line.");
}

template <typename V>
void describe(V& v, PanelSettings& p)
{
    using scene_format::between;
    v.field("fabric", p.fabric, "Name of a preset; absent: the garment's.");
    v.field("edge", p.edge, scene_format::kResolution,
            "Target edge length of the mesh; absent: the garment's.");
    v.field("grain_deg", p.grain_deg, scene_format::kAngle,
            "Warp from the panel's vertical, counter-clockwise in the drawing.");
    v.pair("shrink", p.shrink, between(0.5, 1.5),
           "Length at rest over that of the panel as it is cut and sewn, e.g. 0.95; absent: 1.");
    v.field(
        "copies", p.copies, between(1, 16),
        "Number of panels cut from this one: NAME, NAME_2, NAME_3 and so on, each 1 cm outside of the one "
        "before it on its side of the body. Stitches between panels with as many copies are repeated.");
    v.field("mirror", p.mirror,
            "NAME_2, NAME_4 and so on are mirror images, on the other side of the body (x to -x); left and "
            "right change places in their labels. Their edges count backwards: 0 is the last.");
    v.field("place", p.place, "Where it starts on the body; absent: where the pattern puts it.");
    v.field("layer", p.layer, between(-100, 100),
            "Order of panels that lie on each other; each starts 1 cm outside of the layer below.");
    v.field(
        "lines", p.lines,
        "Lines inside of the panel, by name, which seams may name as PANEL.LINE: pockets are sewn there.");
}

template <typename V>
void describe(V& v, SeamEntry& s)
{
    using scene_format::between;
    v.required("a", s.a,
               "Edges of one side, in order: PANEL.EDGE, where EDGE is an index or a label, or a part by "
               "arc length, PANEL.EDGE[0.2:0.6]; [1:0] runs backwards. Likewise PANEL.LINE, for a line "
               "inside of a panel.");
    v.required("b", s.b, "Edges of the other side.");
    v.field("join", s.join, "Whether the start of a meets the end of b, or its start.");
    v.field("fold_deg", s.fold_deg, scene_format::kFoldAngle,
            "Fold along the seam at rest, once it is sewn, outer sides towards each other; 0: flat.");
    v.field("order", s.order, between(0, 1000), "Seams with a lower number are sewn first.");
    v.field(
        "gather", s.gather,
        "Side that keeps its length where one is longer: the longer one is gathered to the shorter, or the "
        "shorter one stretched to the longer.");
}

template <typename V>
void describe(V& v, ElasticEntry& e)
{
    using scene_format::between;
    v.required("edges", e.edges,
               "Edges that it runs along, each by itself: PANEL.EDGE, or a part, PANEL.EDGE[0.2:0.6], to the "
               "nearest vertices of the mesh. Of a seam, name one side.");
    v.required("ratio", e.ratio, between(0.2, 1.0), "Length of the elastic at rest over that of the edges.");
    v.required("stiffness", e.stiffness, scene_format::above_zero(1e5, "N"),
               "Tension per unit of strain of the elastic; it does not push.");
}

template <typename V>
void describe(V& v, FoldEntry& f)
{
    using scene_format::between;
    v.field("panel", f.panel, "Panel that line lies on. Copies of it are folded alike.");
    v.field("line", f.line, between(-100.0, 100.0, "m"),
            "Points [x, y] in the panel's plane; ends on the outline are put on its points.");
    v.field("between", f.between,
            "In place of panel and line: two points of a panel's edges, PANEL.EDGE[0.25], by arc length. The "
            "fold is straight.");
    v.required("angle_deg", f.angle_deg, scene_format::kFoldAngle,
               "Angle of the fold at rest, outer sides towards each other.");
    v.field("stiffness", f.stiffness, scene_format::kFoldStiffness,
            "Moment per length of the fold and radian of opening.");
}

template <typename V>
void describe(V& v, ClosureEntry& c)
{
    v.required(
        "a", c.a,
        "Point of a panel: PANEL.EDGE[0.25], by a fraction of the edge's length, or PANEL[0.1,0.2], by "
        "metres in the panel's plane.");
    v.required("b", c.b, "Point that it is pulled to.");
    v.field("close_at", c.close_at, scene_format::between(0.0, 60.0, "s"),
            "Time from when the garment falls into place to when it begins to close; 0: it closes while the "
            "garment is sewn.");
}

template <typename V>
void describe(V& v, AttachEntry& a)
{
    v.field("edges", a.edges, "Edges, PANEL.EDGE, or parts of them, PANEL.EDGE[0.2:0.6].");
    v.field("points", a.points, "Points of panels, PANEL.EDGE[0.25] or PANEL[0.1,0.2].");
    v.field("release", a.release,
            "Release them once the garment rests; otherwise the written scene holds them.");
}

template <typename V>
void describe(V& v, GarmentFile& g)
{
    v.version("toile_garment", 1, "Version of the format.");
    v.field("description", g.description, "What the garment is.");
    v.required("patterns", g.patterns, "Files of panels and the stitches between them; at least one.");
    v.field("panels", g.panels, "Settings of panels, by name.");
    v.field("seams", g.seams,
            "Seams besides the patterns' stitches. One between the same two edges replaces the stitch.");
    v.field("elastics", g.elastics,
            "Elastics along edges, which gather the cloth as they contract, from the moment it falls into "
            "place on.");
    v.field("folds", g.folds, "Lines along which panels are folded before they are sewn, as pleats are.");
    v.field("closures", g.closures,
            "Tacks and buttons: pairs of points that are pulled together at 0.2 m/s and then held. Those "
            "between copied panels are repeated for as many copies as both have.");
    v.field("attach", g.attach,
            "Edges and points that springs of 300 N/m a vertex hold on the body while the garment falls into "
            "place and rests.");
}

} // namespace toile::garment_format
