#include "scenes/world/start_pose.h"

#include "collision/repair/repair_start.h"
#include "core/base/stages.h"

namespace toile::scenes {

namespace {

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

/// Checks the start pose and repairs it if that is enabled and needed.
collision::StartReport check_and_repair(std::vector<collision::StartCloth>& starts,
                                        const std::vector<collision::ContactCollider>& bodies,
                                        bool may_repair)
{
    collision::StartReport report;
    {
        const StageScope stage("scenes/start_check");
        report = check_start(starts, bodies);
    }
    if (report.is_clean() || !may_repair)
        return report;
    const StageScope stage("scenes/start_repair");
    return repair_start(starts, bodies);
}

} // namespace

collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders)
{
    std::vector<collision::StartCloth> starts;
    starts.reserve(scene.cloths.size());
    for (const ClothGroup& group : groups)
        for (const SceneCloth& cloth : group.cloths())
            starts.push_back(start_of(scene, scene.cloths[starts.size()], cloth));
    std::vector<collision::ContactCollider> bodies;
    bodies.reserve(colliders.size());
    for (const Collider& collider : colliders)
        bodies.push_back(collider.contact_collider());

    collision::StartReport report = check_and_repair(starts, bodies, scene.contact.repair_start);
    auto start = starts.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i, ++start)
            if (report.was_repaired)
                group.place(i, start->positions);
    if (report.remaining(collision::StartDefect::Kind::Crossing) == 0)
        for (ClothGroup& group : groups)
            group.assume_no_crossings();
    return report;
}

} // namespace toile::scenes
