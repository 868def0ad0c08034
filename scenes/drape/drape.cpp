#include "scenes/drape/drape.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

#include "avatars/landmarks/body_segments.h"
#include "avatars/load_avatar.h"
#include "core/base/error.h"
#include "garment/pattern/mesh/resampling.h"
#include "garment/pattern/place/placement_shift.h"
#include "scenes/drape/drape_watch.h"
#include "scenes/drape/rest_watch.h"
#include "scenes/drape/seam_closing.h"
#include "scenes/drape/seam_lift.h"
#include "scenes/drape/stage_scenes.h"
#include "scenes/garment_format/read_garment.h"
#include "scenes/world/world.h"

namespace toile::scenes {

namespace {

constexpr double kSewingEdge = 0.02; ///< [m]
/// Time [s] for a garment to be pressed, and to fall into place on the coarse mesh.
constexpr double kPressingTime = 0.5, kSettlingTime = 1.0;
/// Longest time [s] for panels to fold.
constexpr double kFoldingTime = 4.0;
/// Frames in which threads become no shorter than by this ratio, after which pulling on ends.
constexpr int kVainFrames = 5;
constexpr double kProgress = 0.98;

class Clock {
public:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A drape in progress.
class Draping {
public:
    Draping(const DrapeSettings& settings, DrapeWatch& watch)
        : settings_(settings), watch_(watch), options_(watch.options()),
          pattern_(garment_format::read_pattern(settings.garment)),
          stages_(settings_, pattern_, fabric_, watch_)
    {
        for (garment::Panel& panel : pattern_.panels)
            panel.placement.pretranslate(settings.shift);
        for (const std::string& text : not_used(pattern_))
            if (options_.warn)
                options_.warn(settings.garment.string() + ": " + text);
        choose_fabric();
        load_body();
    }

    DrapeResult& unfinished() { return result_; }

    DrapeResult run()
    {
        const Clock clock;
        if (!lies_around_body())
            return std::move(result_);
        const GarmentMesh coarse(pattern_, std::max(kSewingEdge, settings_.edge), kSewingEdge);
        const GarmentMesh fine(pattern_, settings_.edge);
        const garment::Resampling finer = garment::resample(coarse.panels, fine.panels);
        result_.pieces = fine.sewn.topology.pieces;
        result_.border_loops = fine.sewn.topology.border_loops;
        result_.euler_characteristic = fine.sewn.topology.euler_characteristic;
        result_.stages.push_back({"mesh", clock.seconds(), 0, fine.panels.vertex_count()});

        try {
            put_on(coarse, fine, finer);
        } catch (const InvalidInput& error) {
            // The start of a stage can't be repaired: the garment lies in the body, or is too small for it.
            const bool is_sewn = result_.stages.size() > 1;
            result_.outcome = is_sewn ? DrapeOutcome::Tangled : DrapeOutcome::Placement;
            result_.message = (is_sewn ? "sewn, the garment does not fit around the body: "
                                       : "the panels can't be sewn from where they are placed: ") +
                              std::string(error.what());
        }
        return std::move(result_);
    }

private:
    void put_on(const GarmentMesh& coarse, const GarmentMesh& fine, const garment::Resampling& finer)
    {
        std::vector<Vec3> x = placed(coarse);
        if (!fold(coarse, x) || !sew(coarse, x))
            return;
        std::vector<Vec3> welded = weld(coarse.sewn, x);
        if (press(coarse, welded) && settle(coarse, welded))
            drape(fine, weld(fine.sewn, finer.apply(coarse.panels, unweld(coarse.sewn, welded))));
    }

    /// What the pattern asks for and a drape does not do.
    static std::vector<std::string> not_used(const garment::Pattern& pattern)
    {
        std::vector<std::string> texts;
        for (const garment::Seam& seam : pattern.seams)
            if (seam.order != 0)
                texts.push_back(seam.name + ": order is not used: seams are sewn at once");
        for (const garment::Panel& panel : pattern.panels)
            if (panel.layer != 0 || panel.grain_deg != 0.0)
                texts.push_back("panel \"" + panel.name + "\": layer and grain_deg are not used");
        return texts;
    }

    void choose_fabric()
    {
        for (const garment::Panel& panel : pattern_.panels) {
            const std::string& fabric = panel.fabric.empty() ? settings_.fabric : panel.fabric;
            if (fabric_.empty())
                fabric_ = fabric;
            if (fabric != fabric_)
                throw InvalidInput(settings_.garment.string() + ": panel \"" + panel.name + "\" is of " +
                                   fabric + " and others of " + fabric_ +
                                   "; a garment can be draped in one fabric, give all panels the same");
        }
    }

