#include <algorithm>
#include <utility>

#include "core/base/long_work.h"
#include "core/linear/block_diagonal_solver.h"
#include "core/pd/cuda/body.h"
#include "core/pd/energy/sliced_energy.h"
#include "core/pd/newton/embedded_points.h"
#include "core/pd/step/body.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "garment/energy/air/cuda/loads.h"
#include "scenes/method/solver_choice.h"
#include "scenes/world/cloth_group.h"
#include "scenes/world/contact_setup.h"

/// Setup of a group from a scene: its unknowns, energies, solvers and contact.
namespace toile::scenes {

namespace {

/// Table options of one cloth's solver.
TableSource source_of_tables(const WorldOptions& options, const std::string& cloth)
{
    TableSource source;
    if (options.tables)
        source.store = options.tables;
    if (options.building)
        source.listener.progress = [building = options.building, cloth](double fraction) {
            return building(cloth, fraction);
        };
    source.listener.warn = options.warn;
    return source;
}

} // namespace

ClothGroup::ClothGroup(const Scene& scene, std::vector<SceneCloth> cloths, SceneBodies bodies,
                       const std::vector<Collider>& colliders, const WorldOptions& options,
                       const CudaSpace* space)
    : sleep_(scene.solver.sleep), cloths_(std::move(cloths)), solids_(std::move(bodies.solids)),
      soft_bodies_(std::move(bodies.soft_bodies)), first_{0}
{
    for (const SceneCloth& cloth : cloths_)
        first_.push_back(first_.back() + cloth.vertex_count());
    for (size_t i = 0; i < cloths_.size(); ++i)
        for (const Triangle& t : cloths_[i].state().triangles)
            triangles_.push_back(t + Triangle::Constant(first_[i]));
    first_solid_ = first_.back() + (soft_bodies_ ? soft_bodies_->surface_count() : 0);
    if (soft_bodies_)
        soft_bodies_->append_triangles(triangles_);
    if (solids_)
        solids_->append_triangles(first_solid_, triangles_);
    if (replaces_minimiser(scene.solver.method))
        body_ = options.baselines->make_body(scene.solver, start().positions, cloths_.front().model());
    else
        body_ = space != nullptr ? make_device_body(scene, options, *space) : make_body(scene, options);
    contact_ = make_contact(scene, colliders, space);
    if (solids_)
        rigid_contact_ = std::make_unique<RigidActiveSet>(*contact_, solids_->bodies(), first_solid_);
    if (soft_bodies_)
        surface_contact_ = std::make_unique<LeadingActiveSet>(
            rigid_contact_ ? static_cast<ActiveSetEnergy&>(*rigid_contact_) : *contact_,
            first_solid_ + (solids_ ? solids_->bodies().unknown_count() : 0), unknown_count());
    std::vector<garment::JointStrainLimit::Part> limits;
    for (size_t i = 0; i < cloths_.size(); ++i)
        limits.push_back({&cloths_[i].strain_limit(), first_[i], cloths_[i].vertex_count()});
    limits_ = std::make_unique<garment::JointStrainLimit>(std::move(limits));
    if (space != nullptr)
        limits_->on_device(*space); // otherwise the first step would upload it
    const size_t unknowns = body_->positions().size();
    fixed_.assign(unknowns, 0);
    targets_.assign(unknowns, Vec3::Zero());
    acceleration_.assign(loads_ ? 0 : unknowns, Vec3::Zero());
    if (solids_)
        for (int i = 0; i < solids_->count(); ++i)
            acceleration_[first_solid_ + 2 * i] = scene.gravity;
}

/// State of the unknowns at the start. begin_solids() completes that of solids.
ClothGroup::Start ClothGroup::start() const
{
    Start start;
    for (const SceneCloth& cloth : cloths_) {
        const std::vector<Vec3>& positions = cloth.state().positions;
        start.positions.insert(start.positions.end(), positions.begin(), positions.end());
        start.masses.insert(start.masses.end(), cloth.masses().begin(), cloth.masses().end());
    }
    start.positions.resize(unknown_count(), Vec3::Zero());
    start.velocities.resize(unknown_count(), Vec3::Zero());
    start.masses.resize(unknown_count(), 0.0);
    if (soft_bodies_)
        soft_bodies_->set_start(start.positions, start.velocities, start.masses);
    if (solids_) {
        const std::vector<double> masses = solids_->bodies().masses();
        std::copy(masses.begin(), masses.end(), start.masses.begin() + first_solid_);
    }
    return start;
}

/// All energies of every cloth.
std::vector<std::shared_ptr<Energy>> ClothGroup::make_energies(OuterMethod outer)
{
    std::vector<std::shared_ptr<Energy>> energies;
    for (size_t i = 0; i < cloths_.size(); ++i)
        for (auto& energy : cloths_[i].make_energies(outer))
            energies.push_back(
                cloths_.size() == 1 && !solids_ && !soft_bodies_
                    ? energy
                    : std::make_shared<SlicedEnergy>(energy, first_[i], cloths_[i].vertex_count()));
    if (soft_bodies_)
        for (auto& energy : soft_bodies_->energies())
            energies.push_back(energy);
    return energies;
}

/// Unknowns of the minimiser.
int ClothGroup::unknown_count() const
{
    if (soft_bodies_)
        return soft_bodies_->unknown_count();
    return first_solid_ + (solids_ ? solids_->bodies().unknown_count() : 0);
}

/// Projective dynamics on the CPU: every cloth and soft body keeps a separate global solver.
std::unique_ptr<PointMasses> ClothGroup::make_body(const Scene& scene, const WorldOptions& options)
{
    std::vector<BlockDiagonalSolver::Block> blocks;
    for (size_t i = 0; i < cloths_.size(); ++i) {
        const SceneCloth& cloth = cloths_[i];
        const ClothState& state = cloth.state();
        blocks.push_back(
            {consecutive_rows(first_[i], cloth.vertex_count()),
             make_global_solver(scene.solver.method, cloth.rest_shape(), {state.positions, state.triangles},
                                cloth.source(), source_of_tables(options, state.name), options.baselines)});
    }
    for (int i = 0; soft_bodies_ && i < soft_bodies_->count(); ++i)
        blocks.push_back({soft_bodies_->unknowns(i),
                          make_solver_of_volume(scene.solver.method, soft_bodies_->rest_positions(i),
                                                source_of_tables(options, soft_bodies_->state(i).name))});
    if (solids_)
        blocks.push_back({consecutive_rows(first_solid_, solids_->bodies().unknown_count()),
                          std::make_unique<DirectSolver>()});
    std::unique_ptr<GlobalSolver> solver;
    if (blocks.size() == 1)
        solver = std::move(blocks.front().solver);
    else
        solver = std::make_unique<BlockDiagonalSolver>(std::move(blocks));

    Body::Settings settings;
    const StepMethod method = step_method_of(scene);
    settings.tolerance = method.velocity_tolerance * scene.step_duration();
    settings.speed_tolerance = method.velocity_tolerance;
    settings.stop = scene.solver.stop;
    settings.integrator = method.integrator;
    settings.extent = soft_bodies_ ? Extent::Volume : Extent::Surface;
    settings.begins_by_local_global = method.substeps > 0;
    settings.max_iterations = method.max_iterations;
    settings.outer = method.outer;
    settings.contact_solve.preconditioner = scene.solver.contact_preconditioner;
    Start start = this->start();
    auto body = std::make_unique<Body>(
        std::move(start.positions),
        std::make_unique<System>(std::move(start.masses), make_energies(method.outer), std::move(solver)),
        settings);
    body->set_velocities(start.velocities);
    return body;
}

std::unique_ptr<DeviceSolver> ClothGroup::make_device_solver(scene::SolverMethod method,
                                                             const WorldOptions& options,
                                                             const CudaSpace& space) const
{
    if (is_baseline(method))
        return options.baselines->make_device_solver(method, space);
    std::vector<DeviceQuadratureSolver::Part> parts;
    for (const SceneCloth& cloth : cloths_)
        parts.push_back(
            {embedding_of(*cloth.rest_shape()), source_of_tables(options, cloth.state().name).listener});
    for (int i = 0; soft_bodies_ && i < soft_bodies_->count(); ++i)
        parts.push_back({embedded(soft_bodies_->rest_positions(i)),
                         source_of_tables(options, soft_bodies_->state(i).name).listener, kTablesOfVolumes,
                         soft_bodies_->unknowns(i)});
    return std::make_unique<DeviceQuadratureSolver>(space, std::move(parts),
                                                    source_of_tables(options, "").store);
}

/// Projective dynamics with the fields on a GPU. Equal cloths and soft bodies use the same tables.
std::unique_ptr<PointMasses> ClothGroup::make_device_body(const Scene& scene, const WorldOptions& options,
                                                          const CudaSpace& space)
{
    DeviceBody::Settings settings;
    const StepMethod method = step_method_of(scene);
    settings.tolerance = method.velocity_tolerance * scene.step_duration();
    settings.stop = scene.solver.stop;
    settings.integrator = method.integrator;
    settings.begins_by_local_global = method.substeps > 0;
    settings.max_iterations = method.max_iterations;
    settings.outer = method.outer;
    settings.speed_tolerance = method.velocity_tolerance;
    settings.extent = soft_bodies_ ? Extent::Volume : Extent::Surface;
    Start start = this->start();
    auto body = std::make_unique<DeviceBody>(
        space, start.positions,
        std::make_unique<System>(std::move(start.masses), make_energies(method.outer),
                                 make_device_solver(scene.solver.method, options, space)),
        settings);
    body->set_velocities(start.velocities);
    auto loads = make_loads(scene, space);
    loads_ = loads.get();
    body->accelerate_by(std::move(loads));
    return body;
}

std::unique_ptr<garment::DeviceLoads> ClothGroup::make_loads(const Scene& scene, const CudaSpace& space) const
{
    auto loads = std::make_unique<garment::DeviceLoads>(
        space, garment::DeviceLoads::Settings{scene.gravity, air_of(scene), scene.wind.velocity},
        gusts_of(scene.wind));
    for (size_t i = 0; i < cloths_.size(); ++i)
        cloths_[i].add_loads(*loads, first_[i]);
    if (soft_bodies_)
        soft_bodies_->add_loads(*loads);
    return loads;
}

std::unique_ptr<collision::Contact>
ClothGroup::make_contact(const Scene& scene, const std::vector<Collider>& colliders, const CudaSpace* space)
{
    const collision::Contact::Settings settings = contact_settings(scene);
    const std::vector<const Collider*> in_contact = colliders_in_contact(scene, colliders);
    if (in_contact.empty() && !settings.cloth_with_cloth)
        return nullptr;
    return std::make_unique<collision::Contact>(
        triangles_, surfaces(), contact_cloths(scene, cloths_, soft_bodies_.get(), solids_.get(), in_contact),
        contact_colliders(in_contact), settings, space);
}

std::vector<SceneCloth> make_cloths(const Scene& scene, const std::vector<Collider>& colliders,
                                    const WorldOptions& options)
{
    std::vector<SceneCloth> cloths;
    for (const scene::Cloth& cloth : scene.cloths) {
        const LongWork::Part part = LongWork::item(cloths.size(), scene.cloths.size());
        cloths.emplace_back(scene, cloth, colliders, options);
        LongWork::update(1.0);
    }
    return cloths;
}

std::vector<ClothGroup> make_groups(const Scene& scene, std::vector<SceneCloth> cloths, SceneBodies bodies,
                                    const std::vector<Collider>& colliders, const WorldOptions& options,
                                    const CudaSpace* space)
{
    const bool may_collide = contact_settings(scene).cloth_with_cloth;
    std::vector<std::vector<SceneCloth>> members;
    for (SceneCloth& cloth : cloths) {
        if (members.empty() || !may_collide)
            members.emplace_back();
        members.back().push_back(std::move(cloth));
    }
    if (bodies.any())
        members.resize(1); // one group of all cloths, if any
    std::vector<ClothGroup> groups;
    groups.reserve(members.size());
    for (auto& group : members)
        groups.emplace_back(scene, std::move(group), std::exchange(bodies, {}), colliders, options, space);
    return groups;
}

} // namespace toile::scenes
