#include "scenes/cloth_body.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/backend/parallel.h"
#include "core/linear/field.h"
#include "core/mesh/winding.h"
#include "core/pd/body.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/pattern/shapes.h"
#include "scenes/format/scene_fabric.h"
#include "scenes/method_choice.h"

namespace toile {

namespace {

/// Time [s] that cloth must be slow before it is put to rest: longer than the swing of a hem through its
/// turning point.
constexpr double kSleepDelay = 0.5;

ObjMesh faces_of(const TriangleMesh& mesh)
{
    ObjMesh faces;
    faces.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles)
        faces.polygons.push_back({t[0], t[1], t[2]});
    return faces;
}

/// The cloth in its own frame, before placement.
ObjMesh cut(const scene::Cloth& cloth)
{
    if (const auto* rectangle = std::get_if<scene::Rectangle>(&cloth.shape))
        return faces_of(cut_rectangle(rectangle->size, rectangle->resolution));
    if (const auto* disc = std::get_if<scene::Disc>(&cloth.shape))
        return faces_of(cut_disc(disc->radius, disc->resolution));
    if (const auto* skirt = std::get_if<scene::Skirt>(&cloth.shape))
        return faces_of(
            cut_skirt({skirt->waist_radius, skirt->hem_radius, skirt->length, skirt->resolution}));
    return read_obj(std::get<std::filesystem::path>(cloth.shape));
}

std::string source_of(const scene::Cloth& cloth)
{
    const auto* file = std::get_if<std::filesystem::path>(&cloth.shape);
    return file ? file->string() : "cloth \"" + cloth.name + "\"";
}

/// Reads or cuts the cloth, subdivides, sizes and turns it. Where it goes is left to the caller: equal cloths
/// in several places then have the same rest shape to the bit, and so share factors and tables.
/// @param turned_faces  out: faces whose winding had to be turned to agree with their neighbours
ObjMesh turned_mesh(const scene::Cloth& cloth, int& turned_faces)
{
    ObjMesh mesh = cut(cloth);
    turned_faces = make_windings_agree(mesh);
    require_usable(mesh.triangulated(), source_of(cloth));
    if (cloth.subdivide > 0)
        mesh = faces_of(subdivide(mesh.triangulated(), cloth.subdivide));
    const Mat3 turn = rotation_of(cloth.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = turn * (cloth.scale * scene::metres_per(cloth.unit) * p);
    return mesh;
}

Gusts::Settings gusts_of(const scene::Wind& wind)
{
    Gusts::Settings settings;
    settings.intensity = wind.turbulence;
    settings.seed = std::uint64_t(wind.seed);
    return settings;
}

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

ClothBody::ClothBody(const Scene& scene, const scene::Cloth& settings, const std::vector<Obstacle>& obstacles,
                     const WorldOptions& options)
    : gravity_(scene.gravity), wind_(scene.wind), gusts_(scene.wind.velocity, gusts_of(scene.wind)),
      sleep_(scene.solver.sleep)
{
    state_.name = settings.name;
    state_.fabric = fabric_of(scene, settings);
    state_.rest = turned_mesh(settings, state_.turned_faces);
    if (state_.turned_faces > 0 && options.warn)
        options.warn(source_of(settings) + ": turned " + std::to_string(state_.turned_faces) +
                     " faces that were wound against their neighbours");
    state_.triangles = state_.rest.triangulated().triangles;
    const std::vector<Vec3> unmoved = state_.rest.positions;
    for (Vec3& p : state_.rest.positions)
        p += settings.translate;
    state_.positions = state_.rest.positions;
    for (size_t i = 0; i < scene.attachments.size(); ++i)
        if (scene.attachments[i].cloth == settings.name) {
            const std::string place = scene.source.string() + ": attachments[" + std::to_string(i) + "]";
            require_method_holds(scene.solver.method, scene.attachments[i], place);
            holds_.emplace_back(scene.attachments[i], state_.positions, obstacles, place);
        }
    build(scene, unmoved, obstacles, options, source_of(settings),
          settings.grain_deg * std::numbers::pi / 180.0);
}

/// Body and contact. Stages that the scene rules out are not even built.
void ClothBody::build(const Scene& scene, const std::vector<Vec3>& unmoved,
                      const std::vector<Obstacle>& obstacles, const WorldOptions& options,
                      const std::string& source, double grain)
{
    const Fabric& fabric = state_.fabric;
    const bool is_flat = bounds(unmoved).upper.y() - bounds(unmoved).lower.y() < 1e-9;
    const auto rest = std::make_shared<const RestShape>(rest_shape_of_surface(
        {unmoved, state_.triangles}, is_flat ? Vec3::UnitX() : Vec3::UnitY(), grain, source));
    body_ = is_rival(scene.solver.method) ? make_rival(scene, rest) : make_body(scene, rest, options, source);

    air_ = std::make_unique<Aerodynamics>(
        rest, Aerodynamics::Settings{scene.air.density, scene.air.normal, scene.air.tangential});
    StrainLimit::Settings limit;
    limit.limit = fabric.strain_limit;
    strain_limit_ = std::make_unique<StrainLimit>(rest, limit, source, tension_);
    if (!obstacles.empty()) {
        std::vector<ContactPartner> partners;
        partners.reserve(obstacles.size());
        for (const Obstacle& obstacle : obstacles)
            partners.push_back(obstacle.partner());
        Contact::Settings contact;
        contact.gap = scene.contact.gap + 0.5 * fabric.thickness;
        contact.stiffness *= scene.contact.stiffness;
        contact_ =
            std::make_unique<Contact>(state_.triangles, state_.positions, std::move(partners), contact);
    }
    fixed_.assign(state_.positions.size(), 0);
    targets_.assign(state_.positions.size(), Vec3::Zero());
    acceleration_.assign(state_.positions.size(), Vec3::Zero());
}

std::vector<double> ClothBody::vertex_masses(const RestShape& rest) const
{
    std::vector<double> masses = rest.vertex_areas();
    for (double& mass : masses)
        mass *= state_.fabric.areal_density;
    return masses;
}

/// Projective dynamics: every term is an energy.
std::unique_ptr<PointMasses> ClothBody::make_body(const Scene& scene,
                                                  const std::shared_ptr<const RestShape>& rest,
                                                  const WorldOptions& options, const std::string& source)
{
    const Fabric& fabric = state_.fabric;
    const auto membrane = std::make_shared<Membrane>(
        rest, Membrane::Settings{fabric.stretch_warp, fabric.stretch_weft, fabric.shear}, source);
    std::vector<std::shared_ptr<Energy>> energies{membrane};
    if (fabric.bend_warp > 0.0 || fabric.bend_weft > 0.0) {
        const auto bending =
            std::make_shared<Bending>(rest, Bending::Settings{fabric.bend_warp, fabric.bend_weft}, source);
        bending->leave_to(hessian_diagonal(*membrane, rest->vertex_count()));
        energies.push_back(bending);
    }
    std::vector<Springs::Spring> springs;
    for (const Hold& hold : holds_)
        if (hold.stiffness())
            for (const int v : hold.vertices())
                springs.push_back({v, *hold.stiffness()});
    if (!springs.empty()) {
        springs_ = std::make_shared<Springs>(std::move(springs));
        energies.push_back(springs_);
    }

    StretchTension::Settings tension;
    tension.limit = fabric.strain_limit;
    tension.stiffness = std::max(fabric.stretch_warp, fabric.stretch_weft);
    tension_ = std::make_shared<StretchTension>(rest, tension);
    energies.push_back(tension_);

    Body::Settings settings;
    settings.tolerance = scene.solver.tolerance;
    settings.max_iterations = scene.solver.max_iterations;
    settings.outer = scene.solver.outer;
    auto solver = make_global_solver(scene.solver.method, rest, {state_.positions, state_.triangles}, source,
                                     source_of_tables(options, state_.name));
    return std::make_unique<Body>(
        state_.positions,
        std::make_unique<System>(vertex_masses(*rest), std::move(energies), std::move(solver)), settings);
}

std::unique_ptr<PointMasses> ClothBody::make_rival(const Scene& scene,
                                                   std::shared_ptr<const RestShape> rest) const
{
    const Fabric& fabric = state_.fabric;
    ClothModel cloth;
    cloth.masses = vertex_masses(*rest);
    cloth.rest = std::move(rest);
    cloth.stretch = {fabric.stretch_warp, fabric.stretch_weft, fabric.shear};
    cloth.bending = {fabric.bend_warp, fabric.bend_weft};
    return toile::make_rival(scene.solver, state_.positions, std::move(cloth));
}

void ClothBody::prepare(double dt, double t_t1)
{
    mark_fixed(t_t1);
    body_->prepare(dt, fixed_);
}

StepReport ClothBody::step(double dt, double t_t1, const std::vector<Obstacle>& obstacles)
{
    if (sleeps(t_t1, obstacles)) {
        StepReport report;
        report.steps = 1;
        return report;
    }
    hold(t_t1, obstacles);
    accelerate(dt, t_t1);
    if (tension_)
        tension_->begin_step(body_->positions());
    StepReport report = body_->step(dt, acceleration_, fixed_, targets_, contact_.get(), strain_limit_.get());
    state_.positions.assign(body_->positions().begin(), body_->positions().end());
    if (contact_) {
        report.contacts = contact_->active_count();
        report.min_gap = contact_->min_gap();
    }
    if (report.status == StepReport::Status::NonFinite)
        report.message = "cloth \"" + state_.name + "\": " + report.message;
    report.max_strain = strain_limit_->max_strain(body_->positions());

    // A solver whose every direction was refused leaves the cloth standing: that is no rest.
    const bool is_stuck = report.status == StepReport::Status::IterationLimit && report.iterations == 0;
    const bool is_slow = max_norm(body_->velocities()) < sleep_.speed;
    rest_time_ = is_slow && !is_stuck ? rest_time_ + dt : 0.0;
    return report;
}

void ClothBody::place(View<const Vec3> positions)
{
    body_->set_positions(positions);
    if (tension_)
        tension_->forget();
    if (contact_)
        contact_->forget();
    state_.positions.assign(positions.begin(), positions.end());
    rest_time_ = 0.0;
}

std::vector<char> ClothBody::held_exactly() const
{
    std::vector<char> held(state_.positions.size(), 0);
    for (const Hold& hold : holds_)
        if (!hold.stiffness())
            for (const int v : hold.vertices())
                held[v] = 1;
    return held;
}

/// Marks the vertices whose place is prescribed at time t_t1.
void ClothBody::mark_fixed(double t_t1)
{
    std::fill(fixed_.begin(), fixed_.end(), 0);
    for (const Hold& hold : holds_)
        if (!hold.stiffness() && hold.holds_at(t_t1))
            for (const int v : hold.vertices())
                fixed_[v] = 1;
}

/// Prescribes held vertices and moves the far ends of springs.
void ClothBody::hold(double t_t1, const std::vector<Obstacle>& obstacles)
{
    mark_fixed(t_t1);
    int spring = 0;
    for (const Hold& hold : holds_) {
        const bool holds = hold.holds_at(t_t1);
        for (int k = 0; k < int(hold.vertices().size()); ++k) {
            const Vec3 target = hold.target(k, t_t1, obstacles);
            if (hold.stiffness()) {
                if (holds)
                    springs_->set_target(spring, target);
                else
                    springs_->release(spring);
                ++spring;
            } else if (holds) {
                targets_[hold.vertices()[k]] = target;
            }
        }
    }
}

/// Gravity, the fabric's damping, and the air.
void ClothBody::accelerate(double dt, double t_t1)
{
    const double decay = state_.fabric.damping / (1.0 + dt * state_.fabric.damping);
    const View<const Vec3> v = body_->velocities();
    parallel_for(kCpu, "scenes/accelerate", v.size(),
                 [&](int i) { acceleration_[i] = gravity_ - decay * v[i]; });
    if (!air_->is_active())
        return;
    if (gusts_.are_active()) {
        gusts_at_.resize(v.size());
        gusts_.sample(body_->positions(), t_t1, gusts_at_);
    }
    air_->add_acceleration(body_->positions(), v, body_->masses(), wind_.velocity, dt, acceleration_,
                           gusts_at_);
}

/// True when nothing has moved this cloth for a while and nothing is about to.
bool ClothBody::sleeps(double t_t1, const std::vector<Obstacle>& obstacles)
{
    const bool disturbed =
        wind_.velocity.norm() > 0.0 ||
        std::any_of(obstacles.begin(), obstacles.end(),
                    [](const Obstacle& obstacle) { return obstacle.moved(); }) ||
        std::any_of(holds_.begin(), holds_.end(), [&](const Hold& hold) { return hold.changes_at(t_t1); });
    if (disturbed)
        rest_time_ = 0.0;
    return sleep_.enabled && rest_time_ > kSleepDelay;
}

} // namespace toile
