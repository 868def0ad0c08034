#include "scenes/world/start_pose.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <numeric>

#include "collision/repair/repair_start.h"
#include "core/base/error.h"
#include "core/base/stages.h"
#include "scenes/world/contact_setup.h"

namespace toile::scenes {

namespace {

/// Limits of a repair: displacement [m], and strain that an edge in a hundred exceeds [-]. Cloth that needs
/// more does not fit its pose.
constexpr double kMaxMove = 0.05, kMaxStrain = 0.2;

collision::StartCloth start_of(const Scene& scene, const scene::Cloth& settings, const SceneCloth& cloth)
{
    collision::StartCloth start;
    start.triangles = cloth.state().triangles;
    start.positions = cloth.state().positions;
    start.fixed = cloth.fixed_in_world();
    start.layer = settings.layer;
    start.thickness = cloth.state().fabric.thickness;
    start.gap = scene.contact.gap + 0.5 * start.thickness;
    return start;
}

collision::StartCloth start_of(const Scene& scene, const SceneSoftBodies& bodies, int body)
{
    collision::StartCloth start;
    start.triangles = bodies.state(body).triangles;
    start.positions = bodies.state(body).positions;
    start.fixed = bodies.fixed_surface(body);
    start.layer = scene.soft_bodies[body].layer;
    start.thickness = start.gap = skin_of_body(scene);
    return start;
}

/// Checks the start pose and repairs it if that is enabled and needed.
collision::StartReport check_and_repair(std::vector<collision::StartCloth>& starts,
                                        const std::vector<collision::ContactCollider>& bodies,
                                        bool may_repair, const collision::RepairProgress& progress)
{
    collision::StartReport report;
    {
        const StageScope stage("scenes/start_check");
        report = check_start(starts, bodies);
    }
    if (report.is_clean() || !may_repair)
        return report;
    const StageScope stage("scenes/start_repair");
    return repair_start(starts, bodies, progress);
}

/// @throws InvalidInput for a cloth or soft body that the repair had to move or strain too much
void require_fit(const Scene& scene, const collision::StartReport& report)
{
    for (size_t c = 0; c < report.changes.size(); ++c) {
        const collision::StartReport::Change& change = report.changes[c];
        char reason[160];
        if (change.max_move > kMaxMove)
            std::snprintf(reason, sizeof reason, "vertex %d would have to move by %.0f mm (%.0f at most)",
                          change.vertex, 1e3 * change.max_move, 1e3 * kMaxMove);
        else if (change.strain_p99 > kMaxStrain)
            std::snprintf(reason, sizeof reason,
                          "1 %% of its edges would be strained by more than %.0f %% (%.0f at most)",
                          100.0 * change.strain_p99, 100.0 * kMaxStrain);
        else
            continue;
        const bool is_cloth = c < scene.cloths.size();
        throw InvalidInput(
            scene.source.string() + ": " + surface_of(scene, int(c)).quoted() +
            " does not fit its start pose: to leave bodies and other " +
            (is_cloth ? "cloth " : "soft bodies ") + reason + "; " +
            (is_cloth ? "let the avatar begin in the pose that the cloth was made for (\"preroll\": "
                        "{\"from_bind\": true}, or another \"start\"), or give another \"scale\", "
                        "\"translate\" or size; "
                      : "give another \"translate\" or \"scale\"; ") +
            "\"contact\": {\"repair_start\": false} leaves it as it is");
    }
}

using FixedBodies = std::vector<std::unique_ptr<collision::MeshCollider>>; ///< [soft bodies]

std::unique_ptr<collision::MeshCollider> fixed_body(const collision::StartCloth& surface)
{
    return std::make_unique<collision::MeshCollider>(
        MovingMesh{surface.triangles, surface.positions, surface.positions});
}

/// Those of some soft bodies that a body is near enough to, wherever a repair may move it.
std::vector<int> near_to(const collision::StartCloth& body, View<const int> others, const FixedBodies& fixed)
{
    const Bounds box = bounds(body.positions);
    std::vector<int> near;
    std::copy_if(others.begin(), others.end(), std::back_inserter(near), [&](int k) {
        const Bounds& other = fixed[k]->bounds();
        return (box.lower.array() - 2.0 * kMaxMove <= other.upper.array()).all() &&
               (other.lower.array() - 2.0 * kMaxMove <= box.upper.array()).all();
    });
    return near;
}

/// These soft bodies, after other bodies.
std::vector<collision::ContactCollider> followed_by(std::vector<collision::ContactCollider> bodies,
                                                    View<const int> numbers, const FixedBodies& fixed)
{
    bodies.reserve(bodies.size() + size_t(numbers.size()));
    for (const int k : numbers)
        bodies.push_back({fixed[k].get(), nullptr});
    return bodies;
}

/// Adds the defects of soft bodies that lie inside later ones, which have moved off what crosses them only.
/// @param order  in which they were repaired
void find_enclosed(const std::vector<collision::StartCloth>& soft_bodies, View<const int> order, int avatars,
                   const FixedBodies& fixed, collision::StartReport& report)
{
    for (int i = 0; i < order.size(); ++i) {
        const std::vector<int> near =
            near_to(soft_bodies[order[i]], order.subview(i + 1, order.size() - i - 1), fixed);
        if (near.empty())
            continue;
        const StageScope stage("scenes/start_check");
        for (collision::StartDefect& defect :
             check_start({soft_bodies[order[i]]}, followed_by({}, near, fixed)).defects) {
            if (defect.kind != collision::StartDefect::Kind::InsideBody)
                continue;
            defect.cloth = order[i];
            defect.other = avatars + near[defect.other];
            report.defects.push_back(defect);
        }
    }
}

/// Moves soft bodies off the avatars and off those of lower layers, of equal layers the earlier ones.
/// @param avatars  in contact; the report numbers them, and then the soft bodies
/// @param fixed    becomes the soft bodies where they are afterwards
collision::StartReport repair_soft_bodies(std::vector<collision::StartCloth>& soft_bodies,
                                          const std::vector<collision::ContactCollider>& avatars,
                                          bool may_repair, const collision::RepairProgress& progress,
                                          FixedBodies& fixed)
{
    const int count = int(soft_bodies.size()), avatar_count = int(avatars.size());
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return soft_bodies[a].layer < soft_bodies[b].layer; });
    std::vector<collision::StartReport> reports(count);
    fixed.resize(count);
    for (int i = 0; i < count; ++i) {
        const int body = order[i];
        std::vector<collision::StartCloth> one{soft_bodies[body]};
        const std::vector<int> near = near_to(one.front(), View<const int>(order).subview(0, i), fixed);
        reports[body] = check_and_repair(one, followed_by(avatars, near, fixed), may_repair,
                                         progress.part(double(i) / count, double(i + 1) / count));
        for (collision::StartDefect& defect : reports[body].defects) {
            defect.cloth = body;
            if (!defect.is_with_body())
                defect.other = body;
            else if (defect.other >= avatar_count)
                defect.other = avatar_count + near[defect.other - avatar_count];
        }
        soft_bodies[body] = std::move(one.front());
        fixed[body] = fixed_body(soft_bodies[body]);
    }
    collision::StartReport report;
    for (const collision::StartReport& of_body : reports)
        report.append(of_body);
    find_enclosed(soft_bodies, order, avatar_count, fixed, report);
    return report;
}