    /// The skin of a body that has one, and its segments if panels are placed by them or it has some.
    void load_body()
    {
        avatars::AvatarSettings body;
        if (const auto* file = std::get_if<std::filesystem::path>(&settings_.body.shape))
            body.file = *file;
        else if (!std::holds_alternative<scene::Mannequin>(settings_.body.shape))
            return;
        const bool needed = std::any_of(pattern_.panels.begin(), pattern_.panels.end(),
                                        [](const garment::Panel& panel) { return panel.place.has_value(); });
        const std::unique_ptr<avatars::Avatar> avatar = avatars::load_avatar(body);
        skin_.triangles = avatar->triangles();
        skin_.positions.resize(size_t(avatar->vertex_count()));
        avatar->pose({}, avatars::identity_affine(), skin_.positions);
        try {
            segments_ = avatars::find_segments(*avatar, {}, avatars::identity_affine()).segments;
        } catch (const InvalidInput&) {
            if (needed)
                throw;
        }
    }

    bool lies_around_body()
    {
        if (!segments_)
            return true;
        const garment::PlacementShift placement = garment::placement_shift(pattern_, *segments_);
        if (placement.fits())
            return true;
        result_.outcome = DrapeOutcome::Placement;
        result_.message = garment::misplacement_text(pattern_, placement);
        return false;
    }

    std::vector<Vec3> placed(const GarmentMesh& mesh)
    {
        std::vector<int> panel_of_vertex;
        panel_of_vertex.reserve(size_t(mesh.panels.vertex_count()));
        for (int v = 0; v < mesh.panels.vertex_count(); ++v)
            panel_of_vertex.push_back(mesh.panels.panel_of_vertex(v));
        std::vector<Vec3> x = garment::place_panels(pattern_, mesh.panels.uv, panel_of_vertex,
                                                    segments_ ? &*segments_ : nullptr);
        result_.lift = shoulder_lift(mesh.panels.stitches, x, skin_);
        for (Vec3& p : x)
            p.y() += result_.lift;
        return x;
    }

    bool is_finite(const StepReport& report)
    {
        if (report.status != StepReport::Status::NonFinite)
            return true;
        result_.outcome = DrapeOutcome::Solver;
        result_.message = report.message;
        return false;
    }

    /// Folds the panels where the pattern has folds. x [vertices of the panels]
    bool fold(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        if (pattern_.folds.empty())
            return true;
        const Clock clock;
        const Scene scene = stages_.fold(SeamClosing(mesh, x).panels());
        World world(scene, options_);
        RestWatch rest(scene.frame_duration());
        int frames = 0;
        for (; frames < kFoldingTime * scene.fps && !rest.is_at_rest(); ++frames) {
            if (!is_finite(watch_.advance(world)))
                return false;
            rest.add(world.cloths()[0].positions);
        }
        x.assign(world.cloths()[0].positions.begin(), world.cloths()[0].positions.end());
        result_.stages.push_back({"fold", clock.seconds(), frames, int(x.size()), watch_.take_steps()});
        return true;
    }

    /// Pulls the seams shut. x [vertices of the panels] in: placed; out: sewn.
    bool sew(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        const Clock clock;
        SeamClosing seams(mesh, std::move(x));
        int frames = 0;
        bool goes_on = true;
        while (goes_on && !seams.are_closed()) {
            if (!pull(seams, frames))
                return false;
            goes_on = seams.weld() > 0;
        }
        x = seams.positions();
        result_.stages.push_back({"sew", clock.seconds(), frames, int(x.size()), watch_.take_steps()});
        const std::vector<double> gaps = seams.gaps();
        for (size_t s = 0; s < gaps.size(); ++s)
            result_.seams.push_back({pattern_.seams[s].name, gaps[s]});
        if (seams.are_closed())
            return true;
        const auto widest = std::max_element(gaps.begin(), gaps.end());
        result_.outcome = DrapeOutcome::Tangled;
        result_.message = pattern_.seams[size_t(widest - gaps.begin())].name + " stays open by " +
                          std::to_string(1000.0 * *widest) + " mm";
        result_.surface = seams.surface();
        return false;
    }

    /// Pulls on the open threads until all can be welded or none gets shorter.
    bool pull(SeamClosing& seams, int& frames)
    {
        const Scene scene = stages_.sew(seams.surface());
        World world(scene, options_);
        double shortest = std::numeric_limits<double>::infinity();
        for (int in_vain = 0; in_vain < kVainFrames && !seams.can_weld(); ++in_vain, ++frames) {
            if (!is_finite(watch_.advance(world)))
                return false;
            seams.move(world.cloths()[0].positions);
            if (seams.open_length() > kProgress * shortest)
                continue;
            shortest = seams.open_length();
            in_vain = 0;
        }
        return true;
    }

