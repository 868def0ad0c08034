#include "scenes/world/world.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/base/long_work.h"
#include "core/compute/cuda/runtime/device.h"
#include "core/compute/parallel.h"
#include "scenes/colliders/time_warnings.h"
#include "scenes/format/validate.h"
#include "scenes/method/solver_choice.h"
#include "scenes/world/cloth_group.h"
#include "scenes/world/likely_unit.h"
#include "scenes/world/scene_costs.h"
#include "scenes/world/start_pose.h"

namespace toile::scenes {

namespace {

long total_vertices(const std::vector<SceneCloth>& cloths)
{
    long count = 0;
    for (const SceneCloth& cloth : cloths)
        count += cloth.vertex_count();
    return count;
}

/// Warns of a body whose file has triangles inside out.
void warn_of_turned(const Collider& collider, const std::function<void(const std::string&)>& warn)
{
    if (!collider.body().skinned())
        return;
    const avatars::Avatar& avatar = collider.body().skinned()->avatar();
    if (avatar.turned_count() > 0)
        warn("avatar \"" + collider.name() + "\": " + avatar.source() + ": turned " +
             std::to_string(avatar.turned_count()) + " of " + std::to_string(avatar.triangles().size()) +
             " triangles, which faced into the body or against their neighbours");
}

} // namespace

struct World::Parts {
    std::atomic<bool> is_in_call = false;
    std::string failure; ///< why nothing can change it any more; empty: it can

    Parts(const Scene& of, const WorldOptions& options)
        : progress(options.progress), goes_on(options.goes_on), scene(of), control(step_control_of(of))
    {
    }

    std::function<void(const std::string& task, double fraction)> progress; ///< see WorldOptions
    std::function<bool()> goes_on;                                          ///< see WorldOptions

    Scene scene;
    StepControl control;
    std::shared_ptr<const CudaSpace> space; ///< null: the CPU
    std::vector<Collider> colliders;
    std::vector<ClothGroup> groups;
    std::vector<ClothState> states;
    collision::StartReport start;
    Stages stages;
    bool is_shown = true; ///< states are up to date
    int frame = 0;

    /// Ticks before sample 0 in which the scene settles: whole numbers of the longest step.
    int settle_ticks() const
    {
        const int longest = control.longest();
        return longest * int(std::ceil(scene.settle / (longest * control.tick()) - 1e-9));
    }

    /// Time within several steps.
    struct Moment {
        int step;        ///< from 1
        int iteration;   ///< from 1; 0: the step has ended
        double fraction; ///< of all steps that have ended [0, 1]
    };

    /// Takes steps of `ticks` altogether, the last of them ending at `end` [s]. Avatars do not move before
    /// time 0.
    /// @param tell  told the time of each step and iteration
    StepReport advance(int ticks, double end, const std::function<void(const Moment&)>& tell)
    {
        const ThreadLimit threads(scene.solver.threads);
        const Stages::Activate recording(stages);
        const Cancellation::Scope cancellation(goes_on);
        StepReport total;
        int done = 0;
        const LongWork::Scope work([&](const LongWork::Progress& of_step) {
            tell({total.steps + 1, of_step.iteration, double(done) / ticks});
        });
        while (done < ticks) {
            const auto time_after = [&](int more) { return end - (ticks - done - more) * control.tick(); };
            const int length = control.choose(done, [&](int more) {
                double largest = 0.0;
                for (Collider& collider : colliders)
                    largest = std::max(largest, collider.motion_to(std::max(time_after(more), 0.0)));
                return largest;
            });
            StepReport report = step(length * control.tick(), time_after(length), control.max_error());
            control.observe(report);
            if (report.refused > 0) {
                report.step_error = 0.0; // of no step
                total.merge(report);
                continue;
            }
            done += length;
            tell({total.steps + 1, 0, double(done) / ticks});
            total.energy = 0.0;
            total.contacts = 0;
            total.merge(report);
            if (total.status == StepReport::Status::NonFinite)
                break;
        }
        is_shown = false;
        if (!space)
            show();
        return total;
    }

    void tell(const std::string& task, double fraction) const
    {
        if (progress)
            progress(task, fraction);
    }

    void tell_within_frame(const Moment& moment) const
    {
        if (!progress)
            return;
        const std::string task =
            moment.iteration == 0
                ? "steps of a frame"
                : "step " + std::to_string(moment.step) + ", iteration " + std::to_string(moment.iteration);
        tell(task, moment.fraction);
    }

