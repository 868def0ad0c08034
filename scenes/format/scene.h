#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/compute/types.h"
#include "core/pd/minimiser/outer_method.h"
#include "core/pd/preconditioner/contact_preconditioner.h"
#include "core/pd/step/bdf2.h"
#include "core/pd/step/step_stop.h"
#include "garment/energy/fold/fold_edge.h"

/// Contents of a scene file: plain values, checked on reading, nothing loaded yet.
///
/// SI units and Y up throughout. Every placement is world = translate + R * scale * unit * point; R rotates
/// about the fixed X axis first, then Y, then Z (rotate_deg). The meaning of each key is stated once, in
/// describe.h; the reader, the JSON Schema and docs/reference/keys.md are made from it.
namespace toile::scene {

/// Unit of length of a mesh file.
enum class LengthUnit { Metre, Centimetre, Millimetre, Inch };

/// Metres in one unit: 1, 0.01, 0.001 or 0.0254.
double metres_per(LengthUnit unit);

/// Upward axis of a file.
enum class UpAxis { Y, Z };

/// Placement of an object at a time; RigidMotion interpolates.
struct Keyframe {
    double time = 0.0;             ///< [s] from sample 0
    Vec3 translate = Vec3::Zero(); ///< [m] added to the object's own translate
    Vec3 rotate_deg = Vec3::Zero();
};

struct Wind {
    Vec3 velocity = Vec3::Zero(); ///< [m/s]
    double turbulence = 0.0;      ///< [-] standard deviation of the gusts relative to the velocity
    int seed = 0;                 ///< chooses the gusts
};

/// Drag of the air on cloth, per area: 1/2 density |u| (normal u_n + tangential u_t), u relative velocity.
struct Air {
    double density = 1.2; ///< [kg/m^3]
    double normal = 1.0;  ///< [-] drag coefficient across the cloth
    double tangential = 0.05;
};

// --- avatars --------------------------------------------------------------------------------------------

/// The built-in walking mannequin, with its built-in clips.
struct Mannequin {
    double height = 1.75; ///< [m] crown above soles
};

/// Half space y <= 0 in its local frame. Infinite for contact.
struct Plane {
    double preview_size = 10.0; ///< [m] side of the square drawn in pictures
};

struct Sphere {
    double radius = 0.25; ///< [m] about the origin
};

/// Points within `radius` of the segment from y = -length/2 to y = length/2.
struct Capsule {
    double radius = 0.1; ///< [m]
    double length = 0.5; ///< [m] between the centres of its two caps
};

struct Box {
    Vec3 size = Vec3::Constant(0.5); ///< [m] edge lengths, about the origin
};

/// Start of an animated avatar from a standstill into its clip, from sample 0 on.
struct Preroll {
    double hold = 0.0;      ///< [s] standing still
    double ease = 0.0;      ///< [s] of the blend from the bind pose and of the acceleration, each
    bool from_bind = false; ///< stand in the bind pose first and blend into the clip's pose
};

/// A clip in a file of its own.
struct AvatarMotion {
    std::filesystem::path file;
    std::string clip;          ///< by name; empty: the longest of the file
    std::string map = "names"; ///< "names", "cmu" or the path of a map of joints

    bool is_mapped_by_file() const { return map != "names" && map != "cmu"; }
};

using AvatarShape = std::variant<std::filesystem::path, Mannequin, Plane, Sphere, Capsule, Box>;

/// What is done about skin that touches other skin of the same avatar: moved apart, or nothing.
enum class SelfContact { Separate, Keep };

/// A body that cloth collides with.
struct Avatar {
    std::string name;
    AvatarShape shape;
    std::optional<std::filesystem::path> mesh; ///< with the faces of a cache that stores none
    std::optional<double> fps;      ///< [1/s] of a cache that has no times; read_scene() puts the scene's
    std::optional<LengthUnit> unit; ///< of the file; absent: what it says, or the default of its format
    std::optional<UpAxis> up;       ///< of the file; absent: what it says, or Y
    double scale = 1.0;             ///< [-]
    Vec3 translate = Vec3::Zero();  ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    std::string clip; ///< animation by name; empty: the bind pose, or that of `motion` or of a cache
    std::optional<AvatarMotion> motion; ///< replaces `clip`
    bool loop = false;                  ///< repeat the clip; otherwise its last pose stays
    bool accumulate_root = false;       ///< repeated cycles continue the root motion instead of jumping back
    double speed = 1.0;                 ///< [-] clip seconds per scene second; 0 freezes the pose at start
    double start = 0.0;                 ///< [s] of the clip at sample 0
    Preroll preroll;
    std::vector<Keyframe> keyframes;
    SelfContact self_contact = SelfContact::Separate;
    std::vector<std::string> exclude_bones; ///< faces that follow these do not collide
    std::optional<double> friction;         ///< [-] Coulomb coefficient; absent: Contact::friction
    Vec3 color = Vec3(0.78, 0.72, 0.66);    ///< [-] sRGB

