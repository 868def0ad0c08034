#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/backend/types.h"
#include "core/pd/nested/contact_preconditioner.h"
#include "core/pd/outer_method.h"
#include "core/pd/step_stop.h"

/// A scene as its JSON file says it: plain values, checked on reading, nothing loaded yet.
///
/// SI units and Y up throughout. Every placement reads world = translate + R * scale * unit * point, with R
/// turning about the fixed X axis first, then Y, then Z (rotate_deg). What each key means to a user stands in
/// one place, describe.h; the reader, the JSON Schema and docs/scenes/keys.md are all made from it.
namespace toile::scene {

/// Unit of length of a mesh file.
enum class LengthUnit { Metre, Centimetre, Millimetre, Inch };

/// Metres in one unit: 1, 0.01, 0.001 or 0.0254.
double metres_per(LengthUnit unit);

/// Where an object is at a time. Between keyframes translation and angles run straight; outside they stay.
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

/// The built-in walking figure. Its clips are its own.
struct Mannequin {
    double height = 1.75; ///< [m] crown above soles
};

/// y = 0 in its own frame, solid below. Endless for contact.
struct Plane {
    double preview_size = 10.0; ///< [m] side of the square that pictures show
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

/// How an animated figure comes from rest into its clip, from sample 0 on.
struct Preroll {
    double hold = 0.0;      ///< [s] standing still
    double ease = 0.0;      ///< [s] of the blend from the bind pose and of the speeding up, each
    bool from_bind = false; ///< stand in the bind pose first and blend into the clip's pose
};

using AvatarShape = std::variant<std::filesystem::path, Mannequin, Plane, Sphere, Capsule, Box>;

/// A body that cloth touches.
struct Avatar {
    std::string name;
    AvatarShape shape;
    std::optional<LengthUnit> unit; ///< of the file; absent: what its format says
    double scale = 1.0;             ///< [-]
    Vec3 translate = Vec3::Zero();  ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    std::string clip;             ///< animation by name; empty: the bind pose
    bool loop = false;            ///< repeat the clip; otherwise its last pose stays
    bool accumulate_root = false; ///< a repeated walk goes on instead of jumping back
    double speed = 1.0;           ///< [-] clip seconds per scene second; 0 freezes the pose at start
    double start = 0.0;           ///< [s] of the clip at which it begins
    Preroll preroll;
    std::vector<Keyframe> keyframes;
    std::vector<std::string> exclude_bones; ///< cloth passes through what follows these
    std::optional<double> friction;         ///< [-] Coulomb coefficient; absent: Contact::friction
    Vec3 color = Vec3(0.78, 0.72, 0.66);    ///< [-] sRGB
};

// --- cloths ---------------------------------------------------------------------------------------------

/// Flat, horizontal, centred on the origin, warp along X, right side up.
struct Rectangle {
    Vec2 size = Vec2(1.0, 1.0); ///< [m] along X and Z
    double resolution = 0.02;   ///< [m] edge length wanted
};

/// Flat, horizontal, centred on the origin, right side up.
struct Disc {
    double radius = 0.5;      ///< [m]
    double resolution = 0.02; ///< [m] edge length wanted
};

/// A conical skirt about the Y axis, waist at y = 0, cut flat and closed by our own code.
struct Skirt {
    double waist_radius = 0.12; ///< [m] circumference / 2 pi
    double hem_radius = 0.25;   ///< [m] at least the waist's, at most waist_radius + length
    double length = 0.5;        ///< [m] along the cloth from waist to hem
    double resolution = 0.02;   ///< [m] edge length wanted
};

using ClothShape = std::variant<std::filesystem::path, Rectangle, Disc, Skirt>;

enum class PreviewPattern { Plain, Checker, Stripes };

struct Cloth {
    std::string name;
    ClothShape shape;
    int subdivide = 0;                   ///< times every triangle is split into four
    LengthUnit unit = LengthUnit::Metre; ///< of the file
    double scale = 1.0;                  ///< [-]
    Vec3 translate = Vec3::Zero();       ///< [m]
    Vec3 rotate_deg = Vec3::Zero();
    std::string fabric = "cotton";       ///< key of Scene::fabrics or name of a preset
    double grain_deg = 0.0;              ///< turns the warp direction in the cloth plane
    std::optional<double> thickness;     ///< [m] replaces the fabric's
    int layer = 0;                       ///< higher is further outside where cloths cross at the start
    Vec3 color = Vec3(0.30, 0.45, 0.68); ///< [-] sRGB
    PreviewPattern pattern = PreviewPattern::Plain;
};

/// One number per thread direction; absent: as in the base fabric.
struct WarpWeft {
    std::optional<double> warp;
    std::optional<double> weft;
};

/// A fabric of the scene's own: a preset with some numbers replaced.
struct Fabric {
    std::string base = "cotton";
    std::optional<double> areal_density; ///< [kg/m^2]
    WarpWeft stretch;                    ///< [N/m]
    std::optional<double> shear;         ///< [N/m]
    WarpWeft bend;                       ///< [N m]
    std::optional<double> strain_limit;  ///< [-] largest length over rest length; Fabric's plus 1
    std::optional<double> thickness;     ///< [m]
    std::optional<double> damping;       ///< [1/s]
};

// --- solids ---------------------------------------------------------------------------------------------

using SolidShape = std::variant<std::filesystem::path, Sphere, Capsule, Box>;

/// A rigid body that moves by itself: cloth pulls and carries it, and it meets avatars and other solids.
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

/// Which vertices of a cloth: their indices, a box, the nearest to each point [m], or those near an avatar.
struct Selection {
    std::variant<std::vector<int>, SelectBox, std::vector<Vec3>, SelectNearAvatar> by;
};

/// Name that stands for the world in Attachment::to.
inline constexpr const char* kFixed = "fixed";

/// Vertices held by something: by the world, along keyframes, or by an avatar's moving surface.
struct Attachment {
    std::string cloth;
    Selection select;
    std::string to = kFixed;         ///< "fixed" or an avatar's name
    std::vector<Keyframe> keyframes; ///< moves the held points; only with "fixed"
    std::optional<double> release;   ///< [s] when the hold ends; absent: never
    std::optional<double> stiffness; ///< [N/m] of a spring per vertex; absent: held exactly
};

// --- the rest -------------------------------------------------------------------------------------------

/// Friction between two materials, avatars or solids, in place of what they have by themselves.
struct FrictionPair {
    std::vector<std::string> between; ///< two names of fabrics, avatars or solids; equal ones for a fabric
    double friction = 0.3;            ///< [-]
};

struct Contact {
    double gap = 0.001;     ///< [m] kept between cloth and avatar beyond half the cloth's thickness
    double stiffness = 1.0; ///< [-] relative to the solver's own choice
    double friction = 0.3;  ///< [-] of avatars that name none, and between cloths
    std::vector<FrictionPair> friction_pairs;
    bool self = true;         ///< cloth touches itself and other cloth
    bool repair_start = true; ///< cloth that starts inside avatars or through cloth is moved
};

/// Auto to Paper: the global step inside projective dynamics. Xpbd, Vbd: another method altogether.
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

struct Sleep {
    bool enabled = true;
    double speed = 0.001; ///< [m/s] cloth whose fastest vertex stays below is put to rest
};

struct Solver {
    int substeps = 4;        ///< time steps per sample
    double tolerance = 1e-3; ///< [m] error that a step may end with
    StepStop stop = StepStop::Error;
    int max_iterations = 30; ///< outer iterations per minimisation; see StepRounds
    SolverMethod method = SolverMethod::Auto;
    OuterMethod outer = OuterMethod::Lbfgs;
    ContactPreconditioner contact_preconditioner = ContactPreconditioner::Block;
    Sleep sleep;
    int threads = 0; ///< 0: all of the machine's
};

/// A cache to write, its format told by the extension.
struct Export {
    std::filesystem::path file; ///< relative to the output folder
    std::string cloth;          ///< or solid; empty: the scene's only one
};

struct Render {
    int width = 1280;
    int height = 720;
    double azimuth_deg = 30.0;          ///< camera turned about Y from +Z towards +X
    double elevation_deg = 12.0;        ///< camera above the horizon
    double zoom = 1.0;                  ///< 1 fits everything into the picture
    std::optional<double> ground = 0.0; ///< [m] height of the floor; absent: none
    int samples = 16;                   ///< light paths per pixel
};

} // namespace toile::scene

namespace toile {

struct Scene {
    std::filesystem::path source; ///< the file it was read from
    std::string name;             ///< from the file's name when the file gives none
    std::string description;
    int frames = 1;                       ///< samples to write; sample 0 is the start state, after settling
    double fps = 30.0;                    ///< [1/s] samples per second
    Vec3 gravity = Vec3(0.0, -9.81, 0.0); ///< [m/s^2]
    scene::Wind wind;
    scene::Air air;
    double settle = 0.0; ///< [s] simulated before sample 0 while avatars hold their first pose
    std::vector<scene::Avatar> avatars;
    std::vector<scene::Cloth> cloths;
    std::vector<scene::Solid> solids;
    std::map<std::string, scene::Fabric> fabrics;
    std::vector<scene::Attachment> attachments;
    scene::Contact contact;
    scene::Solver solver;
    std::vector<scene::Export> exports; ///< empty: one PC2 per cloth and solid, named after it
    scene::Render render;

    /// Seconds from one sample to the next.
    double frame_duration() const { return 1.0 / fps; }
};

} // namespace toile
