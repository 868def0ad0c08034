#include "scenes/world/cloth_group.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "collision/check/find_crossings.h"
#include "core/compute/parallel.h"
#include "garment/energy/air/cuda/loads.h"

namespace toile::scenes {

namespace {

/// Time [s] for which cloth must have stayed where it is to fall asleep, and between two looks. A swing moves
/// farther than the sleep speed allows within that time, at its turning point too.
constexpr double kSleepDelay = 0.5, kSleepLook = 0.05;

/// Displacement within kSleepDelay relative to the size of a cloth that keeps it awake [-], where that is
/// less than the sleep speed allows.
constexpr double kSleepSizeFraction = 0.002;

/// Largest speed of a vertex of cloth that may fall asleep, relative to the sleep speed [-]: corners tremble
/// longer than cloth moves.
constexpr double kMaxSpeedRatio = 100.0;

/// By what bone of a body x is, for messages; empty if there is none within 10 cm.
std::string nearest_bone(const Vec3& x, const std::vector<Collider>& colliders)
{
    double min_distance = 0.1; // [m]
    std::string bone;
    for (const Collider& collider : colliders) {
        const std::shared_ptr<const SkinnedCollider> skinned = collider.body().skinned();
        const int nearest = skinned ? skinned->nearest_vertex(x, min_distance) : -1;
        if (nearest < 0 || skinned->avatar().bone_at(nearest).empty())
            continue;
        min_distance = (skinned->vertex_t1(nearest) - x).norm();
        bone = ", by \"" + skinned->avatar().bone_at(nearest) + "\" of \"" + collider.name() + "\"";
    }
    return bone;
}

} // namespace

/// Current positions of the cloths, then of the surfaces of soft bodies and solids.
std::vector<Vec3> ClothGroup::surfaces() const
{
    const View<const Vec3> deforming = body_->positions().subview(0, first_solid_);
    std::vector<Vec3> all(deforming.begin(), deforming.end());
    if (solids_)
        all.insert(all.end(), solids_->bodies().surface().begin(), solids_->bodies().surface().end());
    return all;
}

template <typename T>
View<T> ClothGroup::part(View<T> all, int cloth) const
{
    return all.subview(first_[cloth], first_[cloth + 1] - first_[cloth]);
}

View<const Vec3> ClothGroup::positions_of(int cloth) const { return part(body_->positions(), cloth); }

View<const Vec3> ClothGroup::surface_of_soft_body(int body) const
{
    return body_->positions().subview(soft_bodies_->first_vertex(body),
                                      int(soft_bodies_->state(body).positions.size()));
}

std::vector<Vec3> ClothGroup::render_positions_of(int soft_body) const
{
    return soft_bodies_->render_positions(soft_body, body_->positions());
}

int ClothGroup::inverted_tets_of(int soft_body) const
{
    return soft_bodies_->inverted_count(soft_body, body_->positions());
}

void ClothGroup::add_to(Snapshot& snapshot) const
{
    const std::shared_ptr<const Readback<Vec3>> coming = body_->read_back_positions();
    const auto add = [&](int first, int count) {
        if (coming)
            snapshot.add(coming, first, count);
        else
            snapshot.add(body_->positions().subview(first, count));
    };
    for (int i = 0; i < int(cloths_.size()); ++i)
        add(first_[i], first_[i + 1] - first_[i]);
    for (int i = 0; solids_ && i < solids_->count(); ++i)
        snapshot.add(solids_->positions(i));
    for (int i = 0; soft_bodies_ && i < soft_bodies_->count(); ++i)
        add(soft_bodies_->first_vertex(i), int(soft_bodies_->state(i).positions.size()));
    for (int i = 0; soft_bodies_ && i < soft_bodies_->count(); ++i)
        if (soft_bodies_->render_state(i))
            snapshot.add(render_positions_of(i));
}

void ClothGroup::tie(double gap, const std::vector<Collider>& colliders,
                     const std::function<void(const std::string&)>& warn)
{
    for (SceneCloth& cloth : cloths_)
        cloth.tie(gap, colliders, warn);
    if (soft_bodies_)
        soft_bodies_->tie(colliders);
}

void ClothGroup::mark_fixed(double t_t1)
{
    for (int i = 0; i < int(cloths_.size()); ++i)
        cloths_[i].mark_fixed(t_t1, part(View<unsigned char>(fixed_), i));
    if (soft_bodies_)
        soft_bodies_->mark_fixed(t_t1, fixed_);
}

void ClothGroup::prepare(double dt, double t_t1)
{
    mark_fixed(t_t1);
    body_->prepare(dt, fixed_);
}

StepReport ClothGroup::step(double dt, double t_t1, const std::vector<Collider>& colliders, double max_error)
{
    if (is_asleep(t_t1, colliders)) {
        StepReport report;
        report.steps = 1;
        return report;
    }
    const bool have_cores_jumped = soft_bodies_ && soft_bodies_->have_cores_jumped(colliders, dt);
    has_jump_ = contact_ && (contact_->have_bodies_jumped(dt) || have_cores_jumped);
    may_cross_ = may_cross_ || has_jump_;
    if (may_cross_ && contact_ && contact_->keeps_cloth_apart())
        mark_crossings();
    mark_fixed(t_t1);
    for (int i = 0; i < int(cloths_.size()); ++i)
        cloths_[i].update_targets(t_t1, colliders, part(View<Vec3>(targets_), i));
    if (soft_bodies_)
        soft_bodies_->update_targets(t_t1, colliders, targets_);
    if (loads_)
        loads_->set_step(t_t1, !is_relaxing_);
    else
        accelerate(dt, t_t1);
    begin_solids(dt);
    body_->refuse_steps_beyond(max_error);
    const std::vector<Vec3> weightless(is_relaxing_ ? acceleration_.size() : 0, Vec3::Zero());
    StepReport report =
        body_->step(dt, is_relaxing_ ? weightless : acceleration_, fixed_, targets_, active(), limits_.get());
    if (report.refused > 0)
        return report;
    may_cross_ =
        may_cross_ || (contact_ && (contact_->stuck_count() > 0 || contact_->let_through_count() > 0 ||
                                    have_cores_jumped)); // flesh has gone where nobody looked
    if (report.status != StepReport::Status::NonFinite)
        end_solids();
    if (contact_) {
        report.contacts = contact_->active_count();
        report.min_gap = contact_->min_gap();
    }
    if (report.status == StepReport::Status::NonFinite)
        report.message = names() + ": " + report.message;
    report.max_strain = loads_ ? limits_->max_strain_on_device() : limits_->max_strain(body_->positions());

    // A solver whose every direction was refused, or the last one, leaves the cloth where it is: not rest.
    report.unfinished = report.status == StepReport::Status::IterationLimit ? 1 : 0;
    const bool is_stuck = report.unfinished > 0 && (report.iterations == 0 || report.displacement == 0.0);
    judge(t_t1, colliders, report);
    watch_rest(is_stuck, dt);
    return report;
}

/// Completes the status: what has yielded, and where. Copies positions from a GPU only where something has,
/// or may have: exactly held vertices.
void ClothGroup::judge(double t_t1, const std::vector<Collider>& colliders, StepReport& report)
{
    const auto raise = [&](StepReport::Status status) { report.status = std::max(report.status, status); };
    if (contact_ && contact_->bodies()) {
        report.pinched.count = contact_->let_through_count();
        if (report.pinched.count > 0) {
            report.pinched.place = place_of(contact_->first_let_through(), colliders);
            raise(StepReport::Status::Pinched);
        }
        report.stuck.count = crossing_bodies_ + contact_->stuck_count();
        if (report.stuck.count > 0) {
            report.stuck.place =
                place_of(contact_->stuck_count() > 0 ? contact_->first_stuck() : first_crossing_, colliders);
            raise(StepReport::Status::Stuck);
        }
    }
    if (has_jump_) {
        report.stuck.merge({1, "a body moves faster than 50 m/s and may have left cloth behind"});
        raise(StepReport::Status::Stuck);
    }
    find_strained(t_t1, colliders, report);
    find_displaced(colliders, report);
    if (report.yielded.count > 0 || report.displaced.count > 0)
        raise(StepReport::Status::Yielded);
}

/// Finds the triangles beyond their limit, given the largest strain of any.
void ClothGroup::find_strained(double t_t1, const std::vector<Collider>& colliders, StepReport& report) const
{
    for (int c = 0; c < int(cloths_.size()); ++c) {
        const garment::StrainLimit& limit = cloths_[c].strain_limit();
        if (report.max_strain <= limit.least_limit() + garment::kStrainMargin)
            continue;
        const View<const Vec3> x = part(body_->positions(), c);
        const std::vector<unsigned char> attached = cloths_[c].state().attached(t_t1);
        const garment::StrainLimit::Excess excess = limit.excess(x, garment::kStrainMargin, attached);
        const auto place = [&](int triangle) {
            const Triangle& t = cloths_[c].state().triangles[triangle];
            const auto held = std::find_if(t.begin(), t.end(), [&](int v) { return attached[v] != 0; });
            return held == t.end() ? place_of(first_[c] + t[0], colliders)
                                   : place_of(first_[c] + *held, colliders) + ", which is attached";
        };
        if (excess.count > 0)
            report.yielded.merge({excess.count, place(excess.triangle)});
        if (excess.held > 0)
            report.pulled.merge({excess.held, place(excess.first_held)});
    }
}

/// Finds exactly held vertices that are off their targets.
void ClothGroup::find_displaced(const std::vector<Collider>& colliders, StepReport& report) const
{
    constexpr double kTolerated = 1e-4; // [m]
    const bool any_held = std::find(fixed_.begin(), fixed_.end(), 1) != fixed_.end();
    if (!any_held || !contact_ || !contact_->keeps_cloth_apart())
        return;
    const View<const Vec3> x = body_->positions();
    for (int v = 0; v < x.size(); ++v)
        if (fixed_[v] != 0 && (x[v] - targets_[v]).norm() > kTolerated) {
            if (report.displaced.count++ == 0)
                report.displaced.place = place_of(v, colliders);
        }
}

bool ClothGroup::is_strained() const
{
    StepReport report;
    report.max_strain = std::numeric_limits<double>::max();
    find_strained(0.0, {}, report);
    return report.yielded.count > 0;
}

StepReport ClothGroup::relax(double dt, double t_t1, const std::vector<Collider>& colliders)
{
    constexpr double kAtRest = 1.0; // [m/s^2] of all vertices: a tenth of gravity
    const std::vector<Vec3> velocities(body_->velocities().begin(), body_->velocities().end());
    const std::vector<Vec3> start = is_unsettled() ? surfaces() : std::vector<Vec3>();
    body_->set_velocities(std::vector<Vec3>(velocities.size(), Vec3::Zero()));
    std::vector<RigidBodies::Motion> of_solids;
    if (solids_) {
        of_solids = solids_->bodies().motions();
        solids_->bodies().set_motions(std::vector<RigidBodies::Motion>(of_solids.size()));
    }
    is_relaxing_ = true;
    StepReport report = step(dt, t_t1, colliders, kAnyStepError);
    is_relaxing_ = false;
    if (solids_)
        solids_->bodies().set_motions(of_solids);
    forget_rest(); // it is not that of a body with weight
    body_->set_velocities(velocities);
    body_->begin_anew();
    if (is_unsettled()) {
        const std::vector<Vec3> x = surfaces();
        if (std::all_of(unsettled_.begin(), unsettled_.end(),
                        [&](int v) { return (x[v] - start[v]).norm() < kAtRest * dt * dt; }))
            unsettled_.clear();
    }
    return report;
}

void ClothGroup::find_stiff_parts(double shortest_step)
{
    if (!soft_bodies_)
        return;
    std::vector<int> parts = soft_bodies_->stiff_parts(shortest_step);
    if (!parts.empty())
        body_->set_stiff_parts(parts);
}

void ClothGroup::unsettle(int cloth, View<const int> vertices)
{
    std::transform(vertices.begin(), vertices.end(), std::back_inserter(unsettled_),
                   [&](int v) { return first_[cloth] + v; });
}

void ClothGroup::unsettle_soft_body(int body)
{
    unsettle_surface(soft_bodies_->first_vertex(body), soft_bodies_->state(body).positions.size());
}

void ClothGroup::unsettle_solid(int solid)
{
    unsettle_surface(first_solid_ + solids_->bodies().first_vertex(solid),
                     solids_->state(solid).positions.size());
}

/// @param first  of surfaces()
void ClothGroup::unsettle_surface(int first, size_t count)
{
    unsettled_.resize(unsettled_.size() + count);
    std::iota(unsettled_.end() - std::ptrdiff_t(count), unsettled_.end(), first);
}

/// Vertex 12 of "skirt" near (0.100, 0.900, 0.020) m, by "hips" of "woman".
std::string ClothGroup::place_of(int vertex, const std::vector<Collider>& colliders) const
{
    const Vec3& x = body_->positions()[vertex];
    char at[80];
    std::snprintf(at, sizeof at, " near (%.3f, %.3f, %.3f) m", x.x(), x.y(), x.z());
    if (vertex >= first_.back())
        return "soft body \"" + soft_bodies_->state(soft_bodies_->body_of(vertex)).name + "\"" + at +
               nearest_bone(x, colliders);
    int cloth = 0;
    while (cloth + 1 < int(cloths_.size()) && vertex >= first_[cloth + 1])
        ++cloth;
    const int number = cloths_[cloth].state().file_vertex(vertex - first_[cloth]);
    return "vertex " + std::to_string(number) + " of \"" + cloths_[cloth].state().name + "\"" + at +
           nearest_bone(x, colliders);
}

/// Accelerations and tension on the CPU.
void ClothGroup::accelerate(double dt, double t_t1)
{
    const View<const Vec3> x = body_->positions(), v = body_->velocities();
    for (int i = 0; i < int(cloths_.size()); ++i) {
        cloths_[i].accelerate(dt, t_t1, part(x, i), part(v, i), part(View<Vec3>(acceleration_), i));
        cloths_[i].begin_step(part(x, i), dt, t_t1);
    }
    if (soft_bodies_)
        soft_bodies_->accelerate(dt, v, acceleration_);
}

/// Marks vertices of crossing triangles of cloth, solids and bodies, by exact predicates. Runs at the first
/// step unless the start is known to be free of crossings, after place(), and while crossings remain.
/// Self-crossings of a solid are ignored.
void ClothGroup::mark_crossings()
{
    const StageScope stage("scenes/find_crossings");
    const std::vector<Vec3> x = surfaces();
    const collision::BodySurfaces* bodies = contact_->bodies();
    std::vector<unsigned char> crosses(x.size(), 0);
    may_cross_ = false;
    std::vector<collision::Crossing> of_cloth;
    if (may_cross_cloth_)
        of_cloth = collision::find_crossings(triangles_, x);
    may_cross_cloth_ = true;
    for (const collision::Crossing& crossing : of_cloth) {
        if (solids_ && solid_of(crossing.a) >= 0 && solid_of(crossing.a) == solid_of(crossing.b))
            continue;
        may_cross_ = true;
        for (const int t : {crossing.a, crossing.b})
            for (const int v : triangles_[t])
                crosses[v] = 1;
    }
    contact_->set_crossing(crosses);
    if (bodies) {
        std::vector<Vec3> body_x(bodies->vertex_count());
        bodies->pose_t0(body_x);
        const std::vector<collision::Crossing> crossings =
            collision::find_crossings(triangles_, x, bodies->triangles(), body_x);
        std::vector<int> crossing_cloth;
        crossing_cloth.reserve(crossings.size());
        for (const collision::Crossing& crossing : crossings)
            crossing_cloth.push_back(crossing.a);
        contact_->close_let_through(crossing_cloth);
        crossing_bodies_ = 0;
        std::vector<std::pair<int, int>> body_crossings;
        for (const collision::Crossing& crossing : crossings) {
            if (triangles_[crossing.a][0] >= first_solid_ || contact_->lets_through(triangles_[crossing.a]))
                continue; // a solid, or let through
            if (crossing_bodies_++ == 0)
                first_crossing_ = triangles_[crossing.a][0];
            for (const int v : triangles_[crossing.a])
                for (const int w : bodies->triangles()[crossing.b])
                    body_crossings.emplace_back(v, w);
        }
        may_cross_ = may_cross_ || crossing_bodies_ > 0;
        const std::vector<unsigned char> inside = mark_inside(*bodies, x);
        has_cloth_inside_ = !inside.empty();
        may_cross_ = may_cross_ || has_cloth_inside_;
        contact_->set_body_crossings(body_crossings, inside);
    }
}

/// Marks cloth inside bodies that does not let them through; empty if there is none. Only cloth that has
/// crossed a body may be there.
std::vector<unsigned char> ClothGroup::mark_inside(const collision::BodySurfaces& bodies,
                                                   View<const Vec3> x) const
{
    if (crossing_bodies_ == 0 && !has_jump_ && !has_cloth_inside_)
        return {};
    std::vector<unsigned char> inside(x.size(), 0);
    parallel_for(kCpu, "scenes/inside", first_solid_, [&](int v) {
        inside[v] = (unsigned char)(!contact_->lets_through(v) && bodies.is_inside(x[v]) ? 1 : 0);
    });
    const bool any = std::find(inside.begin(), inside.end(), 1) != inside.end();
    return any ? inside : std::vector<unsigned char>{};
}

/// Solid that owns a triangle of triangles_, -1 for cloth.
int ClothGroup::solid_of(int triangle) const
{
    const int v = triangles_[triangle][0] - first_solid_;
    int solid = -1;
    while (solid + 1 < solids_->count() && solids_->bodies().first_vertex(solid + 1) <= v)
        ++solid;
    return solid;
}

ActiveSetEnergy* ClothGroup::active() const
{
    if (surface_contact_)
        return surface_contact_.get();
    return rigid_contact_ ? static_cast<ActiveSetEnergy*>(rigid_contact_.get()) : contact_.get();
}

/// Resets the solids' unknowns, which are relative to the pose at the start of each step.
void ClothGroup::begin_solids(double dt)
{
    if (!solids_)
        return;
    std::vector<Vec3> q(body_->positions().begin(), body_->positions().end());
    std::vector<Vec3> v(body_->velocities().begin(), body_->velocities().end());
    const int first = first_solid_, count = solids_->bodies().unknown_count();
    solids_->bodies().begin_step(dt, View<Vec3>(q).subview(first, count),
                                 View<Vec3>(v).subview(first, count));
    body_->set_positions(q);
    body_->set_velocities(v);
}

void ClothGroup::end_solids()
{
    if (!solids_)
        return;
    const int first = first_solid_, count = solids_->bodies().unknown_count();
    solids_->bodies().end_step(body_->positions().subview(first, count),
                               body_->velocities().subview(first, count));
}

/// Names for messages: cloth "skirt", or cloths "skirt", "vest" and solid "bowl".
std::string ClothGroup::names() const
{
    std::string names;
    const auto add = [&](const char* word, const char* words, int count, const auto& name_of) {
        for (int i = 0; i < count; ++i)
            names += (i > 0 ? ", "
                            : (names.empty() ? "" : " and ") + std::string(count == 1 ? word : words) + " ") +
                     "\"" + name_of(i) + "\"";
    };
    add("cloth", "cloths", int(cloths_.size()), [&](int i) { return cloths_[i].state().name; });
    if (soft_bodies_)
        add("soft body", "soft bodies", soft_bodies_->count(),
            [&](int i) { return soft_bodies_->state(i).name; });
    if (solids_)
        add("solid", "solids", solids_->count(), [&](int i) { return solids_->state(i).name; });
    return names;
}

void ClothGroup::place(int cloth, View<const Vec3> positions)
{
    cloths_[cloth].take(positions);
    cloths_[cloth].forget();
    std::vector<Vec3> all(body_->positions().begin(), body_->positions().end());
    std::copy(positions.begin(), positions.end(), all.begin() + first_[cloth]);
    restart_from(all);
}

void ClothGroup::place_soft_bodies(const std::vector<std::vector<Vec3>>& surfaces)
{
    std::vector<Vec3> all(body_->positions().begin(), body_->positions().end());
    bool any = false;
    for (int i = 0; i < int(surfaces.size()); ++i)
        if (surfaces[i] != soft_bodies_->state(i).positions) {
            soft_bodies_->place(i, surfaces[i], all);
            unsettle_soft_body(i);
            any = true;
        }
    if (any)
        restart_from(all);
}

/// Moves all unknowns. Nothing is known of contacts there.
void ClothGroup::restart_from(View<const Vec3> x)
{
    if (contact_)
        contact_->forget();
    body_->set_positions(x);
    may_cross_ = may_cross_cloth_ = true;
    forget_rest();
}

void ClothGroup::forget_rest()
{
    still_time_ = 0.0;
    still_.clear();
}

/// Measures for how long everything has stayed where it is. Positions are compared, not speeds: cloth in
/// contact trembles without going anywhere. A body on a GPU copies them only where nothing moves much.
void ClothGroup::watch_rest(bool is_stuck, double dt)
{
    if (is_stuck || !(body_->max_speed() < kMaxSpeedRatio * sleep_.speed)) {
        still_time_ = 0.0;
        still_.clear();
        return;
    }
    const double before = still_time_;
    still_time_ += dt;
    if (!still_.empty() && std::floor(before / kSleepLook) == std::floor(still_time_ / kSleepLook))
        return;
    std::vector<Vec3> now = surfaces();
    if (still_.empty() || has_moved(still_, now)) {
        still_ = std::move(now);
        still_time_ = 0.0;
    }
}

/// True if the RMS displacement of the vertices of a surface exceeds what sleep allows.
bool ClothGroup::has_moved(View<const Vec3> from, View<const Vec3> to) const
{
    std::vector<int> first = first_;
    if (soft_bodies_)
        for (int k = 1; k <= soft_bodies_->count(); ++k)
            first.push_back(k < soft_bodies_->count() ? soft_bodies_->first_vertex(k) : first_solid_);
    if (solids_)
        for (int k = 1; k <= solids_->count(); ++k)
            first.push_back(k < solids_->count() ? first_solid_ + solids_->bodies().first_vertex(k)
                                                 : int(to.size()));
    for (int k = 0; k + 1 < int(first.size()); ++k) {
        double sum = 0.0;
        for (int i = first[k]; i < first[k + 1]; ++i)
            sum += (to[i] - from[i]).squaredNorm();
        double allowed = kSleepDelay * sleep_.speed;
        if (k < int(cloths_.size())) {
            const Bounds box = bounds(cloths_[k].state().rest.positions);
            allowed = std::min(allowed, kSleepSizeFraction * (box.upper - box.lower).norm());
        }
        if (sum > (first[k + 1] - first[k]) * allowed * allowed)
            return true;
    }
    return false;
}

/// True if everything has stayed where it is for kSleepDelay and nothing disturbs it.
bool ClothGroup::is_asleep(double t_t1, const std::vector<Collider>& colliders)
{
    const bool disturbed = std::any_of(colliders.begin(), colliders.end(),
                                       [](const Collider& collider) { return collider.moved(); }) ||
                           std::any_of(cloths_.begin(), cloths_.end(),
                                       [&](const SceneCloth& cloth) { return cloth.is_disturbed(t_t1); }) ||
                           (soft_bodies_ && soft_bodies_->is_disturbed(t_t1));
    if (disturbed) {
        still_time_ = 0.0;
        still_.clear();
    }
    return sleep_.enabled && still_time_ > kSleepDelay;
}

} // namespace toile::scenes