    /// Unfolds the seams. x [welded vertices]
    bool press(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        const Clock clock;
        Scene scene = stages_.press(mesh, x);
        return simulate(scene, "press", kPressingTime, clock, x);
    }

    /// Lets the welded coarse garment fall into place. x [welded vertices]
    bool settle(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        const Clock clock;
        Scene scene = stages_.settle(mesh, x);
        return simulate(scene, "settle", kSettlingTime, clock, x);
    }

    bool simulate(Scene& scene, const std::string& stage, double duration, const Clock& clock,
                  std::vector<Vec3>& x)
    {
        scene.frames = int(duration * scene.fps);
        World world(scene, options_);
        for (int frame = 0; frame < scene.frames; ++frame)
            if (!is_finite(watch_.advance(world, duration)))
                return false;
        x.assign(world.cloths()[0].positions.begin(), world.cloths()[0].positions.end());
        result_.stages.push_back({stage, clock.seconds(), scene.frames, int(x.size()), watch_.take_steps()});
        return true;
    }

    void drape(const GarmentMesh& mesh, std::vector<Vec3> x)
    {
        const Clock clock;
        int frames = 0;
        // With all labels held, then with those that stay.
        const bool has_released = std::any_of(stages_.labels().begin(), stages_.labels().end(),
                                              [](auto& label) { return !stays_attached(label); });
        std::vector<Vec3> held;
        for (const bool all : {true, false}) {
            if (!all && !has_released)
                break;
            held = x;
            const Scene scene = stages_.hang(mesh, x, all ? "drape" : "release", all);
            const bool is_at_rest = come_to_rest(scene, x, frames, [&](View<const Vec3> now) {
                return !all && has_slid_off(mesh, held, now);
            });
            if (!is_at_rest)
                break;
            result_.scene = scene;
            result_.scene.cloths[0].fabric = fabric_;
        }
        result_.stages.push_back({"drape", clock.seconds(), frames, int(x.size()), watch_.take_steps()});
        result_.surface = mesh.surface(x);
        has_slid_off(mesh, held, x);
    }

    /// @param has_failed  asked after every frame, and sets the outcome
    bool come_to_rest(const Scene& scene, std::vector<Vec3>& x, int& frames,
                      const std::function<bool(View<const Vec3>)>& has_failed)
    {
        World world(scene, options_);
        RestWatch watch(scene.frame_duration());
        StepReport report;
        bool at_rest = false;
        while (!at_rest && frames < settings_.max_motion * scene.fps) {
            report = watch_.advance(world);
            if (!is_finite(report))
                return false;
            ++frames;
            watch.add(world.cloths()[0].positions);
            at_rest = watch.is_at_rest();
            if (has_failed(world.cloths()[0].positions))
                break;
        }
        x.assign(world.cloths()[0].positions.begin(), world.cloths()[0].positions.end());
        result_.rest_speed = watch.speed();
        result_.max_strain = report.max_strain;
        if (at_rest || result_.outcome != DrapeOutcome::Draped)
            return at_rest;
        result_.outcome = DrapeOutcome::NotAtRest;
        result_.message = "its fastest vertex moves at " + std::to_string(watch.speed()) + " m/s after " +
                          std::to_string(settings_.max_motion) + " s";
        return false;
    }

    /// Measures how far labelled edges have sunk. True if one has by more than it may.
    bool has_slid_off(const GarmentMesh& mesh, const std::vector<Vec3>& before, View<const Vec3> after)
    {
        result_.slides.clear();
        for (const std::string& label : stages_.labels()) {
            double sank = 0.0;
            const std::vector<int> edge = mesh.labelled(pattern_, label);
            for (const int v : edge)
                sank += (before[v].y() - after[v].y()) / double(edge.size());
            result_.slides.push_back({label, sank});
            if (sank <= kMaxSlide)
                continue;
            result_.outcome = DrapeOutcome::SlidOff;
            result_.message = "the edge \"" + label + "\" sank by " + std::to_string(100.0 * sank) + " cm";
        }
        return result_.outcome == DrapeOutcome::SlidOff;
    }

    const DrapeSettings& settings_;
    DrapeWatch& watch_;
    const WorldOptions& options_;
    garment::Pattern pattern_;
    std::string fabric_; ///< preset
    StageScenes stages_;
    TriangleMesh skin_; ///< of the body, in the pose to be dressed; empty: a shape
    std::optional<garment::ArrangementSegments> segments_;
    DrapeResult result_;
};

} // namespace

DrapeResult drape(const DrapeSettings& settings, const WorldOptions& options)
{
    DrapeWatch watch(settings, options);
    Draping draping(settings, watch);
    return watch.run([&] { return draping.run(); }, draping.unfinished());
}

} // namespace toile::scenes