    bool has_mesh() const
    {
        return std::holds_alternative<std::filesystem::path>(shape) ||
               std::holds_alternative<Mannequin>(shape);
    }
};

// --- cloths ---------------------------------------------------------------------------------------------

/// Flat, horizontal, centred on the origin, warp along X, right side up.
struct Rectangle {
    Vec2 size = Vec2(1.0, 1.0); ///< [m] along X and Z
    double resolution = 0.02;   ///< [m] target edge length
};

/// Flat, horizontal, centred on the origin, right side up.
struct Disc {
    double radius = 0.5;      ///< [m]
    double resolution = 0.02; ///< [m] target edge length
};

/// A conical skirt about the Y axis, waist at y = 0, cut flat and sewn.
struct Skirt {
    double waist_radius = 0.12; ///< [m] circumference / 2 pi
    double hem_radius = 0.25;   ///< [m] at least the waist's, at most waist_radius + length
    double length = 0.5;        ///< [m] along the cloth from waist to hem
    double resolution = 0.02;   ///< [m] target edge length
};

using ClothShape = std::variant<std::filesystem::path, Rectangle, Disc, Skirt>;

enum class Print { Plain, Checker, Stripes };

/// Source of a cloth's rest shape: its mesh as it is posed, or its texture coordinates.
enum class RestFrom { Shape, Uv };

/// Threads along the lines of a cloth's file.
struct Sewing {
    double stiffness = 1000.0; ///< [N/m] of each
    double max_force = 0.5;    ///< [N] of each
};

/// Elastic that gathers the cloth along edges of its mesh.
struct Elastic {
    std::vector<int> vertices; ///< along edges; the first again in the end of a closed one
    double ratio = 0.8;        ///< [-] of its length at rest over that of the edges
    double stiffness = 20.0;   ///< [N] tension per unit of its strain
};

/// Line along which cloth is folded at rest.
struct Fold {
    std::vector<int> vertices;                  ///< [2 or more] of the file, along edges of its mesh
    double angle_deg = 0.0;                     ///< outer sides towards each other
    double stiffness = garment::kFoldStiffness; ///< [N] moment per length of the fold and radian
};

/// Two points of a cloth that are pulled together and then held, as by a few stitches or a button.
struct Tack {
    int a = 0, b = 0;      ///< vertices of the file
    double close_at = 0.0; ///< [s] from sample 0 on; 0: from the start, settling too
};

/// Settings of a group of a cloth's file.
struct ClothGroup {
    std::string fabric; ///< key of Scene::fabrics or name of a preset
};

/// Channel of the vertex colours of a cloth's file, by its number in them.
enum class PaintChannel { Red, Green, Blue };

/// Values that a channel paints: `from` where it is 0, `to` where it is 1, linearly between them.
struct PaintedValue {
    PaintChannel channel = PaintChannel::Red;
    double from = 1.0, to = 1.0;
};

struct PaintedStiffness : PaintedValue {}; ///< [-] factor on the fabric's stretch, shear and bending
struct PaintedThickness : PaintedValue {}; ///< [m] in place of the fabric's

/// Properties of a cloth that the vertex colours of its file paint.
struct Painted {
    std::optional<PaintedStiffness> stiffness;
    std::optional<PaintedThickness> thickness;
};

/// Overpressure on the side that a cloth's normals point away from.
struct Pressure {
    double pa = 0.0;   ///< [Pa]
    double ramp = 0.0; ///< [s] from sample 0 until it is reached; 0: it acts from the beginning

