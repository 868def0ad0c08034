#include "scenes/world/bodies/scene_soft_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/point_text.h"
#include "garment/energy/air/cuda/loads.h"
#include "scenes/colliders/select_vertices.h"
#include "scenes/colliders/vertex_owner.h"
#include "scenes/surfaces/load_cloth.h"
#include "volume/energy/harmonic.h"
#include "volume/mesh/vertex_order.h"

namespace toile::scenes {

SceneSoftBodies::SceneSoftBodies(const Scene& scene, const std::vector<Collider>& colliders,
                                 int first_surface, int between)
    : gravity_(scene.gravity), between_(between), first_inner_(first_surface + between)
{
    std::vector<LoadedSoftBody> loaded = load_soft_bodies(scene.soft_bodies, colliders);
    for (const LoadedSoftBody& body : loaded)
        first_inner_ += int(body.surface.positions.size());

    volume::TetMesh all; // by unknowns
    std::vector<volume::Lame> lame;
    int next_surface = first_surface, next_inner = first_inner_;
    for (size_t i = 0; i < loaded.size(); ++i) {
        const scene::SoftBody& settings = scene.soft_bodies[i];
        volume::require_no_slivers(loaded[i].rest, loaded[i].source); // with the numbers of its own
        Body& body = bodies_.emplace_back();
        body.first_surface = next_surface;
        body.first_inner = next_inner;
        body.density = settings.density;
        body.damping = settings.damping;
        body.sound_speed = std::sqrt(settings.young / settings.density);
        body.velocity = settings.velocity;
        body.surface = std::move(loaded[i].surface);
        body.rest = std::move(loaded[i].rest);
        volume::sort_by_vertex(body.rest.tets);
        body.positions = std::move(loaded[i].positions);
        body.render = std::move(loaded[i].render);
        next_surface += body.surface_count();
        next_inner += body.vertex_count() - body.surface_count();
        for (const volume::Tet& tet : body.rest.tets)
            all.tets.push_back(body.unknowns(tet));
        lame.resize(all.tets.size(),
                    volume::ElasticMaterial{settings.young, settings.poisson}.lame(loaded[i].source));
        const std::string core_location =
            scene.source.string() + ": soft_bodies[" + std::to_string(i) + "].core";
        if (settings.core)
            body.core.emplace(*settings.core, body.positions, colliders, core_location);
        add_attachments(scene, colliders, loaded[i].of_file, body);
        require_one_owner(body, core_location);
    }
    all.positions.resize(next_inner, Vec3::Zero());
    for (const Body& body : bodies_)
        for (int v = 0; v < body.vertex_count(); ++v)
            all.positions[body.unknown(v)] = body.rest.positions[v];
    rest_ = std::make_shared<volume::RestTets>(rest_tets(all, "soft bodies"));
    elastic_ = std::make_shared<volume::ElasticSolid>(rest_, std::move(lame));
    add_springs();
}

/// @param of_file  see LoadedSoftBody
void SceneSoftBodies::add_attachments(const Scene& scene, const std::vector<Collider>& colliders,
                                      View<const int> of_file, Body& body)
{
    for (size_t i = 0; i < scene.attachments.size(); ++i) {
        const scene::Attachment& attachment = scene.attachments[i];
        if (attachment.cloth != body.surface.name)
            continue;
        const std::string location = attachment_location(scene, i);
        scene::Selection select = attachment.select;
        if (auto* numbers = std::get_if<std::vector<int>>(&select.by))
            for (int& v : *numbers) {
                if (v >= of_file.size())
                    throw InvalidInput(location + ".select.vertices: vertex " + std::to_string(v) +
                                       " is out of range; \"" + body.surface.name + "\" has vertices 0 to " +
                                       std::to_string(of_file.size() - 1));
                v = of_file[v];
            }
        std::vector<int> vertices = select_vertices(select, body.positions, colliders);
        if (vertices.empty())
            throw InvalidInput(location + ": selects no vertex of \"" + body.surface.name +
                               "\"; move the selection to where the body starts");
        body.attachments.emplace_back(attachment, std::move(vertices), body.positions, colliders, mass(body),
                                      location);
    }
}

void SceneSoftBodies::require_one_owner(const Body& body, const std::string& core_location)
{
    std::vector<VertexOwner> owners;
    if (body.core)
        owners.push_back({core_location, body.core->vertices(), false});
    for (const AttachmentConstraint& attachment : body.attachments)
        owners.push_back(owner_of(attachment));
    scenes::require_one_owner(owners, body.surface.name, [&](int v) {
        return "the vertex at " + point_text(body.positions[size_t(v)]) + " m";
    });
}

std::vector<int> SceneSoftBodies::stiff_parts(double dt) const
{
    std::vector<int> part;
    for (int i = 0; i < count(); ++i) {
        const Bounds box = bounds(bodies_[i].positions);
        if ((box.upper - box.lower).maxCoeff() > bodies_[i].sound_speed * dt)
            continue;
        part.resize(unknown_count(), -1);
        for (const int unknown : unknowns(i))
            part[unknown] = i;
    }
    return part;
}

int SceneSoftBodies::body_of(int unknown) const
{
    int body = 0;
    while (body + 1 < count() && unknown >= (unknown < first_inner_ ? bodies_[body + 1].first_surface
                                                                    : bodies_[body + 1].first_inner))
        ++body;
    return body;
}

/// Of a body [kg].
double SceneSoftBodies::mass(const Body& body)
{
    double sum = 0.0; // [m^3]
    for (const volume::Tet& tet : body.rest.tets)
        sum += volume::volume_of(tet, body.rest.positions);
    return body.density * sum;
}

int SceneSoftBodies::inverted_count(int body, View<const Vec3> x) const
{
    const Body& of = bodies_[body];
    // Rest volumes are positive, so the volume has the sign of det F.
    return int(std::count_if(of.rest.tets.begin(), of.rest.tets.end(), [&](const volume::Tet& tet) {
        return !(volume::volume_of(of.unknowns(tet), x) > 0.0);
    }));
}

std::vector<Vec3> SceneSoftBodies::render_positions(int body, View<const Vec3> x) const
{
    const Body& of = bodies_[body];
    std::vector<Vec3> of_mesh;
    of_mesh.reserve(of.positions.size());
    for (int v = 0; v < of.vertex_count(); ++v)
        of_mesh.push_back(x[of.unknown(v)]);
    return of.render->embedding.at(of_mesh);
}

void SceneSoftBodies::add_springs()
{
    std::vector<garment::Springs::Spring> springs;
    for (const Body& body : bodies_)
        for (const AttachmentConstraint& attachment : body.attachments)
            if (attachment.stiffness())
                for (const int v : attachment.vertices())
                    springs.push_back({body.unknown(v), *attachment.stiffness()});
    if (!springs.empty())
        springs_ = std::make_shared<garment::Springs>(springs);
}

std::vector<int> SceneSoftBodies::unknowns(int body) const
{
    std::vector<int> unknowns;
    unknowns.reserve(bodies_[body].positions.size());
    for (int v = 0; v < bodies_[body].vertex_count(); ++v)
        unknowns.push_back(bodies_[body].unknown(v));
    return unknowns;
}

std::vector<std::shared_ptr<Energy>> SceneSoftBodies::energies() const
{
    std::vector<std::shared_ptr<Energy>> energies{elastic_};
    if (springs_)
        energies.push_back(springs_);
    return energies;
}

void SceneSoftBodies::set_start(View<Vec3> positions, View<Vec3> velocities, View<double> masses) const
{
    const std::vector<double> volumes = rest_->vertex_volumes();
    for (const Body& body : bodies_)
        for (int v = 0; v < body.vertex_count(); ++v) {
            const int i = body.unknown(v);
            positions[i] = body.positions[v];
            velocities[i] = body.velocity;
            masses[i] = body.density * volumes[i];
        }
}

/// Visits the vertices of the core and of exact attachments that are wanted.
template <typename IsWanted, typename Visit>
void SceneSoftBodies::visit_held(const Body& body, const IsWanted& is_wanted, const Visit& visit)
{
    if (body.core)
        for (const int v : body.core->vertices())
            visit(v);
    for (const AttachmentConstraint& attachment : body.attachments)
        if (!attachment.stiffness() && is_wanted(attachment))
            for (const int v : attachment.vertices())
                visit(v);
}

/// [vertices] Nonzero for those that are held now or later.
std::vector<char> SceneSoftBodies::held(const Body& body)
{
    std::vector<char> held(body.positions.size(), 0);
    visit_held(
        body, [](const AttachmentConstraint&) { return true; }, [&](int v) { held[v] = 1; });
    return held;
}

std::vector<char> SceneSoftBodies::fixed_surface(int body) const
{
    std::vector<char> fixed = held(bodies_[body]);
    fixed.resize(bodies_[body].surface_count());
    return fixed;
}

void SceneSoftBodies::place(int body, View<const Vec3> surface, View<Vec3> x)
{
    Body& of = bodies_[body];
    std::vector<char> is_given = held(of);
    std::fill_n(is_given.begin(), of.surface_count(), 1);
    std::vector<Vec3> move(of.positions.size(), Vec3::Zero());
    for (int v = 0; v < of.surface_count(); ++v)
        move[v] = surface[v] - of.positions[v];
    volume::extend_harmonically(of.rest, is_given, move);
    for (int v = 0; v < of.vertex_count(); ++v) {
        of.positions[v] = v < of.surface_count() ? surface[v] : Vec3(of.positions[v] + move[v]);
        x[of.unknown(v)] = of.positions[v];
    }
    of.surface.positions.assign(surface.begin(), surface.end());
    if (of.render)
        of.render->state.positions = render_positions(body, x);
}

void SceneSoftBodies::append_triangles(std::vector<Triangle>& triangles) const
{
    for (const Body& body : bodies_)
        for (const Triangle& t : body.surface.triangles)
            triangles.push_back(t + Triangle::Constant(body.first_surface));
}

void SceneSoftBodies::tie(const std::vector<Collider>& colliders)
{
    // Not lifted to the skin: a body may enclose what it is attached to.
    constexpr double kAnywhere = -std::numeric_limits<double>::infinity();
    for (Body& body : bodies_)
        for (AttachmentConstraint& attachment : body.attachments)
            attachment.tie(body.positions, {}, kAnywhere, colliders);
}

void SceneSoftBodies::mark_fixed(double t_t1, View<unsigned char> fixed) const
{
    for (const Body& body : bodies_) {
        for (int v = 0; v < body.vertex_count(); ++v)
            fixed[body.unknown(v)] = 0;
        visit_held(
            body, [&](const AttachmentConstraint& attachment) { return attachment.is_active_at(t_t1); },
            [&](int v) { fixed[body.unknown(v)] = 1; });
    }
}

bool SceneSoftBodies::have_cores_jumped(const std::vector<Collider>& colliders, double dt) const
{
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.core && body.core->has_jumped(colliders, dt); });
}

