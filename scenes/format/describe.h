#pragma once

#include "scenes/format/field.h"

/// Single description of the scene file: every key with its member, its allowed values and a sentence.
///
/// describe(visitor, object) calls, in the order of the documentation,
///   visitor.field(key, member, [range,] sentence)       optional; absent keeps the default
///   visitor.required(key, member, [range,] sentence)
///   visitor.number_or_off(key, member, range, sentence) a number or the word "off"
///   visitor.number_or_quotient(key, member, range, sentence) a number or a text as "24000/1001"
///   visitor.names(key, member, sentence)                   a name or a list of names
///   visitor.number_or_object(key, member, number, range, sentence)
///                                                       an object, or a number for one of its members
///   visitor.pair(key, member, range, sentence)          {"warp": number, "weft": number}, each optional
///   visitor.one_of(variant, Alternative...)             exactly one of the keys, which chooses the member
///   visitor.version(key, number, sentence)              must be present and equal
/// describe() never reads the object itself, so a visitor needs none. Visitors: keys.h, reader.h,
/// schema_writer.h.
namespace toile::scene_format {

template <typename V>
void describe(V& v, Keyframe& k)
{
    v.required("time", k.time, kTime, "Seconds from sample 0.");
    v.field("translate", k.translate, kPosition, "Added to the object's own translate.");
    v.field("rotate_deg", k.rotate_deg, kAngle, "Added to the object's own rotate_deg.");
}

template <typename V>
void describe(V& v, Wind& w)
{
    v.field("velocity", w.velocity, between(-100.0, 100.0, "m/s"), "Direction and speed of the wind.");
    v.field("turbulence", w.turbulence, between(0.0, 2.0),
            "Strength of gusts: standard deviation of the air's velocity relative to its mean.");
    v.field("seed", w.seed, between(0, 1000000), "Chooses other gusts of the same strength.");
}

template <typename V>
void describe(V& v, Air& a)
{
    v.field("density", a.density, between(0.0, 100.0, "kg/m^3"),
            "Density of the air; 0 turns drag and wind off.");
    v.field("normal", a.normal, between(0.0, 10.0), "Drag coefficient for air that blows across the cloth.");
    v.field("tangential", a.tangential, between(0.0, 10.0), "Drag coefficient for air that blows along it.");
}

template <typename V>
void describe(V& v, Mannequin& m)
{
    v.field("height", m.height, between(1.0, 2.5, "m"), "Height from the soles to the crown.");
}

template <typename V>
void describe(V& v, Plane& p)
{
    v.field("preview_size", p.preview_size, above_zero(1000.0, "m"),
            "Side of the square drawn in pictures; for contact the plane is infinite.");
}

template <typename V>
void describe(V& v, Sphere& s)
{
    v.field("radius", s.radius, above_zero(100.0, "m"), "Radius about the origin.");
}

template <typename V>
void describe(V& v, Capsule& c)
{
    v.field("radius", c.radius, above_zero(100.0, "m"), "Radius of the tube and of its two caps.");
    v.field("length", c.length, between(0.0, 100.0, "m"), "Along Y, between the centres of the caps.");
}

template <typename V>
void describe(V& v, Box& b)
{
    v.field("size", b.size, above_zero(100.0, "m"), "Edge lengths along X, Y and Z, about the origin.");
}

template <typename V>
void describe(V& v, Preroll& p)
{
    v.field("hold", p.hold, between(0.0, 60.0, "s"), "Time at rest before the clip starts.");
    v.field("ease", p.ease, between(0.0, 60.0, "s"),
            "Duration of the blend from the bind pose and of the acceleration, each.");
    v.field("from_bind", p.from_bind, "Stand in the bind pose first and blend into the clip's pose.");
}

template <typename V>
void describe(V& v, AvatarMotion& m)
{
    v.required("file", m.file, "Motion to load: .bvh, .fbx, .glb or .gltf; its mesh, if any, is left out.");
    v.field("clip", m.clip, "Animation of the file, by name; empty: the longest.");
    v.field(
        "map", m.map,
        "\"names\": the file's bones have the names and axes of the avatar's. \"cmu\": retargeted from a "
        "skeleton of the CMU library. Else a JSON file {\"joint of the avatar\": \"joint of the file\"} by "
        "which it is retargeted.");
}

template <typename V>
void describe(V& v, Avatar& a)
{
    v.required("name", a.name, "Name, for attachments and messages.");
    v.one_of(a.shape,
             Alternative<std::filesystem::path>{
                 "file",
                 "Body to load: .glb, .gltf, .fbx or .obj; or a cache of its positions: .abc, .usda, .usdc, "
                 ".pc2, .mdd, or a sequence, body_####.obj or .ply. One of several meshes is named behind #: "
                 "shot.abc#/body/bodyShape."},
             Alternative<Mannequin>{"mannequin",
                                    "The built-in mannequin; its clips are walk_in_place, walk and turn."},
             Alternative<Plane>{"plane", "Endless floor: y = 0, solid below."},
             Alternative<Sphere>{"sphere", "Sphere."}, Alternative<Capsule>{"capsule", "Capsule along Y."},
             Alternative<Box>{"box", "Box with edges along the axes."});
    v.field("mesh", a.mesh, "Mesh with the faces of a cache that stores none: the OBJ on which it plays.");
    v.field("fps", a.fps, between(1.0, 10000.0, "1/s"),
            "Samples per second of a cache that has no times (.pc2, sequences); absent: the scene's.");
    v.field("unit", a.unit,
            "Length unit of the file; absent: what it or its format says (.fbx cm), else metres.");
    v.field("up", a.up, "Upward axis of the file; absent: what it says, else y.");
    v.field("scale", a.scale, above_zero(1e6), "Factor on the file's lengths.");
    v.field("translate", a.translate, kPosition, "Moves the avatar, after scale and rotate_deg.");
    v.field("rotate_deg", a.rotate_deg, kAngle, "Rotates about the fixed X axis, then Y, then Z.");
    v.field(
        "clip", a.clip,
        "Animation to play, by name; empty: the bind pose. A cache has one, \"cache\", which plays anyway.");
    v.field("motion", a.motion, "Animation from a file of its own, instead of a clip.");
    v.field("loop", a.loop, "Repeat the clip; otherwise its last pose stays.");
    v.field("accumulate_root", a.accumulate_root,
            "Repeated cycles continue the root motion instead of jumping back.");
    v.field("speed", a.speed, between(0.0, 10.0),
            "Seconds of the clip per second of the scene; 0 freezes it.");
    v.field("start", a.start, kTime, "Time in the clip at which playback begins.");
    v.field("preroll", a.preroll, "Start of the avatar from a standstill into its clip.");
    v.field("keyframes", a.keyframes, "Moves a shape, a cache or a body without animation.");
    v.field("self_contact", a.self_contact,
            "\"separate\" moves skin inwards, by up to 2 cm, where a clip brings it on or into other skin of "
            "the body, so that cloth fits between; \"keep\" leaves it as it is.");
    v.field(
        "exclude_bones", a.exclude_bones,
        "Cloth passes through the faces that follow these bones or bones below them; pictures show them.");
    v.field("friction", a.friction, between(0.0, 10.0), "Coulomb coefficient; absent: contact.friction.");
    v.field("color", a.color, kColor, "Red, green, blue in pictures, of a body whose file has no colours.");
}

template <typename V>
void describe(V& v, Rectangle& r)
{
    v.field("size", r.size, above_zero(100.0, "m"), "Lengths along X (warp) and Z (weft).");
    v.field("resolution", r.resolution, kResolution, "Target edge length of the mesh.");
}

template <typename V>
void describe(V& v, Disc& d)
{
    v.field("radius", d.radius, above_zero(100.0, "m"), "Radius about the origin.");
    v.field("resolution", d.resolution, kResolution, "Target edge length of the mesh.");
}

template <typename V>
void describe(V& v, Skirt& s)
{
    v.field("waist_radius", s.waist_radius, above_zero(10.0, "m"), "Waist circumference over 2 pi.");
    v.field("hem_radius", s.hem_radius, above_zero(10.0, "m"),
            "Radius of the hem's cone, from waist_radius to waist_radius + length.");
    v.field("length", s.length, above_zero(10.0, "m"), "Along the cloth, from waist to hem.");
    v.field("resolution", s.resolution, kResolution, "Target edge length of the mesh.");
}

template <typename V>
void describe(V& v, Sewing& s)
{
    v.field("stiffness", s.stiffness, kStiffness, "Of each thread.");
    v.field("max_force", s.max_force, above_zero(1000.0, "N"), "With which each thread pulls at most.");
}

template <typename V>
void describe(V& v, Elastic& e)
{
    v.required(
        "vertices", e.vertices, between(0, 1e8),
        "Indices into the cloth's mesh, counted from 0: a path along its edges. A closed one ends with "
        "its first.");
    v.required("ratio", e.ratio, between(0.2, 1.0), "Length of the elastic at rest over that of the edges.");
    v.required("stiffness", e.stiffness, above_zero(1e5, "N"),
               "Tension per unit of strain of the elastic; it does not push.");
}

template <typename V>
void describe(V& v, Fold& f)
{
    v.required("vertices", f.vertices, between(0, 1e9), "Vertices of the file along edges of its mesh.");
    v.required("angle_deg", f.angle_deg, kFoldAngle,
               "Angle between the faces at rest, outer sides towards each other; 0: flat.");
    v.field("stiffness", f.stiffness, kFoldStiffness, "Moment per length of the fold and radian of opening.");
}

template <typename V>
void describe(V& v, Tack& t)
{
    v.required("a", t.a, between(0, 1e8), "Vertex of the file, counted from 0.");
    v.required("b", t.b, between(0, 1e8), "Vertex that it is pulled to.");
    v.field("close_at", t.close_at, kTime,
            "Time at which it begins to close; 0: from the start, settling too.");
}

template <typename V>
void describe(V& v, PaintedStiffness& p)
{
    v.required("channel", p.channel, "Channel of the vertex colours.");
    v.required("from", p.from, kStiffnessFactor, "Factor where the channel is 0.");
    v.required("to", p.to, kStiffnessFactor, "Factor where the channel is 1.");
}

template <typename V>
void describe(V& v, PaintedThickness& p)
{
    v.required("channel", p.channel, "Channel of the vertex colours.");
    v.required("from", p.from, kThickness, "Thickness where the channel is 0.");
    v.required("to", p.to, kThickness, "Thickness where the channel is 1.");
}

template <typename V>
void describe(V& v, Painted& p)
{
    v.field("stiffness", p.stiffness,
            "Factor on stretch, shear and bending of the fabric, averaged over each triangle.");
    v.field("thickness", p.thickness, "Thickness at each vertex, in place of the fabric's.");
}

template <typename V>
void describe(V& v, Pressure& p)
{
    v.required("pa", p.pa, kPressure, "Pressure, once it is reached.");
    v.field("ramp_s", p.ramp, kTime,
            "Time from sample 0 in which it rises from 0; 0: it acts from the start, while settling too.");
}

template <typename V>
void describe(V& v, ClothGroup& g)
{
    v.required("fabric", g.fabric, "A key of fabrics or the name of a preset.");
}

template <typename V>
void describe(V& v, Cloth& c)
{
    v.required("name", c.name, "Name, for attachments, messages and the cache's file.");
    v.one_of(c.shape,
             Alternative<std::filesystem::path>{
                 "file", "Mesh to load: .obj, or the first sample of a mesh in an archive, "
                         "tee.abc#/tee/teeShape; its vertex order is the cache's."},
             Alternative<Rectangle>{"rectangle", "Flat rectangle, horizontal, about the origin."},
             Alternative<Disc>{"disc", "Flat disc, horizontal, about the origin."},
             Alternative<Skirt>{"skirt", "Conical skirt about the Y axis, waist at y = 0, hanging down."});
    v.field("subdivide", c.subdivide, between(0, 4), "Number of times every triangle is split into four.");
    v.field("weld", c.weld,
            "Join edges of the file that lie on each other, as along texture seams; false keeps them apart.");
    v.field("unit", c.unit, "Length unit of the file; absent: what it says, else metres.");
    v.field("rest", c.rest,
            "Rest shape: the mesh as it is posed (\"shape\"), or each triangle's texture coordinates, flat "
            "(\"uv\"), as of garments made from patterns.");
    v.field("rest_file", c.rest_file,
            "OBJ or mesh in an archive with the same faces as file, whose texture coordinates are the rest "
            "shape of \"rest\": "
            "\"uv\" in place of the file's own, as of gathers.");
    v.field("uv_scale", c.uv_scale, above_zero(1e6, "m"),
            "Metres per texture unit of \"rest\": \"uv\", before scale; unit does not apply to it. Absent: "
            "as much as makes the areas at rest and of the mesh equal; the run prints it.");
    v.field("scale", c.scale, above_zero(1e6), "Factor on the cloth's lengths, at rest too.");
    v.field("translate", c.translate, kPosition, "Moves the cloth, after scale and rotate_deg.");
    v.field("rotate_deg", c.rotate_deg, kAngle, "Rotates about the fixed X axis, then Y, then Z.");
    v.field("fabric", c.fabric, "A key of fabrics or the name of a preset.");
    v.field("groups", c.groups,
            "Fabrics of groups (g) of the file, by name, where they differ. Thickness, friction and damping "
            "are those of the cloth's fabric. Not with xpbd and vbd, nor on a GPU.");
    v.field("grain_deg", c.grain_deg, kAngle,
            "Rotation of the warp in the cloth's plane, from the X axis of flat cloth and the vertical of "
            "garments; with \"rest\": \"uv\" in the texture's plane, counter-clockwise from its v axis.");
    v.field("thickness", c.thickness, kThickness, "Replaces the fabric's thickness.");
    v.field(
        "sewing", c.sewing,
        "Threads that pull together the vertices that lines (l) of the file join, as of panels to be sewn.");
    v.field("elastics", c.elastics,
            "Elastics along edges of the mesh, which gather the cloth as they contract. Not with subdivide, "
            "xpbd and vbd, nor on a GPU.");
    v.field("folds", c.folds,
            "Lines along which the cloth is folded at rest, as pleats are. It bends there by their stiffness "
            "alone. Not with subdivide, xpbd and vbd, nor on a GPU.");
    v.field("tacks", c.tacks,
            "Pairs of points that are pulled together at 0.2 m/s and then held, as by tacks or buttons. Not "
            "with xpbd and vbd, nor on a GPU.");
    v.number_or_object("pressure", c.pressure, &Pressure::pa, kPressure,
                       "Overpressure on the side that the faces' normals point away from, as of air in a "
                       "cushion. Not with xpbd and vbd, nor on a GPU.");
    v.field("painted", c.painted,
            "What the vertex colours of the file (v x y z r g b, from 0 to 1) paint. Not with xpbd and vbd, "
            "nor on a GPU.");
    v.field("layer", c.layer, between(-100, 100),
            "Order on a body: where cloths cross, coincide or lie in the wrong order at the start, the "
            "repair moves the one with the higher layer outside.");
    v.field("color", c.color, kColor, "Red, green, blue in pictures.");
    v.field("print", c.print, "Print on the cloth in pictures.");
    v.field("pattern", c.pattern, "Former key: print.");
}

template <typename V>
void describe(V& v, Solid& s)
{
    v.required("name", s.name, "Name, for friction pairs, messages and the cache's file.");
    v.one_of(s.shape,
             Alternative<std::filesystem::path>{
                 "file", "Closed surface (.obj) or tetrahedra (.vtk, legacy), filled with matter."},
             Alternative<Sphere>{"sphere", "Sphere."}, Alternative<Capsule>{"capsule", "Capsule along Y."},
             Alternative<Box>{"box", "Box with edges along the axes."});
    v.field("unit", s.unit, "Length unit of the file.");
    v.field("scale", s.scale, above_zero(1e6), "Factor on the solid's lengths.");
    v.field("translate", s.translate, kPosition, "Moves the solid, after scale and rotate_deg.");
    v.field("rotate_deg", s.rotate_deg, kAngle, "Rotates about the fixed X axis, then Y, then Z.");
    v.field("density", s.density, above_zero(1e5, "kg/m^3"), "Mass per volume.");
    v.field("velocity", s.velocity, between(-100.0, 100.0, "m/s"),
            "Velocity of its centre of mass at the start.");
    v.field("spin", s.spin, between(-1000.0, 1000.0, "rad/s"), "Angular velocity at the start.");
    v.field("friction", s.friction, between(0.0, 10.0),
            "Coulomb coefficient if no friction pair applies; two solids use the smaller one. Absent: "
            "contact.friction, or the avatar's.");
    v.field("color", s.color, kColor, "Red, green, blue in pictures.");
}

template <typename V>
void describe(V& v, Core& c)
{
    v.required("avatar", c.avatar, "Name of the avatar, with a mesh, that moves it.");
    v.field("depth", c.depth, between(0.0, 10.0, "m"),
            "Vertices that start at least as deep below the avatar's surface move as its bones do.");
    v.field("rigid_bones", c.rigid_bones,
            "Bones around which all is core, such as those of hands and feet; with their descendants.");
}

template <typename V>
void describe(V& v, SoftBody& s)
{
    v.required("name", s.name, "Name, for attachments, friction pairs, messages and the cache's file.");
    v.field("file", s.file,
            "Tetrahedra (.msh of Gmsh, .vtk of the legacy format), or a closed surface (.obj). Absent: the "
            "surface of core's avatar at the start.");
    v.field("cell", s.cell, above_zero(10.0, "m"),
            "Length of edges of the tetrahedra that fill a surface, after scale.");
    v.field("core", s.core,
            "Inside that follows an avatar. The soft body replaces the avatar in contact, pictures and "
            "caches.");
    v.field(
        "render", s.render,
        "Surface (.obj) in the file's axes and unit that moves with the tetrahedra, for pictures and caches; "
        "named NAME_render.");
    v.field("unit", s.unit, "Length unit of the file.");
    v.field("scale", s.scale, above_zero(1e6), "Factor on the body's lengths.");
    v.field("translate", s.translate, kPosition, "Moves the body, after scale and rotate_deg.");
    v.field("rotate_deg", s.rotate_deg, kAngle, "Rotates about the fixed X axis, then Y, then Z.");
    v.field("density", s.density, above_zero(1e5, "kg/m^3"), "Mass per volume.");
    v.field("young", s.young, above_zero(1e12, "Pa"), "Young's modulus: resistance to stretch.");
    v.field("poisson", s.poisson, between(0.0, 0.49),
            "Poisson's ratio: how much it narrows under a pull; near 0.5 it keeps its volume.");
    v.field("damping", s.damping, between(0.0, 1000.0, "1/s"), "Decay rate of velocities.");
    v.field("velocity", s.velocity, between(-100.0, 100.0, "m/s"), "Velocity at the start.");
    v.field("friction", s.friction, between(0.0, 10.0),
            "Coulomb coefficient if no friction pair applies; of two bodies the smaller one holds. Absent: "
            "contact.friction, or the avatar's.");
    v.field("layer", s.layer, between(-100, 100),
            "Order of soft bodies: where they cross at the start, the repair moves the one with the higher "
            "layer, or the later one, out of the other. Cloth is outside of all soft bodies.");
    v.field("color", s.color, kColor, "Red, green, blue in pictures.");
}

template <typename V>
void describe(V& v, Fabric& f)
{
    // Warp and weft are independent; both directions of a pair share one range and one sentence.
    const Range bend = between(0.0, 1.0, "N m");
    v.field("base", f.base, "Preset that gives every number left out here.");
    v.field("areal_density", f.areal_density, above_zero(10.0, "kg/m^2"), "Mass per area.");
    v.pair("stretch", f.stretch, kStiffness, "Resistance to stretch along the threads, per width.");
    v.field("shear", f.shear, kStiffness, "Resistance to shear between warp and weft.");
    v.pair("bend", f.bend, bend, "Bending rigidity across the threads; 0 turns bending off.");
    v.field("strain_limit", f.strain_limit, between(1.001, 10.0),
            "Maximum length over rest length, e.g. 1.06.");
    v.field("thickness", f.thickness, kThickness, "Thickness of the cloth.");
    v.field("damping", f.damping, between(0.0, 1000.0, "1/s"), "Decay rate of velocities, besides air drag.");
    const Range time = between(0.0, 10.0, "s");
    v.field("stretch_damping", f.stretch_damping, time, "Viscosity over stiffness along the threads.");
    v.field("shear_damping", f.shear_damping, time, "Viscosity over stiffness of shear.");
    v.field("bend_damping", f.bend_damping, time, "Viscosity over rigidity of bending.");
    v.field("bend_friction", f.bend_friction, between(0.0, 1000.0, "1/m"),
            "Curvature that friction between threads holds: half of Kawabata's 2HB over B.");
}

template <typename V>
void describe(V& v, SelectBox& b)
{
    v.required("lower", b.lower, kPosition, "Corner with the minimum coordinates.");
    v.required("upper", b.upper, kPosition, "Corner with the maximum coordinates.");
}

template <typename V>
void describe(V& v, SelectNearAvatar& n)
{
    v.required("avatar", n.avatar, "Name of the avatar.");
    v.required("distance", n.distance, between(0.0, 10.0, "m"), "Maximum distance from its surface.");
}

template <typename V>
void describe(V& v, Selection& s)
{
    v.one_of(
        s.by,
        Alternative<std::vector<int>>{"vertices",
                                      "Indices into the mesh of the cloth or soft body, counted from 0; of a "
                                      "soft body only vertices count that tetrahedra use.",
                                      between(0, 1e8)},
        Alternative<SelectBox>{"box", "Vertices that start inside a box of the world."},
        Alternative<std::vector<Vec3>>{
            "nearest", "For each point of the world the vertex nearest to it at the start.", kPosition},
        Alternative<SelectNearAvatar>{"all_within", "Vertices that start near an avatar."});
}

template <typename V>
void describe(V& v, Attachment& a)
{
    v.required("cloth", a.cloth, "Name of the cloth or soft body.");
    v.required("select", a.select, "Which of its vertices.");
    v.field("to", a.to,
            "\"fixed\": attached to the world; or the name of the avatar whose surface moves them.");
    v.field("keyframes", a.keyframes, "Moves the attached vertices; needs \"to\": \"fixed\".");
    v.field("pivot", a.pivot, kPosition,
            "Point of the world about which keyframes turn; absent: the mean of the attached vertices.");
    v.field("release", a.release, kTime, "Time at which the attachment ends; absent: never.");
    v.field("stiffness", a.stiffness, kStiffness,
            "Attach by a spring per vertex; absent: exactly to \"fixed\", to an avatar by 300 N/m, or more "
            "where few vertices hold heavy cloth.");
    v.field("exact", a.exact,
            "Attach exactly to an avatar too. Cloth then stretches and folds as the skin does.");
}

template <typename V>
void describe(V& v, FrictionPair& p)
{
    v.required(
        "between", p.between,
        "Two names of fabrics, avatars, solids or soft bodies; the same name twice for contact with itself.");
    v.required("friction", p.friction, between(0.0, 10.0), "Coulomb coefficient.");
}

template <typename V>
void describe(V& v, Contact& c)
{
    v.field(
        "gap", c.gap, between(0.0, 0.1, "m"),
        "Distance kept between cloth, solid or soft body and avatar, plus half the cloth's thickness. Two "
        "cloths keep their thickness instead; a solid or soft body adds half of this value.");
    v.field("stiffness", c.stiffness, between(0.001, 1000.0), "Factor on the solver's default stiffness.");
    v.field("friction", c.friction, between(0.0, 10.0),
            "Coulomb coefficient of avatars, solids and soft bodies without their own, and between cloths.");
    v.field("friction_pairs", c.friction_pairs, "Friction of particular pairs of materials.");
    v.field("self", c.self, "Contact of cloth with itself and other cloth. Not with xpbd and vbd.");
    v.field("repair_start", c.repair_start,
            "Move cloth and soft bodies that start inside or through others, or nearer to bodies than the "
            "gap; otherwise only report it.");
}

template <typename V>
void describe(V& v, Sleep& s)
{
    v.field("enabled", s.enabled, "Skip the steps of cloth that has come to rest.");
    v.field(
        "speed", s.speed, above_zero(1.0, "m/s"),
        "Cloth falls asleep if its vertices' displacement over half a second (root mean square) stays below "
        "that of this speed, and below 0.2 % of its size.");
}

template <typename V>
void describe(V& v, Solver& s)
{
    v.field("substeps", s.substeps, between(1, 1000),
            "Time steps from one sample to the next. Absent: chosen by what moves, between 1/60 and 1/960 s "
            "(1/3840 s in a storm); 4 "
            "for previews, with another minimiser than newton, with a named method, and with solids.");
    v.field("step_error", s.step_error, above_zero(0.1, "m"),
            "Error that a time step chosen by what moves may add, RMS over the vertices. Absent: 0.0001 for "
            "standard, 0.00003 for final.");
    v.field("quality", s.quality,
            "Named accuracy: preview (few iterations around a fixed matrix, folds come late), standard, or "
            "final.");
    v.field("velocity_tolerance", s.velocity_tolerance, above_zero(10.0, "m/s"),
            "Cloth that would move slower than this stands still; calm cloth is allowed three times as much. "
            "After a time T the cloth is within about 2 T times this of the exact solution. Absent: 0.12 for "
            "preview, 0.01 for standard, 0.002 for final.");
    v.field("tolerance", s.tolerance, above_zero(0.01, "m"),
            "Former key: velocity_tolerance times the time step.");
    v.field(
        "integrator", s.integrator,
        "Time integration: second order (bdf2), or implicit-euler, which damps all motion. Absent: bdf2 with "
        "newton. The other minimisers clamp strain after each step, which adds energy that bdf2 would keep.");
    v.field(
        "stop", s.stop,
        "Quantity that the tolerance of lbfgs bounds: error and move, or the move alone, as in papers. The "
        "latter is only for comparison: cloth that has landed on others then hangs in the air.");
    v.field(
        "max_iterations", s.max_iterations, between(1, 10000),
        "Iteration limit of a minimisation; a step that reaches it is reported. Absent: 100 for newton, 300 "
        "for the others, 30 for previews. For vbd the number of sweeps of a step, for xpbd of substeps with "
        "one pass each; all of them are done.");
    v.field("method", s.method,
            "Solver of the global linear system: exact (direct), quadrature of its kernel, the faster of the "
            "two (auto), or a baseline for comparison. xpbd and vbd replace the whole time step.");
    v.field("outer", s.outer,
            "Minimiser of a step. Absent: newton, which folds stiff cloth; lbfgs for previews. "
            "The others are for comparison.");
    v.field("contact_preconditioner", s.contact_preconditioner,
            "Active contact in the preconditioner of conjugate gradients: a bound for each vertex (block), "
            "exact, contact by contact (sherman-morrison), or Chebyshev steps. The paper's does not converge "
            "and is only for comparison.");
    v.field("sleep", s.sleep, "Conditions for skipping cloth at rest.");
    v.field("threads", s.threads, between(0, 1024),
            "Threads to use; 0: all. The result does not depend on it, except when auto changes from direct "
            "to quadrature.");
}

template <typename V>
void describe(V& v, Export& e)
{
    v.required("file", e.file, "Cache to write, inside the output folder; its extension gives the format.");
    v.names(
        "cloth", e.cloths,
        "Cloths, solids and soft bodies to write, by name, and NAME_render of a body's render surface; or "
        "all. Absent: the only one, or all where the format holds several meshes.");
    v.field("avatars", e.avatars, "Also write the avatars, as they are posed, in triangles.");
    v.field("start_frame", e.start_frame, between(0, 1e6),
            "Number of the first frame. Absent: 1 in formats with a time line (.abc, .usda), else 0.");
    v.field("subframes", e.subframes, between(1, 100),
            "Samples per frame, for motion blur. The simulation then ends a step at each.");
    v.field("unit", e.unit, "Unit of the numbers written. Blender and Houdini expect m, Maya and Unreal cm.");
    v.field("up", e.up, "Upward axis of the numbers written.");
    v.field("velocities", e.velocities, "Store velocities, for motion blur, in formats that have them.");
    v.field("normals", e.normals, "Store normals, creased at seams, in formats that have them.");
    v.field("thickness", e.thickness, "Close each cloth with its thickness: two sides and a rim.");
    v.field("weld", e.weld,
            "Write a cloth as one mesh; false: one for each group of its faces, such as a panel.");
    v.field(
        "attributes", e.attributes,
        "Numbers to store with cloths, in formats that have them: strain (larger principal strain) and gap "
        "(distance from the skin of the avatars, negative inside, in the unit) of vertices, panel (number of "
        "the group) of faces.");
}

template <typename V>
void describe(V& v, Render& r)
{
    v.field("width", r.width, between(16, 8192), "Pixels.");
    v.field("height", r.height, between(16, 8192), "Pixels.");
    v.field("azimuth_deg", r.azimuth_deg, kAngle, "Camera about the vertical, from +Z (0) towards +X (90).");
    v.field("elevation_deg", r.elevation_deg, between(-89.0, 89.0, "degrees"), "Camera above the horizon.");
    v.field("zoom", r.zoom, between(0.01, 100.0), "1 fits everything into the picture.");
    v.number_or_off("ground", r.ground, kPosition, "Height of the floor in pictures, or \"off\".");
    v.field("samples", r.samples, between(1, 1024), "Light paths per pixel; powers of two are spread best.");
}

template <typename V>
void describe(V& v, scenes::Scene& s)
{
    v.version("toile", 1, "Version of the format.");
    v.field("name", s.name, "Title; empty: the file's name.");
    v.field("description", s.description, "What the scene shows.");
    v.required("frames", s.frames, between(1, 1e6),
               "Samples to write. Sample 0 is the start state, after settling.");
    v.number_or_quotient("fps", s.fps, between(1.0, 10000.0, "1/s"),
                         "Samples per second, also as \"24000/1001\".");
    v.field("gravity", s.gravity, between(-1000.0, 1000.0, "m/s^2"), "Acceleration of free fall.");
    v.field("wind", s.wind, "Moving air.");
    v.field("air", s.air, "Drag of the air on cloth.");
    v.field("settle", s.settle, between(0.0, 600.0, "s"),
            "Time simulated before sample 0, with avatars in their first pose.");
    v.field("avatars", s.avatars, "Bodies that cloth collides with.");
    v.field("cloths", s.cloths, "Cloths to simulate. A scene has one at least, or a solid or soft body.");
    v.field("solids", s.solids, "Rigid bodies simulated together with the cloth. Need contact.self.");
    v.field("soft_bodies", s.soft_bodies,
            "Bodies that deform, simulated together with the cloth. Need contact.self.");
    v.field("fabrics", s.fabrics, "Fabrics of the scene's own, by name.");
    v.field("attachments", s.attachments, "Vertices attached to the world or to avatars.");
    v.field("contact", s.contact,
            "Contact of cloth, solids and soft bodies with avatars, themselves and each other.");
    v.field("solver", s.solver, "Accuracy and effort.");
    v.field("export", s.exports,
            "Caches to write; empty: one PC2 per cloth, solid and soft body, named after it.");
    v.field("render", s.render, "Preview pictures.");
}

} // namespace toile::scene_format