/// Moves the soft bodies, then cloth off them all.
/// @param bodies       avatars in contact
/// @param soft_bodies  their surfaces
collision::StartReport repair_bodies_then_cloth(std::vector<collision::StartCloth>& cloths,
                                                std::vector<collision::StartCloth>& soft_bodies,
                                                std::vector<collision::ContactCollider> bodies,
                                                bool may_repair, const collision::RepairProgress& progress)
{
    const double of_bodies = soft_bodies.empty() ? 0.0 : cloths.empty() ? 1.0 : 0.5;
    FixedBodies fixed;
    collision::StartReport of_soft_bodies =
        repair_soft_bodies(soft_bodies, bodies, may_repair, progress.part(0.0, of_bodies), fixed);
    for (collision::StartDefect& defect : of_soft_bodies.defects) {
        defect.cloth += int(cloths.size());
        if (!defect.is_with_body())
            defect.other += int(cloths.size());
    }
    if (cloths.empty())
        return of_soft_bodies;
    for (const auto& body : fixed)
        bodies.push_back({body.get(), nullptr});
    collision::StartReport report =
        check_and_repair(cloths, bodies, may_repair, progress.part(of_bodies, 1.0));
    report.append(of_soft_bodies);
    if (report.was_repaired)
        progress.update(1.0);
    return report;
}

