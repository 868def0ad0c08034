#include "scenes/drape/garment_draping.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "garment/pattern/place/placement_shift.h"
#include "scenes/drape/notions.h"
#include "scenes/drape/rest_watch.h"
#include "scenes/drape/seam_lift.h"
#include "scenes/world/world.h"

namespace toile::scenes {

namespace {

/// [vertices of all cloths] [m]
std::vector<Vec3> all_positions(const World& world)
{
    std::vector<Vec3> x;
    for (const ClothState& cloth : world.cloths())
        x.insert(x.end(), cloth.positions.begin(), cloth.positions.end());
    return x;
}

/// Time at which the last tack has begun to close, and moves what it will [s]; 0 if all hold from the start.
double last_closing(const Scene& scene)
{
    double last = 0.0;
    for (const scene::Tack& tack : scene.cloths.back().tacks)
        if (tack.close_at > 0.0)
            last = std::max(last, tack.close_at + RestWatch::kDuration);
    return last;
}

/// Replaces fabrics of a stage by presets, and lets tacks hold from the start.
void take_lasting_settings(const Garment& garment, scene::Cloth& cloth)
{
    for (scene::Tack& tack : cloth.tacks)
        tack.close_at = 0.0;
    cloth.fabric = garment.fabric;
    for (const auto& [panel, preset] : garment.panel_fabrics())
        cloth.groups[panel].fabric = preset;
}

constexpr double kSewingEdge = 0.02; ///< [m]
/// Time [s] for a garment to be pressed, and to fall into place on the coarse mesh.
constexpr double kPressingTime = 0.5, kSettlingTime = 1.0;
/// Longest time [s] for panels to fold.
constexpr double kFoldingTime = 4.0;
/// Frames in which threads become no shorter than by this ratio, after which pulling on ends.
constexpr int kVainFrames = 5;
constexpr double kProgress = 0.98;

} // namespace

GarmentDraping::GarmentDraping(const DrapeSettings& settings, const Garment& garment, const DressedBody& body,
                               std::vector<WornGarment>& worn, DrapeWatch& watch, DrapeResult& result)
    : settings_(settings), garment_(garment), body_(body), worn_(worn), watch_(watch), result_(result),
      number_(result.garments.size()), stages_(settings, garment, worn, watch)
{
    result_.garments.emplace_back();
    result_.garments.back().name = garment.name();
    result_.rest_speed.reset();
}

void GarmentDraping::run()
{
    const Clock clock;
    if (!lies_around_body())
        return;
    const GarmentMesh coarse(garment_.pattern, std::max(kSewingEdge, settings_.edge), kSewingEdge);
    GarmentMesh fine(garment_.pattern, settings_.edge);
    DrapedGarment& draped = result_.garments[number_];
    draped.pieces = fine.sewn.topology.pieces;
    draped.border_loops = fine.sewn.topology.border_loops;
    draped.euler_characteristic = fine.sewn.topology.euler_characteristic;
    end_stage("mesh", clock, 0, fine.panels.vertex_count());

    try {
        put_on(coarse, std::move(fine));
    } catch (const InvalidInput& error) {
        // The start of a stage can't be repaired: the garment lies in the body, or is too small for it.
        const std::vector<DrapeStage>& ended = result_.garments[number_].stages;
        const bool is_sewn =
            std::any_of(ended.begin(), ended.end(), [](auto& stage) { return stage.name == "sew"; });
        fail(is_sewn ? DrapeOutcome::Tangled : DrapeOutcome::Placement,
             (is_sewn ? "sewn, the garment does not fit around the body: "
                      : "the panels can't be sewn from where they are placed: ") +
                 std::string(error.what()));
    }
}

void GarmentDraping::put_on(const GarmentMesh& coarse, GarmentMesh fine)
{
    std::vector<Vec3> x = placed(coarse);
    if (!fold(coarse, x) || !sew(coarse, x))
        return;
    std::vector<Vec3> welded = weld(coarse.sewn, x);
    if (!press(coarse, welded) || !settle(coarse, welded))
        return;
    const garment::Resampling finer = garment::resample(coarse.panels, fine.panels);
    x = weld(fine.sewn, finer.apply(coarse.panels, unweld(coarse.sewn, welded)));
    drape({garment_, std::move(fine), std::move(x), {}});
}

bool GarmentDraping::lies_around_body()
{
    if (!body_.segments)
        return true;
    const garment::PlacementShift placement = garment::placement_shift(garment_.pattern, *body_.segments);
    if (placement.fits())
        return true;
    fail(DrapeOutcome::Placement, garment::misplacement_text(garment_.pattern, placement));
    return false;
}

std::vector<Vec3> GarmentDraping::placed(const GarmentMesh& mesh)
{
    std::vector<int> panel_of_vertex;
    panel_of_vertex.reserve(size_t(mesh.panels.vertex_count()));
    for (int v = 0; v < mesh.panels.vertex_count(); ++v)
        panel_of_vertex.push_back(mesh.panels.panel_of_vertex(v));
    std::vector<Vec3> x = garment::place_panels(garment_.pattern, mesh.panels.uv, panel_of_vertex,
                                                body_.segments ? &*body_.segments : nullptr);
    const double lift = shoulder_lift(mesh.panels.stitches, x, body_.skin);
    for (Vec3& p : x)
        p.y() += lift;
    result_.garments[number_].lift = lift;
    return x;
}

bool GarmentDraping::is_finite(const StepReport& report)
{
    if (report.status != StepReport::Status::NonFinite)
        return true;
    fail(DrapeOutcome::Solver, report.message);
    return false;
}

/// Folds the panels where the pattern has folds. x [vertices of the panels]
bool GarmentDraping::fold(const GarmentMesh& mesh, std::vector<Vec3>& x)
{
    if (garment_.pattern.folds.empty())
        return true;
    const Clock clock;
    int frames = 0;
    if (!simulate(stages_.fold(SeamClosing(mesh, x).panels()), kFoldingTime, frames, x))
        return false;
    end_stage("fold", clock, frames, int(x.size()));
    return true;
}

/// Pulls the seams shut. x [vertices of the panels] in: placed; out: sewn.
bool GarmentDraping::sew(const GarmentMesh& mesh, std::vector<Vec3>& x)
{
    const Clock clock;
    SeamClosing seams(mesh, std::move(x), orders_of(garment_.pattern));
    int frames = 0;
    bool goes_on = true;
    while (goes_on && !seams.are_closed()) {
        if (!pull(seams, frames))
            return false;
        goes_on = seams.weld() > 0;
    }
    x = seams.positions();
    end_stage("sew", clock, frames, int(x.size()));
    const std::vector<double> gaps = seams.gaps();
    for (size_t s = 0; s < gaps.size(); ++s)
        result_.garments[number_].seams.push_back({garment_.pattern.seams[s].name, gaps[s]});
    if (seams.are_closed())
        return true;
    const auto widest = size_t(seams.widest());
    fail(DrapeOutcome::Tangled, garment_.pattern.seams[widest].name + " stays open by " +
                                    std::to_string(1000.0 * gaps[widest]) + " mm");
    return false;
}

/// Pulls on the open threads until all can be welded or none gets shorter.
bool GarmentDraping::pull(SeamClosing& seams, int& frames)
{
    World world(stages_.sew(seams.surface(), seams.tacks(garment_.pattern)), watch_.options());
    double shortest = std::numeric_limits<double>::infinity();
    for (int in_vain = 0; in_vain < kVainFrames && !seams.can_weld(); ++in_vain, ++frames) {
        if (!is_finite(watch_.advance(world)))
            return false;
        seams.move(positions(world));
        if (seams.open_length() > kProgress * shortest)
            continue;
        shortest = seams.open_length();
        in_vain = 0;
    }
    return true;
}

/// Unfolds the seams. x [welded vertices]
bool GarmentDraping::press(const GarmentMesh& mesh, std::vector<Vec3>& x)
{
    const Clock clock;
    int frames = 0;
    if (!simulate(stages_.press(mesh, x), kPressingTime, frames, x))
        return false;
    end_stage("press", clock, frames, int(x.size()));
    return true;
}

/// Lets the welded coarse garment fall into place. x [welded vertices]
bool GarmentDraping::settle(const GarmentMesh& mesh, std::vector<Vec3>& x)
{
    const Clock clock;
    int frames = 0;
    const Scene scene = stages_.settle(mesh, x);
    if (!simulate(scene, kSettlingTime, frames, x))
        return false;
    gravity_time_ = frames * scene.frame_duration();
    end_stage("settle", clock, frames, int(x.size()));
    return true;
}

/// Simulates until the garment rests, for `duration` seconds at most.
bool GarmentDraping::simulate(const Scene& scene, double duration, int& frames, std::vector<Vec3>& x)
{
    World world(scene, watch_.options());
    RestWatch rest(scene.frame_duration());
    for (int frame = 0; frame < int(duration * scene.fps) && !rest.is_at_rest(); ++frame) {
        if (!is_finite(watch_.advance(world, duration)))
            return false;
        ++frames;
        rest.add(positions(world));
    }
    const View<const Vec3> now = positions(world);
    x.assign(now.begin(), now.end());
    return true;
}

/// Lets all garments come to rest, with all labels of this one held, then with those that stay.
void GarmentDraping::drape(WornGarment garment)
{
    const Clock clock;
    const std::set<std::string> labels = garment_.labels();
    const auto& attachments = garment_.pattern.attachments;
    const bool has_released =
        std::any_of(labels.begin(), labels.end(), [](auto& label) { return !stays_attached(label); }) ||
        std::any_of(attachments.begin(), attachments.end(), [](auto& held) { return held.is_released; });
    int frames = 0;
    for (const bool holds_all : {true, false}) {
        if (!holds_all && !has_released)
            break;
        garment.held = garment.x;
        const Scene scene = stages_.hang(garment.mesh, garment.x, holds_all, gravity_time_);
        if (!come_to_rest(scene, garment, holds_all && has_released, frames))
            break;
        result_.scene = scene;
        for (size_t g = 0; g < worn_.size(); ++g)
            take_lasting_settings(worn_[g].garment, result_.scene.cloths[g]);
        take_lasting_settings(garment_, result_.scene.cloths.back());
    }
    end_stage("drape", clock, frames, int(garment.x.size()));
    if (result_.outcome == DrapeOutcome::Draped)
        measure_slides(garment, number_);
    worn_.push_back(std::move(garment));
    measure_closures();
}

/// @param is_held  by labels that will be released
bool GarmentDraping::come_to_rest(const Scene& scene, WornGarment& garment, bool is_held, int& frames)
{
    World world(scene, watch_.options());
    RestWatch rest(scene.frame_duration());
    StepReport report;
    const double closing = last_closing(scene);
    for (int frame = 0;
         (!rest.is_at_rest() || frame < closing * scene.fps) && result_.outcome == DrapeOutcome::Draped &&
         frame < (closing + settings_.max_motion) * scene.fps;
         ++frame) {
        report = watch_.advance(world);
        if (!is_finite(report))
            return false;
        ++frames;
        gravity_time_ += scene.frame_duration();
        for (size_t g = 0; g < worn_.size(); ++g)
            worn_[g].x = world.cloths()[g].positions;
        garment.x = world.cloths()[number_].positions;
        rest.add(all_positions(world));
        result_.rest_speed = rest.speed();
        for (size_t g = 0; g < worn_.size(); ++g)
            measure_slides(worn_[g], g);
        if (!is_held)
            measure_slides(garment, number_);
    }
    result_.max_strain = report.max_strain;
    if (result_.outcome == DrapeOutcome::Draped && !rest.is_at_rest())
        fail(DrapeOutcome::NotAtRest, "its fastest vertex moves at " + std::to_string(rest.speed()) +
                                          " m/s after " + std::to_string(settings_.max_motion) + " s");
    return result_.outcome == DrapeOutcome::Draped;
}

/// Measures how far labelled edges have sunk. Fails if one has by more than it may.
/// @param number  of the garment
void GarmentDraping::measure_slides(const WornGarment& worn, size_t number)
{
    std::vector<DrapeSlide>& slides = result_.garments[number].slides;
    slides.clear();
    for (const std::string& label : worn.garment.labels()) {
        double sank = 0.0;
        const std::vector<int> edge = worn.mesh.labelled(worn.garment.pattern, label);
        for (const int v : edge)
            sank += (worn.held[size_t(v)].y() - worn.x[size_t(v)].y()) / double(edge.size());
        slides.push_back({label, sank});
        if (sank > kMaxSlide)
            fail(DrapeOutcome::SlidOff,
                 "the edge \"" + label + "\" sank by " + std::to_string(100.0 * sank) + " cm", number);
    }
}

/// Measures the gaps of the closures of all garments. Fails if one has stayed open.
void GarmentDraping::measure_closures()
{
    for (size_t g = 0; g < worn_.size(); ++g) {
        const garment::Pattern& pattern = worn_[g].garment.pattern;
        const std::vector<double> gaps = closure_gaps(pattern, worn_[g].mesh, worn_[g].x);
        result_.garments[g].closures.clear();
        for (size_t i = 0; i < gaps.size(); ++i) {
            result_.garments[g].closures.push_back({pattern.closures[i].name, gaps[i]});
            if (gaps[i] > kMaxOpen)
                fail(DrapeOutcome::Tangled,
                     "the closure " + pattern.closures[i].name + " stays open by " +
                         std::to_string(1e3 * gaps[i]) + " mm",
                     g);
        }
    }
}

/// @param text  what is wrong with the garment of this number
void GarmentDraping::fail(DrapeOutcome outcome, const std::string& text, size_t number)
{
    if (result_.outcome != DrapeOutcome::Draped)
        return;
    result_.outcome = outcome;
    result_.message = settings_.garments.size() == 1 ? text : result_.garments[number].name + ": " + text;
}

void GarmentDraping::end_stage(const std::string& name, const Clock& clock, int frames, int vertices)
{
    result_.garments[number_].stages.push_back(
        {name, clock.seconds(), frames, vertices, watch_.take_steps()});
}

View<const Vec3> GarmentDraping::positions(const World& world) const
{
    return world.cloths()[number_].positions;
}

} // namespace toile::scenes
