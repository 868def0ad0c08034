#include "scenes/world/scene_cloth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "garment/energy/air/cuda/loads.h"
#include "garment/energy/air/loads_kernels.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/seam/sewing.h"
#include "scenes/colliders/vertex_owner.h"
#include "scenes/meshes/cloth_mesh.h"
#include "scenes/method/solver_choice.h"
#include "scenes/surfaces/load_cloth.h"

namespace toile::scenes {

namespace {

/// Excess over the strain limit that is clamped after a step of Newton's method [-]. Below it the limit is an
/// elastic energy; above it something has moved the cloth that is stronger, such as bodies that close on it.
constexpr double kYielding = 0.045;

/// Distance from an avatar [m] beyond which attached cloth is not on it.
constexpr double kFar = 0.05;

/// Diagonal of the box around the cloth [m], as large as the cloth is at rest.
double size_at_rest(const ClothState& cloth, const garment::RestShape& rest)
{
    const Bounds box = bounds(cloth.rest.positions);
    const double posed = (box.upper - box.lower).norm();
    if (cloth.panels.empty())
        return posed;
    double rest_area = 0.0, posed_area = 0.0;
    for (size_t t = 0; t < rest.triangles.size(); ++t) {
        const Mat32 F = rest.deformation_gradient(int(t), cloth.rest.positions);
        rest_area += rest.areas[t];
        posed_area += rest.areas[t] * F.col(0).cross(F.col(1)).norm();
    }
    return posed * std::sqrt(rest_area / posed_area);
}

} // namespace

garment::AirSettings air_of(const Scene& scene)
{
    return {scene.air.density, scene.air.normal, scene.air.tangential};
}

garment::Gusts gusts_of(const scene::Wind& wind)
{
    garment::Gusts::Settings settings;
    settings.intensity = wind.turbulence;
    settings.seed = std::uint64_t(wind.seed);
    return {wind.velocity, settings};
}

SceneCloth::SceneCloth(const Scene& scene, const scene::Cloth& settings,
                       const std::vector<Collider>& colliders, const WorldOptions& options)
    : source_(source_of(settings)), gravity_(scene.gravity), wind_(scene.wind), gusts_(gusts_of(scene.wind)),
      sewing_(settings.sewing.value_or(scene::Sewing{})),
      overpressure_(settings.pressure.value_or(scene::Pressure{}))
{
    LoadedCloth loaded = load_cloth(scene, settings, colliders, options.warn);
    if (options.note && !loaded.note.empty())
        options.note(loaded.note);
    state_ = std::move(loaded.state);
    rest_ = std::move(loaded.rest);
    elastics_ = std::move(loaded.elastics);
    folds_ = std::move(loaded.folds);
    if (!loaded.tacks.empty())
        tacks_ = std::make_unique<garment::Tacks>(loaded.tacks);
    parts_ = fabric_parts(state_, rest_);
    masses_ = masses_of(parts_);
    add_attachments(scene, colliders);

    air_ = std::make_unique<garment::Aerodynamics>(rest_, air_of(scene));
    strain_limit_ = std::make_unique<garment::StrainLimit>(rest_, strain_limits({}), source_);
    if (overpressure_.pa != 0.0)
        add_pressure(options.warn);
}

/// @param warn  may be empty
void SceneCloth::add_pressure(const std::function<void(const std::string&)>& warn)
{
    pressure_ = std::make_shared<garment::Pressure>(rest_);
    if (warn && overpressure_.pa > 0.0 && pressure_->is_closed() && pressure_->volume(state_.positions) < 0.0)
        warn(source_ + ": the faces' normals point inwards, so pressure compresses what \"" + state_.name +
             "\" encloses; turn the faces around, or make pressure negative");
}

void SceneCloth::add_attachments(const Scene& scene, const std::vector<Collider>& colliders)
{
    std::optional<double> mass;
    if (!replaces_minimiser(scene.solver.method))
        mass = std::accumulate(masses_.begin(), masses_.end(), 0.0);
    auto selected = state_.attachments.begin();
    for (size_t i = 0; i < scene.attachments.size(); ++i) {
        const scene::Attachment& attachment = scene.attachments[i];
        if (attachment.cloth != state_.name)
            continue;
        const std::string location = attachment_location(scene, i);
        require_method_supports(scene.solver.method, attachment, location);
        attachments_.emplace_back(attachment, (selected++)->vertices, state_.positions, colliders, mass,
                                  location);
    }
    std::vector<VertexOwner> owners;
    for (const AttachmentConstraint& attachment : attachments_)
        owners.push_back(owner_of(attachment));
    require_one_owner(owners, state_.name,
                      [&](int v) { return "vertex " + std::to_string(state_.file_vertex(v)); });
}

/// Membranes with their internal friction, which implicit Euler's own losses hide, and the fixed matrix of
/// other minimisers than Newton's does not know.
void SceneCloth::add_membranes(bool has_internal_friction, std::vector<std::shared_ptr<Energy>>& energies)
{
    for (FabricPart& part : parts_) {
        const garment::Fabric& fabric = part.fabric;
        garment::Membrane::Settings stretch{fabric.stretch_warp, fabric.stretch_weft, fabric.shear};
        if (has_internal_friction) {
            stretch.stretch_damping = fabric.stretch_damping;
            stretch.shear_damping = fabric.shear_damping;
        }
        part.membrane = std::make_shared<garment::Membrane>(part.rest, stretch, source_, part.stiffness);
        energies.push_back(part.membrane);
    }
}

/// Bending across all fabrics, with its internal friction. After add_membranes().
void SceneCloth::add_bending(bool has_internal_friction, std::vector<std::shared_ptr<Energy>>& energies)
{
    std::vector<garment::Bending::Settings> rigidities;
    std::vector<garment::BendDamping::Settings> dampings;
    bool is_rigid = false, is_damped = false;
    for (const garment::Fabric& fabric : state_.fabrics()) {
        rigidities.push_back({fabric.bend_warp, fabric.bend_weft});
        dampings.push_back({rigidities.back(), fabric.bend_damping, fabric.bend_friction});
        is_rigid = is_rigid || fabric.bend_warp > 0.0 || fabric.bend_weft > 0.0;
        is_damped = is_damped || dampings.back().is_active();
    }
    if (!is_rigid)
        return;
    const auto bending = std::make_shared<garment::Bending>(
        rest_, garment::ByFabric(std::move(rigidities), state_.fabric_of_triangle, state_.stiffness), source_,
        fold_hinges());
    std::vector<double> diagonal(size_t(vertex_count()), 0.0);
    for (const FabricPart& part : parts_) {
        const std::vector<double> of_part = hessian_diagonal(*part.membrane, vertex_count());
        for (size_t v = 0; v < diagonal.size(); ++v)
            diagonal[v] += of_part[v];
    }
    bending->leave_to(diagonal);
    energies.push_back(bending);
    if (!has_internal_friction || !is_damped)
        return;
    bend_damping_ = std::make_shared<garment::BendDamping>(
        *rest_, garment::ByFabric(std::move(dampings), state_.fabric_of_triangle, state_.stiffness), source_,
        fold_hinges());
    energies.push_back(bend_damping_);
}

garment::ByFabric<garment::StrainLimit::Settings>
SceneCloth::strain_limits(const garment::StrainLimit::Settings& settings) const
{
    std::vector<garment::StrainLimit::Settings> limits;
    for (const garment::Fabric& fabric : state_.fabrics()) {
        limits.push_back(settings);
        limits.back().limit = fabric.strain_limit;
    }
    return {std::move(limits), state_.fabric_of_triangle};
}

/// Tension at the strain limit.
void SceneCloth::add_tension(OuterMethod outer, std::vector<std::shared_ptr<Energy>>& energies)
{
    const bool is_elastic = outer == OuterMethod::Newton;
    if (is_elastic)
        strain_limit_ =
            std::make_unique<garment::StrainLimit>(rest_, strain_limits({.tolerance = kYielding}), source_);
    const double stiffest =
        state_.stiffness.empty() ? 1.0 : *std::max_element(state_.stiffness.begin(), state_.stiffness.end());
    std::vector<garment::StretchTension::Settings> tensions;
    for (const garment::Fabric& fabric : state_.fabrics()) {
        const double stiffness = stiffest * std::max(fabric.stretch_warp, fabric.stretch_weft);
        // That of cloth of even width, as long as the diagonal, which hangs by a whole edge across the wind.
        const double pressure = fabric.areal_density * gravity_.norm() +
                                air_->pressure(wind_.velocity.norm()) + std::abs(overpressure_.pa);
        const double load = pressure * size_at_rest(state_, *rest_);
        tensions.push_back(
            is_elastic ? garment::StretchTension::Settings::elastic(fabric.strain_limit, stiffness, load)
                       : garment::StretchTension::Settings{fabric.strain_limit, stiffness});
    }
    tension_ = std::make_shared<garment::StretchTension>(
        rest_, garment::ByFabric(std::move(tensions), state_.fabric_of_triangle));
    strain_limit_->set_tension(tension_);
    energies.push_back(tension_);
}

std::vector<std::shared_ptr<Energy>> SceneCloth::make_energies(OuterMethod outer)
{
    const bool has_internal_friction = outer == OuterMethod::Newton;
    std::vector<std::shared_ptr<Energy>> energies;
    add_membranes(has_internal_friction, energies);
    add_bending(has_internal_friction, energies);
    add_folds(energies);
    add_springs(energies);
    add_sewing(energies);
    if (pressure_)
        energies.push_back(pressure_);
    if (!elastics_.empty())
        energies.push_back(std::make_shared<garment::Elastics>(elastics_));
    if (tacks_)
        energies.push_back(tacks_->threads());
    add_tension(outer, energies);
    return energies;
}

/// Edges across which cloth does not bend but by its folds.
std::vector<int> SceneCloth::fold_hinges() const
{
    std::vector<int> hinges;
    for (const garment::FoldEdge& fold : folds_)
        hinges.push_back(fold.edge);
    return hinges;
}

void SceneCloth::add_folds(std::vector<std::shared_ptr<Energy>>& energies)
{
    if (folds_.empty())
        return;
    fold_lines_ = std::make_shared<garment::FoldLines>(*rest_, folds_, state_.positions, source_);
    energies.push_back(fold_lines_);
}

void SceneCloth::add_springs(std::vector<std::shared_ptr<Energy>>& energies)
{
    std::vector<garment::Springs::Spring> springs;
    for (const AttachmentConstraint& attachment : attachments_)
        if (attachment.stiffness())
            for (const int v : attachment.vertices())
                springs.push_back({v, *attachment.stiffness()});
    if (springs.empty())
        return;
    springs_ = std::make_shared<garment::Springs>(std::move(springs));
    energies.push_back(springs_);
}

void SceneCloth::add_sewing(std::vector<std::shared_ptr<Energy>>& energies) const
{
    std::vector<garment::Sewing::Thread> threads;
    for (const auto& [a, b] : state_.rest.lines)
        threads.push_back({a, b});
    if (!threads.empty())
        energies.push_back(std::make_shared<garment::Sewing>(
            std::move(threads), garment::Sewing::Settings{sewing_.stiffness, sewing_.max_force}));
}

void SceneCloth::add_loads(garment::DeviceLoads& loads, int first_vertex) const
{
    loads.add(*rest_, masses_, state_.fabric.damping, first_vertex);
}

garment::ClothModel SceneCloth::model() const
{
    const garment::Fabric& fabric = state_.fabric;
    garment::ClothModel cloth;
    cloth.masses = masses_;
    cloth.rest = rest_;
    cloth.stretch = {fabric.stretch_warp, fabric.stretch_weft, fabric.shear};
    cloth.bending = {fabric.bend_warp, fabric.bend_weft};
    return cloth;
}

void SceneCloth::begin_step(View<const Vec3> x, double dt, double t_t1)
{
    if (tacks_)
        tacks_->begin_step(t_t1, x);
    for (const FabricPart& part : parts_)
        if (part.membrane)
            part.membrane->begin_step(x, dt);
    if (bend_damping_)
        bend_damping_->begin_step(x, dt);
    if (fold_lines_)
        fold_lines_->begin_step(x);
    if (pressure_)
        pressure_->begin_step(x, overpressure_.at(t_t1));
    if (tension_)
        tension_->begin_step(x);
}

void SceneCloth::take(View<const Vec3> x) { state_.positions.assign(x.begin(), x.end()); }

void SceneCloth::forget()
{
    if (tension_)
        tension_->forget();
    if (fold_lines_)
        fold_lines_->restart(state_.positions);
}

std::vector<char> SceneCloth::fixed_in_world() const
{
    std::vector<char> attached(state_.positions.size(), 0);
    for (const AttachmentConstraint& attachment : attachments_)
        if (!attachment.stiffness() && !attachment.is_on_avatar())
            for (const int v : attachment.vertices())
                attached[v] = 1;
    return attached;
}

void SceneCloth::tie(double gap, const std::vector<Collider>& colliders,
                     const std::function<void(const std::string&)>& warn)
{
    for (AttachmentConstraint& attachment : attachments_) {
        attachment.tie(state_.positions, state_.triangles, gap + 0.5 * state_.fabric.thickness, colliders);
        const AttachmentConstraint::Farthest& far = attachment.farthest();
        if (!warn || far.distance <= kFar)
            continue;
        char distance[32];
        std::snprintf(distance, sizeof distance, "%.3g", 100.0 * far.distance);
        warn(attachment.location() + ": vertex " + std::to_string(state_.file_vertex(far.vertex)) + " of \"" +
             state_.name + "\" is attached to \"" + attachment.target_name() + "\" from " + distance +
             " cm away; move the selection to where the cloth lies on it");
    }
}

void SceneCloth::mark_fixed(double t_t1, View<unsigned char> fixed) const
{
    std::fill(fixed.begin(), fixed.end(), 0);
    for (const AttachmentConstraint& attachment : attachments_)
        if (!attachment.stiffness() && attachment.is_active_at(t_t1))
            for (const int v : attachment.vertices())
                fixed[v] = 1;
}

void SceneCloth::update_targets(double t_t1, const std::vector<Collider>& colliders, View<Vec3> targets)
{
    int next_spring = 0;
    for (AttachmentConstraint& attachment : attachments_) {
        const int count = int(attachment.vertices().size()), spring = next_spring;
        next_spring += attachment.stiffness() ? count : 0;
        if (!attachment.is_active_at(t_t1)) {
            for (int k = spring; k < next_spring; ++k)
                springs_->release(k);
            continue;
        }
        attachment.follow(t_t1, colliders);
        parallel_for(kCpu, "scenes/attachment_targets", count, [&](int k) {
            if (attachment.stiffness())
                springs_->hold(spring + k, attachment.target(k));
            else
                targets[attachment.vertices()[k]] = attachment.target(k);
        });
    }
}

void SceneCloth::accelerate(double dt, double t_t1, View<const Vec3> x, View<const Vec3> v,
                            View<Vec3> acceleration)
{
    const garment::FallDamped fall{gravity_, v, acceleration};
    const double decay = garment::FallDamped::decay(state_.fabric.damping, dt);
    parallel_for(kCpu, "scenes/accelerate", v.size(), [&](int i) { fall.at(i, decay); });
    if (!air_->is_active())
        return;
    if (gusts_.are_active()) {
        gusts_at_.resize(v.size());
        gusts_.sample(x, t_t1, gusts_at_);
    }
    air_->add_acceleration(x, v, masses_, wind_.velocity, dt, acceleration, gusts_at_);
}

bool SceneCloth::is_disturbed(double t) const
{
    const bool has_new_pressure = pressure_ && pressure_->overpressure() != overpressure_.at(t);
    return has_new_pressure || (tacks_ && tacks_->are_closing(t)) || wind_.velocity.norm() > 0.0 ||
           std::any_of(attachments_.begin(), attachments_.end(),
                       [&](const AttachmentConstraint& attachment) { return attachment.changes_at(t); });
}

} // namespace toile::scenes