    /// Makes avatars, cloths and what moves them.
    void load(const WorldOptions& options)
    {
        constexpr double kAvatars = 0.5, kCloths = 0.9; // parts of the work
        const LongWork::Scope work(
            [this](const LongWork::Progress& loading) { tell("loading", loading.fraction); });
        load_avatars(options, kAvatars);
        space = open_backend(options.backend, options.device, scene, options.warn);
        std::vector<SceneCloth> cloths;
        {
            const LongWork::Part part(kAvatars, kCloths);
            cloths = make_cloths(scene, colliders, options);
        }
        if (options.warn) {
            for (const std::string& warning : unit_warnings(scene, cloths, colliders))
                options.warn(warning);
            for (const std::string& warning : time_warnings(scene, colliders))
                options.warn(warning);
        }
        SceneBodies bodies = make_bodies(scene, colliders, int(total_vertices(cloths)));
        choose_space(cloths, bodies, options);
        const LongWork::Part part(kCloths, 1.0);
        groups = make_groups(scene, std::move(cloths), std::move(bodies), colliders, options, space.get());
        for (ClothGroup& group : groups)
            group.find_stiff_parts(control.shortest());
        LongWork::update(1.0);
    }

    /// Ends what does not fit, and states what tables and memory will cost.
    void choose_space(const std::vector<SceneCloth>& cloths, const SceneBodies& bodies,
                      const WorldOptions& options)
    {
        const SceneCosts costs = expected_costs(scene, cloths, bodies, space != nullptr);
        const bool had_space = space != nullptr;
        space = space_with_capacity(space, options.backend, costs, options.warn);
        if (!options.note)
            return;
        if (space)
            options.note(table_text(costs) + "; " +
                         memory_text(costs, {space->described(), space->free_memory()}));
        else if (scene.solver.method == scene::SolverMethod::Quadrature)
            options.note(table_text(had_space ? expected_costs(scene, cloths, bodies, false) : costs));
    }

    void load_avatars(const WorldOptions& options, double end)
    {
        const LongWork::Part all(0.0, end);
        for (const scene::Avatar& avatar : scene.avatars) {
            const LongWork::Part part = LongWork::item(colliders.size(), scene.avatars.size());
            LongWork::update(0.0);
            colliders.emplace_back(avatar, scene.contact.friction);
            if (options.warn)
                warn_of_turned(colliders.back(), options.warn);
        }
    }

    /// True if the rest shape of a cloth is not its mesh, and the scene lets its start be changed.
    bool may_start_strained() const
    {
        return scene.contact.repair_start &&
               std::any_of(states.begin(), states.end(),
                           [](const ClothState& state) { return !state.panels.empty(); });
    }

    /// True if relax_start() may move something.
    bool must_relax() const
    {
        return start.was_repaired || may_start_strained() ||
               std::any_of(groups.begin(), groups.end(),
                           [](const ClothGroup& group) { return group.is_unsettled(); });
    }

    /// Relaxes cloth that the start pose or its repair strain beyond its limit, as long as the strain falls,
    /// soft bodies that the repair has deformed, and what starts so near to a body that contact would throw
    /// it off.
    StepReport relax_start()
    {
        constexpr int kMinSteps = 60, kPatience = 5;
        constexpr double kProgress = 0.99, kMaxTime = 0.5; // [-], [s]
        const double dt = control.first() * control.tick(), t_start = -settle_ticks() * control.tick();
        const int max_steps = std::max(kMinSteps, int(kMaxTime / dt));
        const Cancellation::Scope cancellation(goes_on);
        const bool may_strain = start.was_repaired || may_start_strained();
        StepReport total;
        for (ClothGroup& group : groups) {
            double min_strain = std::numeric_limits<double>::max();
            int stalled = 0;
            for (int k = 0; k < max_steps && (group.is_unsettled() ||
                                              (may_strain && stalled < kPatience && group.is_strained()));
                 ++k) {
                const StageScope stage("scenes/relax_start");
                const StepReport report = group.relax(dt, t_start, colliders);
                total.merge(report);
                if (report.status == StepReport::Status::NonFinite)
                    return total;
                stalled = report.max_strain < kProgress * min_strain ? 0 : stalled + 1;
                min_strain = std::min(min_strain, report.max_strain);
                is_shown = false;
                tell("relaxation of the start", (k + 1.0) / max_steps);
            }
        }
        tell("relaxation of the start", 1.0);
        show();
        return total;
    }