void SceneSoftBodies::update_targets(double t_t1, const std::vector<Collider>& colliders, View<Vec3> targets)
{
    for (Body& body : bodies_)
        if (body.core) {
            body.core->follow(colliders);
            for (int k = 0; k < int(body.core->vertices().size()); ++k)
                targets[body.unknown(body.core->vertices()[k])] = body.core->target(k);
        }
    int spring = 0;
    for (Body& body : bodies_)
        for (AttachmentConstraint& attachment : body.attachments) {
            const bool is_active = attachment.is_active_at(t_t1);
            if (is_active)
                attachment.follow(t_t1, colliders);
            for (int k = 0; k < int(attachment.vertices().size()); ++k)
                if (!attachment.stiffness()) {
                    if (is_active)
                        targets[body.unknown(attachment.vertices()[k])] = attachment.target(k);
                } else if (is_active)
                    springs_->hold(spring++, attachment.target(k));
                else
                    springs_->release(spring++);
        }
}

void SceneSoftBodies::add_loads(garment::DeviceLoads& loads) const
{
    for (int i = 0; i < count(); ++i)
        loads.add_without_air(unknowns(i), bodies_[i].damping);
}

void SceneSoftBodies::accelerate(double dt, View<const Vec3> v, View<Vec3> acceleration) const
{
    const garment::FallDamped fall{gravity_, v, acceleration};
    for (const Body& body : bodies_) {
        const double decay = garment::FallDamped::decay(body.damping, dt);
        parallel_for(kCpu, "scenes/accelerate", body.vertex_count(),
                     [&](int i) { fall.at(body.unknown(i), decay); });
    }
}

bool SceneSoftBodies::is_disturbed(double t) const
{
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
        return std::any_of(body.attachments.begin(), body.attachments.end(),
                           [&](const AttachmentConstraint& attachment) { return attachment.changes_at(t); });
    });
}

} // namespace toile::scenes