/// Numbers bodies as the scene does.
/// @param bodies  avatars in contact; the defects number them, and then the soft bodies
void number_by_scene(const std::vector<const Collider*>& bodies, const std::vector<Collider>& colliders,
                     collision::StartReport& report)
{
    for (collision::StartDefect& defect : report.defects)
        if (defect.is_with_body())
            defect.other = defect.other < int(bodies.size())
                               ? int(bodies[defect.other] - colliders.data())
                               : defect.other - int(bodies.size()) + int(colliders.size());
}

/// Moves what the repair has moved.
void place(const std::vector<collision::StartCloth>& cloths,
           const std::vector<collision::StartCloth>& soft_bodies, std::vector<ClothGroup>& groups)
{
    auto cloth = cloths.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i, ++cloth)
            if (cloth->positions != group.cloths()[i].state().positions)
                group.place(i, cloth->positions);
    if (soft_bodies.empty())
        return;
    std::vector<std::vector<Vec3>> surfaces;
    surfaces.reserve(soft_bodies.size());
    for (const collision::StartCloth& body : soft_bodies)
        surfaces.push_back(body.positions);
    groups.front().place_soft_bodies(surfaces);
}

/// Surfaces of solids.
std::vector<collision::StartCloth> starts_of(const Scene& scene, const SceneSolids& solids)
{
    std::vector<collision::StartCloth> starts(solids.count());
    for (int i = 0; i < int(starts.size()); ++i) {
        starts[i].triangles = solids.state(i).triangles;
        starts[i].positions = solids.state(i).positions;
        starts[i].thickness = starts[i].gap = skin_of_body(scene);
    }
    return starts;
}

/// Lets the groups move off bodies what is too near to them.
/// @param near  vertices of cloths, then of soft bodies, then of solids
void unsettle(const std::vector<std::vector<int>>& near, std::vector<ClothGroup>& groups)
{
    auto of = near.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i, ++of)
            group.unsettle(i, *of);
    for (ClothGroup& group : groups)
        for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i, ++of)
            if (!of->empty())
                group.unsettle_soft_body(i);
    for (ClothGroup& group : groups)
        for (int i = 0; group.solids() && i < group.solids()->count(); ++i, ++of)
            if (!of->empty())
                group.unsettle_solid(i);
}

} // namespace

std::string NamedPart::quoted() const { return kind + (" \"" + name) + "\""; }

NamedPart surface_of(const Scene& scene, int number)
{
    const int cloths = int(scene.cloths.size());
    return number < cloths ? NamedPart{"cloth", scene.cloths[number].name}
                           : NamedPart{"soft body", scene.soft_bodies[number - cloths].name};
}

NamedPart body_of(const Scene& scene, int number)
{
    const int avatars = int(scene.avatars.size());
    return number < avatars ? NamedPart{"avatar", scene.avatars[number].name}
                            : NamedPart{"soft body", scene.soft_bodies[number - avatars].name};
}

collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders,
                                         const std::function<void(double)>& progress)
{
    std::vector<collision::StartCloth> cloths, soft_bodies;
    for (const ClothGroup& group : groups) {
        for (const SceneCloth& cloth : group.cloths())
            cloths.push_back(start_of(scene, scene.cloths[cloths.size()], cloth));
        for (int i = 0; group.soft_bodies() && i < group.soft_bodies()->count(); ++i)
            soft_bodies.push_back(start_of(scene, *group.soft_bodies(), i));
    }
    const std::vector<const Collider*> bodies = colliders_in_contact(scene, colliders);
    collision::StartReport report =
        repair_bodies_then_cloth(cloths, soft_bodies, contact_colliders(bodies), scene.contact.repair_start,
                                 collision::RepairProgress(progress));
    number_by_scene(bodies, colliders, report);
    require_fit(scene, report);
    for (const ClothGroup& group : groups)
        if (const SceneSolids* solids = group.solids())
            for (std::vector<int>& near : find_too_near(starts_of(scene, *solids), contact_colliders(bodies)))
                report.too_near.push_back(std::move(near));
    if (report.was_repaired)
        place(cloths, soft_bodies, groups);
    if (scene.contact.repair_start)
        unsettle(report.too_near, groups);
    using Kind = collision::StartDefect::Kind;
    if (report.remaining(Kind::Crossing) == 0 && report.remaining(Kind::CrossesBody) == 0)
        for (ClothGroup& group : groups)
            group.assume_no_crossings();
    return report;
}

} // namespace toile::scenes