    /// Takes a step of dt [s] that ends at t [s]. With soft bodies its error may be at most max_error [m],
    /// except where avatars move or there are several groups: these do not go back. Cloth does not bounce:
    /// what a long step takes from it, impacts and seams that snap shut should take anyway.
    StepReport step(double dt, double t, double max_error)
    {
        const StageScope stage("scenes/step");
        Cancellation::check();
        bool can_go_back = groups.size() == 1 && groups.front().soft_bodies() != nullptr;
        for (Collider& collider : colliders) {
            collider.advance_to(std::max(t, 0.0));
            can_go_back = can_go_back && !collider.moved();
        }
        StepReport report;
        for (ClothGroup& group : groups)
            report.merge(group.step(dt, t, colliders, can_go_back ? max_error : kAnyStepError));
        report.steps = report.refused > 0 ? 0 : 1;
        return report;
    }

    /// Updates states from the groups. Positions on a GPU are copied only on request.
    void show()
    {
        if (is_shown)
            return;
        int cloth = 0;
        for (const ClothGroup& group : groups)
            for (int i = 0; i < int(group.cloths().size()); ++i) {
                const View<const Vec3> x = group.positions_of(i);
                states[cloth++].positions.assign(x.begin(), x.end());
            }
        for (const ClothGroup& group : groups)
            if (const SceneSolids* solids = group.solids())
                for (int i = 0; i < solids->count(); ++i)
                    states[cloth++].positions = solids->positions(i);
        for (const ClothGroup& group : groups)
            for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i) {
                const View<const Vec3> x = group.surface_of_soft_body(i);
                states[cloth++].positions.assign(x.begin(), x.end());
            }
        for (const ClothGroup& group : groups)
            for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i)
                if (group.soft_bodies()->render_state(i))
                    states[cloth++].positions = group.render_positions_of(i);
        is_shown = true;
    }
};

/// A call that changes a World, from its begin to its end.
class World::Call {
public:
    /// @param name  of the function, for errors
    /// @throws InvalidUse if another call runs, or the World has failed
    Call(World& world, const std::string& name) : parts_(world.parts())
    {
        if (parts_.is_in_call.exchange(true))
            throw InvalidUse(name + ": another call of this World is running; wait for it");
        if (parts_.failure.empty())
            return;
        parts_.is_in_call = false;
        throw InvalidUse(name + ": this World has failed (" + parts_.failure + "); make a new one");
    }
    ~Call() { parts_.is_in_call = false; }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    /// Result of `simulate`, which leaves a World that can go on only where it succeeds.
    template <typename Simulate>
    StepReport take(const Simulate& simulate)
    {
        StepReport report;
        try {
            report = simulate();
        } catch (const std::exception& error) {
            parts_.failure = error.what();
            throw;
        }
        const bool has_failed = report.status == StepReport::Status::NonFinite;
        parts_.failure = has_failed ? report.message : std::string();
        return report;
    }

private:
    Parts& parts_;
};

World::Parts& World::parts() const
{
    if (!parts_)
        throw InvalidUse("this World was moved from; use the one that it was moved to");
    return *parts_;
}

World::World(const Scene& scene, const WorldOptions& options)
{
    require_valid(scene);
    parts_ = std::make_unique<Parts>(scene, options);
    require_methods(scene, options.baselines);
    if (options.warn)
        for (const auto& warnings : {former_key_warnings_of(scene), solver_warnings_of(scene)})
            for (const std::string& warning : warnings)
                options.warn(warning);
    const ThreadLimit threads(scene.solver.threads);
    const Stages::Activate recording(parts_->stages);
    const Cancellation::Scope cancellation(parts_->goes_on);
    parts_->load(options);
    parts_->start = repair_start_pose(scene, parts_->groups, parts_->colliders, [&](double fraction) {
        parts_->tell("repair of the start pose", fraction);
    });
    for (ClothGroup& group : parts_->groups)
        group.tie(scene.contact.gap, parts_->colliders, options.warn);
    for (const ClothGroup& group : parts_->groups)
        for (const SceneCloth& cloth : group.cloths())
            parts_->states.push_back(cloth.state());
    for (const ClothGroup& group : parts_->groups)
        if (const SceneSolids* solids = group.solids())
            for (int i = 0; i < solids->count(); ++i)
                parts_->states.push_back(solids->state(i));
    for (const ClothGroup& group : parts_->groups)
        for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i)
            parts_->states.push_back(group.soft_bodies()->state(i));
    for (const ClothGroup& group : parts_->groups)
        for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i)
            if (const ClothState* render = group.soft_bodies()->render_state(i))
                parts_->states.push_back(*render);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::place(int cloth, View<const Vec3> positions)
{
    const Call call(*this, "World::place");
    const std::string name = "World::place(" + std::to_string(cloth) + ")";
    const std::vector<scene::Cloth>& cloths = parts().scene.cloths;
    if (cloth < 0 || cloth >= int(cloths.size()))
        throw InvalidUse(name + ": the scene has " + std::to_string(cloths.size()) + " cloths");
    if (const size_t expected = parts().states[cloth].positions.size(); positions.size() != int(expected))
        throw InvalidUse(name + ": has " + std::to_string(positions.size()) + " positions, but \"" +
                         cloths[cloth].name + "\" has " + std::to_string(expected) + " vertices");
    require_in_range(positions, name);

    int member = cloth;
    for (ClothGroup& group : parts().groups) {
        if (member < int(group.cloths().size())) {
            group.place(member, positions);
            break;
        }
        member -= int(group.cloths().size());
    }
    parts().is_shown = false;
    parts().show();
}