    /// Pressure at time t [s], which is negative while the scene settles.
    double at(double t) const { return ramp > 0.0 ? pa * std::clamp(t / ramp, 0.0, 1.0) : pa; }
};

struct Cloth {
    std::string name;
    ClothShape shape;
    int subdivide = 0;               ///< number of times that every triangle is split into four
    bool weld = true;                ///< join edges of the file that lie on each other
    std::optional<LengthUnit> unit;  ///< of the file; absent: what it says, or metres
    RestFrom rest = RestFrom::Shape; ///< what the rest shape is taken from
    std::optional<std::filesystem::path>
        rest_file; ///< mesh with the faces of `shape`, whose texture is the rest shape; absent: its own
    std::optional<double> uv_scale; ///< [m] per texture unit, before `scale`; absent: areas agree
    double scale = 1.0;             ///< [-]
    Vec3 translate = Vec3::Zero();  ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    std::string fabric = "cotton";            ///< key of Scene::fabrics or name of a preset
    double grain_deg = 0.0;                   ///< rotation of the warp direction in the cloth plane
    std::optional<double> thickness;          ///< [m] replaces the fabric's
    std::optional<Sewing> sewing;             ///< absent: lines of the file are left out
    std::map<std::string, ClothGroup> groups; ///< by name; other triangles are of `fabric`
    std::vector<Elastic> elastics;
    std::vector<Fold> folds;
    std::vector<Tack> tacks;
    std::optional<Pressure> pressure;
    std::optional<Painted> painted;
    int layer = 0;                       ///< higher is further outside if cloths cross at the start
    Vec3 color = Vec3(0.30, 0.45, 0.68); ///< [-] sRGB
    Print print = Print::Plain;          ///< in pictures
    std::optional<Print> pattern;        ///< former key for print
};

/// One number per thread direction; absent: as in the base fabric.
struct WarpWeft {
    std::optional<double> warp;
    std::optional<double> weft;
};

/// A fabric defined by the scene: a preset with some numbers replaced.
struct Fabric {
    std::string base = "cotton";
    std::optional<double> areal_density; ///< [kg/m^2]
    WarpWeft stretch;                    ///< [N/m]
    std::optional<double> shear;         ///< [N/m]
    WarpWeft bend;                       ///< [N m]
    std::optional<double> strain_limit;  ///< [-] maximum length over rest length; Fabric's plus 1
    std::optional<double> thickness;     ///< [m]
    std::optional<double> damping;       ///< [1/s]
    std::optional<double> stretch_damping, shear_damping, bend_damping; ///< [s]
    std::optional<double> bend_friction;                                ///< [1/m]
};

// --- solids ---------------------------------------------------------------------------------------------

using SolidShape = std::variant<std::filesystem::path, Sphere, Capsule, Box>;

/// A rigid body simulated with the cloth: both act on each other; it collides with avatars and other solids.
struct Solid {
    std::string name;
    SolidShape shape;
    LengthUnit unit = LengthUnit::Metre; ///< of the file
    double scale = 1.0;                  ///< [-]
    Vec3 translate = Vec3::Zero();       ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    double density = 1000.0;        ///< [kg/m^3]
    Vec3 velocity = Vec3::Zero();   ///< [m/s] at the start, of its centre of mass
    Vec3 spin = Vec3::Zero();       ///< [rad/s] at the start
    std::optional<double> friction; ///< [-] Coulomb coefficient; absent: Contact::friction, or the avatar's
    Vec3 color = Vec3(0.85, 0.85, 0.88); ///< [-] sRGB
};

/// Inside of a soft body that moves as an avatar does. The soft body replaces the avatar in contact, pictures
/// and caches.
struct Core {
    std::string avatar;
    double depth = 0.02;                  ///< [m] from the avatar's surface at the start down to the core
    std::vector<std::string> rigid_bones; ///< what is nearest to skin that follows these is core throughout
};

/// A soft body: a solid that deforms, simulated with the cloth.
struct SoftBody {
    std::string name;
    std::optional<std::filesystem::path> file; ///< of tetrahedra, or of a closed surface; absent: the surface
                                               ///< of the core's avatar at the start
    std::optional<double> cell;                ///< [m] edges of the tetrahedra that fill a surface
    std::optional<Core> core;
    std::optional<std::filesystem::path> render; ///< surface for pictures and caches, where `file` is
    LengthUnit unit = LengthUnit::Metre;         ///< of the file
    double scale = 1.0;                          ///< [-]
    Vec3 translate = Vec3::Zero();               ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    double density = 1000.0;           ///< [kg/m^3]
    double young = 1e5;                ///< [Pa]
    double poisson = 0.3;              ///< [-]
    double damping = 0.0;              ///< [1/s] as Fabric::damping
    Vec3 velocity = Vec3::Zero();      ///< [m/s] at the start
    std::optional<double> friction;    ///< [-] as Solid::friction
    int layer = 0;                     ///< higher is further outside if soft bodies cross at the start
    Vec3 color = Vec3(0.8, 0.55, 0.5); ///< [-] sRGB

