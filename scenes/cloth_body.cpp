#include "scenes/cloth_body.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/backend/parallel.h"
#include "core/linear/field.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/pattern/shapes.h"
#include "scenes/format/scene_fabric.h"
#include "scenes/global_solver_choice.h"

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

/// Reads or cuts the cloth, subdivides and places it.
ObjMesh placed_mesh(const scene::Cloth& cloth)
{
    ObjMesh mesh = cut(cloth);
    require_usable(mesh.triangulated(), source_of(cloth));
    if (cloth.subdivide > 0)
        mesh = faces_of(subdivide(mesh.triangulated(), cloth.subdivide));
    const Mat3 turn = rotation_of(cloth.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = cloth.translate + turn * (cloth.scale * scene::metres_per(cloth.unit) * p);
    return mesh;
}

Gusts::Settings gusts_of(const scene::Wind& wind)
{
    Gusts::Settings settings;
    settings.intensity = wind.turbulence;
    settings.seed = std::uint64_t(wind.seed);
    return settings;
}

} // namespace

ClothBody::ClothBody(const Scene& scene, const scene::Cloth& settings, const std::vector<Obstacle>& obstacles)
    : gravity_(scene.gravity), wind_(scene.wind), gusts_(scene.wind.velocity, gusts_of(scene.wind)),
      sleep_(scene.solver.sleep)
{
    state_.name = settings.name;
    state_.fabric = fabric_of(scene, settings);
    state_.rest = placed_mesh(settings);
    state_.positions = state_.rest.positions;
    state_.triangles = state_.rest.triangulated().triangles;
    for (size_t i = 0; i < scene.attachments.size(); ++i)
        if (scene.attachments[i].cloth == settings.name)
            holds_.emplace_back(scene.attachments[i], state_.positions, obstacles,
                                scene.source.string() + ": attachments[" + std::to_string(i) + "]");
    build(scene, obstacles, source_of(settings), settings.grain_deg * std::numbers::pi / 180.0);
}

/// Energies, body and contact. Stages that the scene rules out are not even built.
void ClothBody::build(const Scene& scene, const std::vector<Obstacle>& obstacles, const std::string& source,
                      double grain)
{
    const Fabric& fabric = state_.fabric;
    const bool is_flat = bounds(state_.positions).upper.y() - bounds(state_.positions).lower.y() < 1e-9;
    const auto rest = std::make_shared<const RestShape>(rest_shape_of_surface(
        {state_.positions, state_.triangles}, is_flat ? Vec3::UnitX() : Vec3::UnitY(), grain, source));

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

    std::vector<double> masses = rest->vertex_areas();
    for (double& mass : masses)
        mass *= fabric.areal_density;
    Body::Settings settings;
    settings.tolerance = scene.solver.tolerance;
    settings.max_iterations = scene.solver.max_iterations;
    settings.outer = scene.solver.outer;
    body_ = std::make_unique<Body>(state_.positions,
                                   std::make_unique<System>(std::move(masses), std::move(energies),
                                                            make_global_solver(scene.solver.method, *rest)),
                                   settings);

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

StepReport ClothBody::step(double dt, double t_t1, const std::vector<Obstacle>& obstacles)
{
    if (sleeps(t_t1, obstacles)) {
        StepReport report;
        report.steps = 1;
        return report;
    }
    hold(t_t1, obstacles);
    accelerate(dt, t_t1);
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
    rest_time_ = max_norm(body_->velocities()) < sleep_.speed ? rest_time_ + dt : 0.0;
    return report;
}

void ClothBody::place(View<const Vec3> positions)
{
    body_->set_positions(positions);
    tension_->forget();
    if (contact_)
        contact_->forget();
    state_.positions.assign(positions.begin(), positions.end());
    rest_time_ = 0.0;
}

/// Prescribes held vertices and moves the far ends of springs.
void ClothBody::hold(double t_t1, const std::vector<Obstacle>& obstacles)
{
    std::fill(fixed_.begin(), fixed_.end(), 0);
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
                fixed_[hold.vertices()[k]] = 1;
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
    air_->add_acceleration(body_->positions(), v, body_->system().masses(), wind_.velocity, dt, acceleration_,
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
