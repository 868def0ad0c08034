#include "scenes/contact_setup.h"

#include <algorithm>

#include "scenes/method_choice.h"

namespace toile {

namespace {

/// Friction that the scene gives for two names of fabrics or avatars in particular.
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

} // namespace

Contact::Settings contact_settings(const Scene& scene)
{
    Contact::Settings settings;
    settings.stiffness *= scene.contact.stiffness;
    settings.cloth_with_cloth = scene.contact.self && !is_rival(scene.solver.method);
    return settings;
}

std::vector<ContactCloth> contact_cloths(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                         const std::vector<Obstacle>& obstacles)
{
    std::vector<ContactCloth> all;
    for (const SceneCloth& cloth : cloths) {
        const std::string& fabric = cloth_named(scene, cloth.state().name).fabric;
        ContactCloth& one = all.emplace_back();
        one.vertex_count = cloth.vertex_count();
        one.thickness = cloth.state().fabric.thickness;
        one.gap = scene.contact.gap + 0.5 * one.thickness;
        for (const Obstacle& obstacle : obstacles)
            one.partner_friction.push_back(
                friction_between(scene.contact, fabric, obstacle.name()).value_or(obstacle.friction()));
        for (const SceneCloth& other : cloths)
            one.cloth_friction.push_back(
                friction_between(scene.contact, fabric, cloth_named(scene, other.state().name).fabric)
                    .value_or(scene.contact.friction));
    }
    return all;
}

std::vector<ContactPartner> contact_partners(const std::vector<Obstacle>& obstacles)
{
    std::vector<ContactPartner> partners;
    partners.reserve(obstacles.size());
    for (const Obstacle& obstacle : obstacles)
        partners.push_back(obstacle.partner());
    return partners;
}

} // namespace toile