    /// Name of its surface for pictures and caches.
    std::string render_name() const { return name + "_render"; }
};

// --- attachments ----------------------------------------------------------------------------------------

/// Vertices inside an upright box, in start positions.
struct SelectBox {
    Vec3 lower = Vec3::Zero(); ///< [m]
    Vec3 upper = Vec3::Zero(); ///< [m]
};

/// Vertices at most `distance` from an avatar, in start positions.
struct SelectNearAvatar {
    std::string avatar;
    double distance = 0.0; ///< [m]
};

/// Vertices of a cloth: by index, in a box, nearest to each point [m], or near an avatar.
struct Selection {
    std::variant<std::vector<int>, SelectBox, std::vector<Vec3>, SelectNearAvatar> by;
};

/// Value of Attachment::to for the world.
inline constexpr const char* kFixed = "fixed";

/// Stiffness of attachments to avatars [N/m] per vertex: firm enough for a wide coat, soft enough that cloth
/// yields where skin stretches.
inline constexpr double kSkinStiffness = 300.0;

/// Vertices attached to the world, along keyframes, or to an avatar's moving surface.
struct Attachment {
    std::string cloth;
    Selection select;
    std::string to = kFixed;         ///< "fixed" or an avatar's name
    std::vector<Keyframe> keyframes; ///< motion of the attached points; only with "fixed"
    std::optional<Vec3> pivot;     ///< [m] about which keyframes turn; absent: mean of the attached vertices
    std::optional<double> release; ///< [s] end of the attachment; absent: never
    std::optional<double>
        stiffness;      ///< [N/m] of a spring per vertex; absent: kSkinStiffness at least, or exact if fixed
    bool exact = false; ///< no springs
};

// --- the rest -------------------------------------------------------------------------------------------

/// Friction between two materials, avatars or solids; overrides their default coefficients.
struct FrictionPair {
    std::vector<std::string> between; ///< two names of fabrics, avatars or solids; equal ones for a fabric
    double friction = 0.3;            ///< [-]
};

struct Contact {
    double gap = 0.001;     ///< [m] kept between cloth and avatar beyond half the cloth's thickness
    double stiffness = 1.0; ///< [-] relative to the solver's default
    double friction = 0.3;  ///< [-] of avatars without a coefficient, and between cloths
    std::vector<FrictionPair> friction_pairs;
    bool self = true;         ///< cloth collides with itself and other cloth
    bool repair_start = true; ///< cloth that starts inside avatars or crosses cloth is moved
};

/// Auto to Paper: the global step inside projective dynamics. Xpbd, Vbd: replace the whole method.
enum class SolverMethod {
    Auto,
    Direct,
    Quadrature,
    Multigrid,
    Subspace,
    Chebyshev,
    AJacobi,
    JacobiPcg,
    Paper,
    Xpbd,
    Vbd
};

/// Named accuracy of a run.
enum class Quality { Preview, Standard, Final };

struct Sleep {
    bool enabled = true;
    double speed = 0.003; ///< [m/s] cloth falls asleep whose vertices move less, RMS over half a second
};

struct Solver {
    static constexpr int kSubsteps = 4; ///< where nothing estimates the error of a step
    std::optional<int> substeps;        ///< time steps per sample; absent: chosen by what moves
    std::optional<double> step_error;   ///< [m] of steps by what moves; absent: that of the quality
    Quality quality = Quality::Standard;
    std::optional<double> velocity_tolerance; ///< [m/s] absent: that of the quality
    std::optional<double> tolerance;          ///< [m] of a step; former key for velocity_tolerance
    StepStop stop = StepStop::Error;
    std::optional<Integrator> integrator; ///< absent: second order where Newton's method runs
    std::optional<int> max_iterations; ///< outer iterations per minimisation; absent: enough for the method
    SolverMethod method = SolverMethod::Auto;
    std::optional<OuterMethod> outer; ///< absent: Newton's method, or L-BFGS for previews and baselines
    ContactPreconditioner contact_preconditioner = ContactPreconditioner::Block;
    Sleep sleep;
    int threads = 0; ///< 0: all threads of the machine
};

enum class ExportUnit { Metre, Centimetre };

/// Numbers of a cloth beside its positions.
enum class ExportAttribute { Strain, Gap, Panel };

/// A cache to write; the extension gives its format.
struct Export {
    std::filesystem::path file;      ///< relative to the output folder
    std::vector<std::string> cloths; ///< cloths and solids, or "all"; empty: the only one, or all in formats
                                     ///< that hold several meshes
    bool avatars = false;            ///< also those, as triangles
    std::optional<int>
        start_frame;   ///< number of the first frame; absent: 1 in formats with a time line, else 0
    int subframes = 1; ///< samples per frame
    ExportUnit unit = ExportUnit::Metre;
    UpAxis up = UpAxis::Y;
    bool velocities = true; ///< in formats that have them
    bool normals = false;   ///< the same; creased at seams
    bool thickness = false; ///< closes each cloth with its thickness
    bool weld = true;       ///< false: one mesh for each group of faces, such as a panel
    std::vector<ExportAttribute> attributes;

