#include "scenes/contact_setup.h"

#include <algorithm>
#include <numeric>

#include "scenes/method_choice.h"

namespace toile {

namespace {

/// Friction that the scene gives for two names of fabrics, avatars or solids in particular.
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

/// Least thickness of the skin around solids [m], for scenes without a gap: what pushes needs a depth.
constexpr double kLeastSkin = 1e-4;

/// What a cloth or solid is called in friction pairs, and what it has by itself.
struct Rubbing {
    std::string name;
    std::optional<double> friction; ///< of a solid that gives one
};

std::vector<Rubbing> rubbing_of(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                const SceneSolids* solids)
{
    std::vector<Rubbing> all;
    all.reserve(cloths.size() + (solids ? solids->count() : 0));
    for (const SceneCloth& cloth : cloths)
        all.push_back({cloth_named(scene, cloth.state().name).fabric, std::nullopt});
    for (int i = 0; solids && i < solids->count(); ++i)
        all.push_back({scene.solids[i].name, scene.solids[i].friction});
    return all;
}

double friction_of(const Scene& scene, const Rubbing& a, const Rubbing& b)
{
    const double general = scene.contact.friction;
    const double own = a.friction && b.friction ? std::min(*a.friction, *b.friction)
                                                : a.friction.value_or(b.friction.value_or(general));
    return friction_between(scene.contact, a.name, b.name).value_or(own);
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
                                         const SceneSolids* solids, const std::vector<Obstacle>& obstacles)
{
    std::vector<ContactCloth> all;
    for (const SceneCloth& cloth : cloths) {
        ContactCloth& one = all.emplace_back();
        one.vertex_count = cloth.vertex_count();
        one.mass = std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
        one.thickness = cloth.state().fabric.thickness;
        one.gap = scene.contact.gap + 0.5 * one.thickness;
    }
    for (int i = 0; solids && i < solids->count(); ++i) {
        ContactCloth& one = all.emplace_back();
        one.vertex_count = int(solids->state(i).positions.size());
        one.mass = solids->bodies().shape(i).mass;
        one.is_rigid = true;
        one.thickness = std::max(scene.contact.gap, kLeastSkin);
        one.gap = one.thickness;
    }

    const std::vector<Rubbing> rubbing = rubbing_of(scene, cloths, solids);
    for (size_t i = 0; i < all.size(); ++i) {
        for (const Obstacle& obstacle : obstacles)
            all[i].partner_friction.push_back(
                friction_between(scene.contact, rubbing[i].name, obstacle.name())
                    .value_or(rubbing[i].friction.value_or(obstacle.friction())));
        for (const Rubbing& other : rubbing)
            all[i].cloth_friction.push_back(friction_of(scene, rubbing[i], other));
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
