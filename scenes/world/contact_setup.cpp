#include "scenes/world/contact_setup.h"

#include <algorithm>
#include <numeric>

#include "scenes/format/scene_fabric.h"
#include "scenes/method/solver_choice.h"

namespace toile::scenes {

namespace {

/// Coefficient of the friction pair of two fabrics or bodies, if the scene has one.
std::optional<double> friction_between(const scene::Contact& contact, const std::string& a,
                                       const std::string& b)
{
    for (const scene::FrictionPair& pair : contact.friction_pairs)
        if ((pair.between[0] == a && pair.between[1] == b) || (pair.between[0] == b && pair.between[1] == a))
            return pair.friction;
    return std::nullopt;
}

const scene::Cloth& cloth_named(const Scene& scene, const std::string& name)
{
    return *std::find_if(scene.cloths.begin(), scene.cloths.end(),
                         [&](const scene::Cloth& cloth) { return cloth.name == name; });
}

/// Minimum contact thickness around soft bodies and solids [m], for scenes without a gap: the contact force
/// needs a depth.
constexpr double kMinSkin = 1e-4;

/// Name of a cloth's fabric, of a soft body or solid in friction pairs, and its default coefficient.
struct FrictionBody {
    std::string name;
    std::optional<double> friction; ///< of a soft body or solid with a coefficient
};

std::vector<FrictionBody> friction_bodies_of(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                             const SceneSoftBodies* soft_bodies, const SceneSolids* solids)
{
    std::vector<FrictionBody> all;
    all.reserve(cloths.size());
    for (const SceneCloth& cloth : cloths)
        all.push_back({cloth_named(scene, cloth.state().name).fabric, std::nullopt});
    for (int i = 0; soft_bodies && i < soft_bodies->count(); ++i)
        all.push_back({scene.soft_bodies[i].name, scene.soft_bodies[i].friction});
    for (int i = 0; solids && i < solids->count(); ++i)
        all.push_back({scene.solids[i].name, scene.solids[i].friction});
    return all;
}

double friction_of(const Scene& scene, const FrictionBody& a, const FrictionBody& b)
{
    const double general = scene.contact.friction;
    const double default_friction = a.friction && b.friction
                                        ? std::min(*a.friction, *b.friction)
                                        : a.friction.value_or(b.friction.value_or(general));
    return friction_between(scene.contact, a.name, b.name).value_or(default_friction);
}

} // namespace

collision::Contact::Settings contact_settings(const Scene& scene)
{
    collision::Contact::Settings settings;
    settings.stiffness *= scene.contact.stiffness;
    settings.cloth_with_cloth = scene.contact.self && !replaces_minimiser(scene.solver.method);
    return settings;
}

std::vector<collision::ContactCloth> contact_cloths(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                                    const SceneSoftBodies* soft_bodies,
                                                    const SceneSolids* solids,
                                                    const std::vector<const Collider*>& colliders)
{
    std::vector<collision::ContactCloth> all;
    for (const SceneCloth& cloth : cloths) {
        collision::ContactCloth& one = all.emplace_back();
        one.vertex_count = cloth.vertex_count();
        one.mass = std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
        one.thickness = cloth.state().fabric.thickness;
        one.vertex_thickness = cloth.state().vertex_thickness;
        one.gap = scene.contact.gap + 0.5 * one.thickness;
    }
    const auto add_body = [&](const ClothState& surface, double mass) {
        collision::ContactCloth& one = all.emplace_back();
        one.vertex_count = int(surface.positions.size());
        one.mass = mass;
        one.thickness = skin_of_body(scene);
        one.gap = one.thickness;
    };
    for (int i = 0; soft_bodies && i < soft_bodies->count(); ++i)
        add_body(soft_bodies->state(i), soft_bodies->mass(i));
    for (int i = 0; solids && i < solids->count(); ++i) {
        add_body(solids->state(i), solids->bodies().shape(i).mass);
        all.back().is_rigid = true;
    }

    const std::vector<FrictionBody> friction_bodies = friction_bodies_of(scene, cloths, soft_bodies, solids);
    for (size_t i = 0; i < all.size(); ++i) {
        for (const Collider* collider : colliders)
            all[i].collider_friction.push_back(
                friction_between(scene.contact, friction_bodies[i].name, collider->name())
                    .value_or(friction_bodies[i].friction.value_or(collider->friction())));
        for (const FrictionBody& other : friction_bodies)
            all[i].cloth_friction.push_back(friction_of(scene, friction_bodies[i], other));
    }
    return all;
}

double skin_of_body(const Scene& scene) { return std::max(scene.contact.gap, kMinSkin); }

double room_for_cloth(const Scene& scene)
{
    double thickness = 0.0;
    for (const scene::Cloth& cloth : scene.cloths)
        thickness = std::max(thickness, fabric_of(scene, cloth).thickness);
    return collision::room_of(scene.contact.gap, thickness);
}

std::vector<const Collider*> colliders_in_contact(const Scene& scene, const std::vector<Collider>& colliders)
{
    std::vector<const Collider*> result;
    for (const Collider& collider : colliders)
        if (replacement_of(scene, collider.name()) == nullptr)
            result.push_back(&collider);
    return result;
}

std::vector<collision::ContactCollider> contact_colliders(const std::vector<const Collider*>& colliders)
{
    std::vector<collision::ContactCollider> result;
    result.reserve(colliders.size());
    for (const Collider* collider : colliders)
        result.push_back(collider->contact_collider());
    return result;
}

} // namespace toile::scenes