void World::prepare()
{
    const Call call(*this, "World::prepare");
    const ThreadLimit threads(parts().scene.solver.threads);
    const Stages::Activate recording(parts().stages);
    const StepControl& control = parts().control;
    const double dt = control.first() * control.tick();
    const double first_end = dt - parts().settle_ticks() * control.tick();
    const Cancellation::Scope cancellation(parts().goes_on);
    const LongWork::Scope work([this](const LongWork::Progress& progress) {
        parts().tell("preparation of the solvers", progress.fraction);
    });
    LongWork::update(0.0);
    for (size_t i = 0; i < parts().groups.size(); ++i) {
        const LongWork::Part part = LongWork::item(i, parts().groups.size());
        parts().groups[i].prepare(dt, first_end);
        LongWork::update(1.0);
    }
}

StepReport World::settle()
{
    Call call(*this, "World::settle");
    if (parts().frame > 0)
        throw InvalidUse("World::settle: sample 0 is past");
    return call.take([&] {
        if (parts().must_relax()) {
            const ThreadLimit threads(parts().scene.solver.threads);
            const Stages::Activate recording(parts().stages);
            if (StepReport report = parts().relax_start(); report.status == StepReport::Status::NonFinite)
                return report;
        }
        return parts().advance(parts().settle_ticks(), 0.0, [this](const Parts::Moment& moment) {
            parts().tell("settling", moment.fraction);
        });
    });
}

StepReport World::advance_frame()
{
    Call call(*this, "World::advance_frame");
    return call.take([&] {
        const int next = parts().frame + 1;
        StepReport report =
            parts().advance(parts().control.ticks_of_sample(), next * parts().scene.frame_duration(),
                            [this](const Parts::Moment& moment) { parts().tell_within_frame(moment); });
        parts().frame = next;
        return report;
    });
}

int World::frame() const { return parts().frame; }
int World::frame_count() const { return parts().scene.frames; }
View<const ClothState> World::surfaces() const
{
    const Stages::Activate recording(parts().stages);
    parts().show();
    return parts().states;
}
View<const ClothState> World::simulated() const
{
    return surfaces().subview(0, simulated_count(parts().scene));
}
View<const ClothState> World::cloths() const
{
    return surfaces().subview(0, int(parts().scene.cloths.size()));
}
std::vector<int> World::inverted_tets() const
{
    std::vector<int> counts;
    for (const ClothGroup& group : parts().groups)
        for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i)
            counts.push_back(group.inverted_tets_of(i));
    return counts;
}
std::shared_ptr<const Snapshot> World::snapshot() const
{
    auto snapshot = std::make_shared<Snapshot>();
    for (const ClothGroup& group : parts().groups)
        group.add_to(*snapshot);
    return snapshot;
}
const collision::StartReport& World::start() const { return parts().start; }
int World::vertex_count() const
{
    int count = 0;
    for (const ClothState& surface : simulated())
        count += int(surface.positions.size());
    for (const ClothGroup& group : parts().groups)
        if (group.soft_bodies())
            count += group.soft_bodies()->inner_count();
    return count;
}
const CudaDevice* World::device() const { return parts().space ? &parts().space->device() : nullptr; }
const Stages& World::stages() const { return parts().stages; }

} // namespace toile::scenes