    bool stores(ExportAttribute attribute) const
    {
        return std::find(attributes.begin(), attributes.end(), attribute) != attributes.end();
    }
    bool operator==(const Export&) const = default;
};

struct Render {
    int width = 1280;
    int height = 720;
    double azimuth_deg = 30.0;          ///< camera rotation about Y from +Z towards +X
    double elevation_deg = 12.0;        ///< camera above the horizon
    double zoom = 1.0;                  ///< 1 fits everything into the picture
    std::optional<double> ground = 0.0; ///< [m] height of the floor; absent: none
    int samples = 16;                   ///< light paths per pixel
};

} // namespace toile::scene

namespace toile::scenes {

struct Scene {
    std::filesystem::path source; ///< file that it was read from
    std::string name;             ///< derived from the file's name if the file gives none
    std::string description;
    int frames = 1;                       ///< samples to write; sample 0 is the state after settling
    double fps = 30.0;                    ///< [1/s] samples per second
    Vec3 gravity = Vec3(0.0, -9.81, 0.0); ///< [m/s^2]
    scene::Wind wind;
    scene::Air air;
    double settle = 0.0; ///< [s] simulated before sample 0, with avatars in their first pose
    std::vector<scene::Avatar> avatars;
    std::vector<scene::Cloth> cloths;
    std::vector<scene::Solid> solids;
    std::vector<scene::SoftBody> soft_bodies;
    std::map<std::string, scene::Fabric> fabrics;
    std::vector<scene::Attachment> attachments;
    scene::Contact contact;
    scene::Solver solver;
    std::vector<scene::Export> exports; ///< empty: one PC2 per surface, named after it
    scene::Render render;

    /// Time between samples [s].
    double frame_duration() const { return 1.0 / fps; }
    /// Length of a time step of a fixed number per sample [s].
    double step_duration() const
    {
        return frame_duration() / solver.substeps.value_or(scene::Solver::kSubsteps);
    }
};

/// Soft body whose core follows the avatar of this name, which it replaces; null: none.
const scene::SoftBody* replacement_of(const Scene& scene, const std::string& avatar);

/// Names of the cloths, solids and soft bodies, then of the surfaces that soft bodies have for pictures and
/// caches, in the order of World::surfaces().
std::vector<std::string> surface_names(const Scene& scene);

/// Number of the cloths, solids and soft bodies.
int simulated_count(const Scene& scene);

} // namespace toile::scenes
