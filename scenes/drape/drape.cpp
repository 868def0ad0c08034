#include "scenes/drape/drape.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "avatars/landmarks/body_segments.h"
#include "avatars/load_avatar.h"
#include "core/base/error.h"
#include "garment/pattern/mesh/resampling.h"
#include "garment/pattern/place/placement_shift.h"
#include "scenes/drape/drape_watch.h"
#include "scenes/drape/garment_mesh.h"
#include "scenes/drape/rest_watch.h"
#include "scenes/garment_format/read_garment.h"
#include "scenes/world/world.h"

namespace toile::scenes {

namespace {

constexpr double kSewingEdge = 0.02; ///< [m]
/// Time [s] for seams to close, to be pressed, and to fall into place on the coarse mesh.
constexpr double kSewingTime = 3.0, kPressingTime = 0.5, kSettlingTime = 1.0;
/// Bending rigidity [N m] of cloth that is pressed: a hundred times that of cotton.
constexpr double kPressedRigidity = 1e-3;
/// Samples without progress of the widest seam after which sewing ends.
constexpr int kVainFrames = 30;
/// Friction of panels that are pulled around the body.
constexpr double kSewingFriction = 0.05;

/// Labels of edges that stay attached: nothing else holds them up.
bool stays_attached(const std::string& label)
{
    return label == "lower_interface" || label == "strapless_top";
}

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
          pattern_(garment_format::read_pattern(settings.garment)), labels_(labels_of(pattern_))
    {
        for (garment::Panel& panel : pattern_.panels)
            panel.placement.pretranslate(settings.shift);
        for (const std::string& text : not_used(pattern_))
            if (options_.warn)
                options_.warn(settings.garment.string() + ": " + text);
        choose_fabric();
        find_segments();
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

        std::vector<Vec3> x = placed(coarse);
        if (!sew(coarse, x))
            return std::move(result_);
        std::vector<Vec3> welded = coarse.weld(x);
        if (!press(coarse, welded) || !settle(coarse, welded))
            return std::move(result_);
        drape(fine, fine.weld(finer.apply(coarse.panels, coarse.unweld(welded))));
        return std::move(result_);
    }

private:
    static std::set<std::string> labels_of(const garment::Pattern& pattern)
    {
        std::set<std::string> labels;
        for (const garment::Panel& panel : pattern.panels)
            for (const garment::PanelEdge& edge : panel.edges)
                if (!edge.label.empty())
                    labels.insert(edge.label);
        return labels;
    }

