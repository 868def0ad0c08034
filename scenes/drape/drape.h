#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "scenes/drape/garment_mesh.h"
#include "scenes/format/scene.h"
#include "scenes/world/world_options.h"

namespace toile::scenes {

/// How a drape ended.
enum class DrapeOutcome {
    Draped,
    Meshing,   ///< the time limit ended it before it was sewn
    Placement, ///< the panels do not lie around the body
    Tangled,   ///< a seam or a closure could not be pulled shut
    NotAtRest, ///< the garment still moves after DrapeSettings::max_motion
    SlidOff,   ///< a labelled edge sank by more than kMaxSlide after it was released
    Solver,    ///< a step gave numbers that are not finite
};

/// Distance by which a released edge may sink [m].
inline constexpr double kMaxSlide = 0.05;

/// Distance at rest between the ends of a closure that holds [m]: a spring of 2000 N/m gives way by less.
inline constexpr double kMaxOpen = 0.01;

/// A moment of a drape.
struct DrapeProgress {
    std::string stage;     ///< with the garment, where there are several: "tee, sew"
    double time = 0.0;     ///< [s] simulated in the stage; 0: its scene is being loaded
    double duration = 0.0; ///< [s] to be simulated in it at most; 0: it ends by what happens
    double seconds = 0.0;  ///< [s] of wall time since it began
};

struct DrapeGarment {
    std::filesystem::path file;    ///< garment file or panel JSON
    std::string name;              ///< in files and messages: letters, digits, _ and -; no other has it
    std::string fabric = "cotton"; ///< of panels without one
};

struct DrapeSettings {
    std::vector<DrapeGarment> garments; ///< one or more, innermost first
    scene::Avatar body;                 ///< in the pose of its first sample
    double edge = 0.01;                 ///< [m] of the final meshes
    Vec3 shift = Vec3::Zero();          ///< [m] added to the placement of the panels
    double max_motion = 20.0;           ///< [s] of simulated time until a garment has to be at rest
    double time_limit = std::numeric_limits<double>::infinity(); ///< [s] of wall time
    std::function<void(const DrapeProgress&)> progress;          ///< called after every sample; may be empty
    std::filesystem::path folder;                                ///< of the meshes of its stages; exists
};

struct DrapeStage {
    std::string name; ///< mesh, fold, sew, press, settle, drape
    double seconds = 0.0;
    int frames = 0;
    int vertices = 0; ///< of the garment
    int steps = 0;    ///< time steps
};

struct DrapeSeam {
    std::string name;
    double gap = 0.0; ///< [m] largest, before it was welded
};

struct DrapeSlide {
    std::string label;
    double slid = 0.0; ///< [m] that the mean of the edge sank after it was released
};

struct DrapeClosure {
    std::string name;
    double gap = 0.0; ///< [m] between its ends where the garment ended
};

struct DrapedGarment {
    std::string name;
    std::vector<DrapeStage> stages;
    std::vector<DrapeSeam> seams;
    std::vector<DrapeSlide> slides;
    std::vector<DrapeClosure> closures;
    double lift = 0.0; ///< [m] of the panels before they were sewn: shoulder_lift()
    int pieces = 0, border_loops = 0, euler_characteristic = 0;
    GarmentSurface surface; ///< as it ended; if seams are open, with lines as threads; empty: not begun
};

struct DrapeResult {
    DrapeOutcome outcome = DrapeOutcome::Draped;
    std::string message;                 ///< one line, unless it is draped
    std::vector<DrapedGarment> garments; ///< that were begun, in the order of the settings
    std::optional<double> rest_speed;    ///< [m/s] of the fastest vertex in the last half second of "drape"
    double max_strain = 0.0;             ///< [-]
    Scene scene;                         ///< that simulates the garments on from there
};

/// Sews patterns around a body and drapes them, one after the other. A garment is sewn over those below it as
/// they lie; where it is draped, they move too.
///
///   mesh    panels at kSewingEdge and at the final edge length
///   fold    the coarse panels fold along the lines of their folds, without gravity; only with folds
///   sew     panels whose shoulder seams would be pulled against the body are lifted (shoulder_lift()); then
///           threads pull the seams shut, without gravity, on the coarse mesh (SeamClosing); longer sides are
///           gathered. Closures without a time close too
///   press   the welded coarse mesh unfolds along its seams
///   settle  it falls into place
///   drape   the same on the fine mesh, until it is at rest; labelled edges are held by springs, and released
///           but for the waist and strapless tops
///
/// The meshes of every stage are written to the folder before it runs.
/// @throws InvalidInput for a pattern, fabric or body that does not work; Cancelled as World
DrapeResult drape(const DrapeSettings& settings, const WorldOptions& options);

} // namespace toile::scenes
