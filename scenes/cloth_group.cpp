#include "scenes/cloth_group.h"

#include <algorithm>
#include <cmath>

#include "collision/crossings/find_crossings.h"
#include "core/linear/block_diagonal_solver.h"
#include "core/linear/field.h"
#include "core/pd/body.h"
#include "core/pd/sliced_energy.h"
#include "scenes/contact_setup.h"
#include "scenes/method_choice.h"

namespace toile {

namespace {

/// Time [s] that cloth must be slow before it is put to rest: longer than the swing of a hem through its
/// turning point.
constexpr double kSleepDelay = 0.5;

/// The options as one cloth's solver sees them.
TableSource source_of_tables(const WorldOptions& options, const std::string& cloth)
{
    TableSource source;
    if (options.tables)
        source.store = options.tables;
    if (options.building)
        source.listener.progress = [building = options.building, cloth](double share) {
            return building(cloth, share);
        };
    source.listener.warn = options.warn;
    return source;
}

} // namespace

ClothGroup::ClothGroup(const Scene& scene, std::vector<SceneCloth> cloths,
                       const std::vector<Obstacle>& obstacles, const WorldOptions& options)
    : sleep_(scene.solver.sleep), cloths_(std::move(cloths)), first_{0}
{
    for (const SceneCloth& cloth : cloths_)
        first_.push_back(first_.back() + cloth.vertex_count());
    for (size_t i = 0; i < cloths_.size(); ++i)
        for (const Triangle& t : cloths_[i].state().triangles)
            triangles_.push_back(t + Triangle::Constant(first_[i]));
    body_ = is_rival(scene.solver.method) ? make_rival(scene.solver, positions(), cloths_.front().model())
                                          : make_body(scene, options);
    contact_ = make_contact(scene, obstacles);
    std::vector<JointProjection::Part> limits;
    for (size_t i = 0; i < cloths_.size(); ++i)
        limits.push_back({&cloths_[i].strain_limit(), first_[i], cloths_[i].vertex_count()});
    limits_ = std::make_unique<JointProjection>(std::move(limits));
    fixed_.assign(first_.back(), 0);
    targets_.assign(first_.back(), Vec3::Zero());
    acceleration_.assign(first_.back(), Vec3::Zero());
}

/// Projective dynamics: every term is an energy, every cloth keeps its own solver.
std::unique_ptr<PointMasses> ClothGroup::make_body(const Scene& scene, const WorldOptions& options)
{
    std::vector<double> masses;
    std::vector<std::shared_ptr<Energy>> energies;
    std::vector<BlockDiagonalSolver::Block> blocks;
    for (size_t i = 0; i < cloths_.size(); ++i) {
        SceneCloth& cloth = cloths_[i];
        masses.insert(masses.end(), cloth.masses().begin(), cloth.masses().end());
        for (auto& energy : cloth.make_energies())
            energies.push_back(cloths_.size() == 1
                                   ? energy
                                   : std::make_shared<SlicedEnergy>(energy, first_[i], cloth.vertex_count()));
        const ClothState& state = cloth.state();
        blocks.push_back(
            {cloth.vertex_count(),
             make_global_solver(scene.solver.method, cloth.rest_shape(), {state.positions, state.triangles},
                                cloth.source(), source_of_tables(options, state.name))});
    }
    std::unique_ptr<GlobalSolver> solver;
    if (blocks.size() == 1)
        solver = std::move(blocks.front().solver);
    else
        solver = std::make_unique<BlockDiagonalSolver>(std::move(blocks));

    Body::Settings settings;
    settings.tolerance = scene.solver.tolerance;
    settings.max_iterations = scene.solver.max_iterations;
    settings.outer = scene.solver.outer;
    settings.contact_solve.preconditioner = scene.solver.contact_preconditioner;
    return std::make_unique<Body>(
        positions(), std::make_unique<System>(std::move(masses), std::move(energies), std::move(solver)),
        settings);
}

std::unique_ptr<Contact> ClothGroup::make_contact(const Scene& scene, const std::vector<Obstacle>& obstacles)
{
    const Contact::Settings settings = contact_settings(scene);
    if (obstacles.empty() && !settings.cloth_with_cloth)
        return nullptr;
    return std::make_unique<Contact>(triangles_, positions(), contact_cloths(scene, cloths_, obstacles),
                                     contact_partners(obstacles), settings);
}

std::vector<Vec3> ClothGroup::positions() const
{
    std::vector<Vec3> all;
    for (const SceneCloth& cloth : cloths_)
        all.insert(all.end(), cloth.state().positions.begin(), cloth.state().positions.end());
    return all;
}

template <typename T>
View<T> ClothGroup::part(View<T> all, int cloth) const
{
    return all.subview(first_[cloth], first_[cloth + 1] - first_[cloth]);
}

void ClothGroup::mark_fixed(double t_t1)
{
    for (int i = 0; i < int(cloths_.size()); ++i)
        cloths_[i].mark_fixed(t_t1, part(View<unsigned char>(fixed_), i));
}

void ClothGroup::prepare(double dt, double t_t1)
{
    mark_fixed(t_t1);
    body_->prepare(dt, fixed_);
}

StepReport ClothGroup::step(double dt, double t_t1, const std::vector<Obstacle>& obstacles)
{
    if (sleeps(t_t1, obstacles)) {
        StepReport report;
        report.steps = 1;
        return report;
    }
    if (may_cross_ && contact_ && contact_->keeps_cloth_apart())
        look_for_crossings();
    mark_fixed(t_t1);
    const View<const Vec3> x = body_->positions(), v = body_->velocities();
    for (int i = 0; i < int(cloths_.size()); ++i) {
        cloths_[i].hold(t_t1, obstacles, part(View<Vec3>(targets_), i));
        cloths_[i].accelerate(dt, t_t1, part(x, i), part(v, i), part(View<Vec3>(acceleration_), i));
        cloths_[i].begin_step(part(x, i));
    }
    StepReport report = body_->step(dt, acceleration_, fixed_, targets_, contact_.get(), limits_.get());
    take_positions();
    if (contact_) {
        report.contacts = contact_->active_count();
        report.min_gap = contact_->min_gap();
    }
    if (report.status == StepReport::Status::NonFinite)
        report.message = names() + ": " + report.message;
    report.max_strain = 0.0;
    for (SceneCloth& cloth : cloths_)
        report.max_strain =
            std::max(report.max_strain, cloth.strain_limit().max_strain(cloth.state().positions));

    // A solver whose every direction was refused leaves the cloth standing: that is no rest.
    const bool is_stuck = report.status == StepReport::Status::IterationLimit && report.iterations == 0;
    const bool is_slow = max_norm(body_->velocities()) < sleep_.speed;
    rest_time_ = is_slow && !is_stuck ? rest_time_ + dt : 0.0;
    return report;
}

/// Exactly, at the first step and then as long as there are any.
void ClothGroup::look_for_crossings()
{
    const StageScope stage("scenes/find_crossings");
    std::vector<unsigned char> crosses(first_.back(), 0);
    const std::vector<Crossing> crossings = find_crossings(triangles_, body_->positions());
    for (const Crossing& crossing : crossings)
        for (const int t : {crossing.a, crossing.b})
            for (const int v : triangles_[t])
                crosses[v] = 1;
    contact_->set_crossing(crosses);
    may_cross_ = !crossings.empty();
}

void ClothGroup::take_positions()
{
    for (int i = 0; i < int(cloths_.size()); ++i)
        cloths_[i].take(part(body_->positions(), i));
}

/// cloth "skirt", or cloths "skirt", "vest".
std::string ClothGroup::names() const
{
    std::string names = cloths_.size() == 1 ? "cloth" : "cloths";
    for (size_t i = 0; i < cloths_.size(); ++i)
        names += (i == 0 ? " \"" : ", \"") + cloths_[i].state().name + "\"";
    return names;
}

void ClothGroup::place(int cloth, View<const Vec3> positions)
{
    cloths_[cloth].take(positions);
    cloths_[cloth].forget();
    if (contact_)
        contact_->forget();
    body_->set_positions(this->positions());
    may_cross_ = true;
    rest_time_ = 0.0;
}

/// True when nothing has moved these cloths for a while and nothing is about to.
bool ClothGroup::sleeps(double t_t1, const std::vector<Obstacle>& obstacles)
{
    const bool disturbed = std::any_of(obstacles.begin(), obstacles.end(),
                                       [](const Obstacle& obstacle) { return obstacle.moved(); }) ||
                           std::any_of(cloths_.begin(), cloths_.end(),
                                       [&](const SceneCloth& cloth) { return cloth.is_disturbed(t_t1); });
    if (disturbed)
        rest_time_ = 0.0;
    return sleep_.enabled && rest_time_ > kSleepDelay;
}

std::vector<ClothGroup> make_groups(const Scene& scene, const std::vector<Obstacle>& obstacles,
                                    const WorldOptions& options)
{
    std::vector<SceneCloth> cloths;
    for (const scene::Cloth& cloth : scene.cloths)
        cloths.emplace_back(scene, cloth, obstacles, options);
    const bool may_touch = contact_settings(scene).cloth_with_cloth;
    std::vector<std::vector<SceneCloth>> members;
    for (SceneCloth& cloth : cloths) {
        if (members.empty() || !may_touch)
            members.emplace_back();
        members.back().push_back(std::move(cloth));
    }
    std::vector<ClothGroup> groups;
    groups.reserve(members.size());
    for (auto& group : members)
        groups.emplace_back(scene, std::move(group), obstacles, options);
    return groups;
}

} // namespace toile