    /// What the pattern asks for and a drape does not do.
    static std::vector<std::string> not_used(const garment::Pattern& pattern)
    {
        std::vector<std::string> texts;
        for (const garment::Seam& seam : pattern.seams)
            if (seam.fold_deg != 0.0 || seam.order != 0)
                texts.push_back(seam.name +
                                ": fold_deg and order are not used: seams are sewn at once, flat");
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

    /// Segments of the body, if panels are placed by them or it has some.
    void find_segments()
    {
        avatars::AvatarSettings body;
        if (const auto* file = std::get_if<std::filesystem::path>(&settings_.body.shape))
            body.file = *file;
        else if (!std::holds_alternative<scene::Mannequin>(settings_.body.shape))
            return;
        const bool needed = std::any_of(pattern_.panels.begin(), pattern_.panels.end(),
                                        [](const garment::Panel& panel) { return panel.place.has_value(); });
        const std::unique_ptr<avatars::Avatar> avatar = avatars::load_avatar(body);
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

    std::vector<Vec3> placed(const GarmentMesh& mesh) const
    {
        std::vector<int> panel_of_vertex;
        panel_of_vertex.reserve(size_t(mesh.panels.vertex_count()));
        for (int v = 0; v < mesh.panels.vertex_count(); ++v)
            panel_of_vertex.push_back(mesh.panels.panel_of_vertex(v));
        return garment::place_panels(pattern_, mesh.panels.uv, panel_of_vertex,
                                     segments_ ? &*segments_ : nullptr);
    }

    /// A scene of the garment on the body; its mesh is written.
    Scene scene_of(const std::string& stage, const ObjMesh& mesh) const
    {
        Scene scene;
        scene.name = settings_.name + ", " + stage;
        scene.source = settings_.folder / (stage + ".json");
        scene.avatars = {settings_.body};
        scene::Cloth cloth;
        cloth.name = settings_.name;
        const std::filesystem::path file = settings_.folder / (settings_.name + "_" + stage + ".obj");
        write_obj(file, mesh);
        watch_.begin(stage, mesh, scene.frame_duration());
        cloth.shape = file;
        cloth.weld = false;
        cloth.rest = scene::RestFrom::Uv;
        cloth.uv_scale = 1.0;
        cloth.fabric = fabric_;
        scene.cloths = {cloth};
        scene.solver.quality = scene::Quality::Preview;
        scene.solver.sleep.enabled = false; // asleep, it would have neither speed nor strain
        return scene;
    }

    /// Springs from labelled edges to the body. A vertex of two edges follows the one that stays attached.
    void hold_labels(const GarmentMesh& mesh, Scene& scene, bool also_released) const
    {
        std::set<int> held;
        for (const bool stays : {true, false})
            for (const std::string& label : labels_) {
                if (stays_attached(label) != stays || (!stays && !also_released))
                    continue;
                std::vector<int> vertices = mesh.labelled(pattern_, label);
                std::erase_if(vertices, [&](int v) { return !held.insert(v).second; });
                if (vertices.empty())
                    continue;
                scene::Attachment attachment;
                attachment.cloth = settings_.name;
                attachment.select.by = std::move(vertices);
                attachment.to = settings_.body.name;
                scene.attachments.push_back(attachment);
            }
    }

    bool is_finite(const StepReport& report)
    {
        if (report.status != StepReport::Status::NonFinite)
            return true;
        result_.outcome = DrapeOutcome::Solver;
        result_.message = report.message;
        return false;
    }

    /// Pulls the seams shut. x [vertices of the panels] in: placed; out: sewn.
    bool sew(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        if (pattern_.seams.empty())
            return true;
        const Clock clock;
        Scene scene = scene_of("sew", mesh.unsewn(x));
        scene.gravity.setZero();
        scene.contact.friction = kSewingFriction;
        scene.cloths[0].sewing = scene::Sewing{};
        scene.frames = int(kSewingTime * scene.fps);
        World world(scene, options_);
        double narrowest = std::numeric_limits<double>::infinity();
        int frame = 0, frame_of_narrowest = 0;
        std::vector<double> gaps;
        for (; frame < scene.frames; ++frame) {
            if (!is_finite(watch_.advance(world)))
                return false;
            gaps = mesh.seam_gaps(world.cloths()[0].positions);
            const double widest = *std::max_element(gaps.begin(), gaps.end());
            if (widest < 0.99 * narrowest) {
                narrowest = widest;
                frame_of_narrowest = frame;
            }
            if (widest < kMaxWeldGap || frame - frame_of_narrowest >= kVainFrames)
                break;
        }
        x.assign(world.cloths()[0].positions.begin(), world.cloths()[0].positions.end());
        result_.stages.push_back({"sew", clock.seconds(), frame + 1, int(x.size()), watch_.take_steps()});
        for (size_t s = 0; s < gaps.size(); ++s)
            result_.seams.push_back({pattern_.seams[s].name, gaps[s]});
        const auto widest = std::max_element(gaps.begin(), gaps.end());
        if (*widest < kMaxWeldGap)
            return true;
        const int seam = int(widest - gaps.begin());
        result_.outcome = DrapeOutcome::Tangled;
        result_.message =
            pattern_.seams[size_t(seam)].name + " stays open by " + std::to_string(1000.0 * *widest) + " mm";
        result_.mesh = mesh.unsewn(x);
        return false;
    }

    /// Unfolds the seams, along which panels lie on each other when they meet, as an iron does: cloth of
    /// great bending rigidity, without gravity. x [welded vertices]
    bool press(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        const Clock clock;
        Scene scene = scene_of("press", mesh.welded(x));
        scene.gravity.setZero();
        scene.contact.friction = kSewingFriction;
        scene::Fabric& pressed = scene.fabrics["pressed"];
        pressed.base = fabric_;
        pressed.bend = {kPressedRigidity, kPressedRigidity};
        scene.cloths[0].fabric = "pressed";
        return simulate(scene, "press", kPressingTime, clock, x);
    }

    /// Lets the welded coarse garment fall into place. x [welded vertices]
    bool settle(const GarmentMesh& mesh, std::vector<Vec3>& x)
    {
        const Clock clock;
        Scene scene = scene_of("settle", mesh.welded(x));
        hold_labels(mesh, scene, true);
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
        const bool has_released =
            std::any_of(labels_.begin(), labels_.end(), [](auto& label) { return !stays_attached(label); });
        std::vector<Vec3> held;
        for (const bool all : {true, false}) {
            if (!all && !has_released)
                break;
            held = x;
            Scene scene = scene_of(all ? "drape" : "release", mesh.welded(x));
            hold_labels(mesh, scene, all);
            const bool is_at_rest = come_to_rest(scene, x, frames, [&](View<const Vec3> now) {
                return !all && has_slid_off(mesh, held, now);
            });
            if (!is_at_rest)
                break;
            result_.scene = scene;
        }
        result_.stages.push_back({"drape", clock.seconds(), frames, int(x.size()), watch_.take_steps()});
        result_.mesh = mesh.welded(x);
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
        for (const std::string& label : labels_) {
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
    std::set<std::string> labels_;
    std::string fabric_;
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
