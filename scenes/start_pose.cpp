#include "scenes/start_pose.h"

#include "collision/untangle/repair_start.h"
#include "core/backend/stages.h"

namespace toile {

namespace {

StartCloth start_of(const Scene& scene, const scene::Cloth& settings, const SceneCloth& cloth)
{
    StartCloth start;
    start.triangles = cloth.state().triangles;
    start.positions = cloth.state().positions;
    start.fixed = cloth.held_exactly();
    start.layer = settings.layer;
    start.thickness = cloth.state().fabric.thickness;
    start.gap = scene.contact.gap + 0.5 * start.thickness;
    return start;
}

/// Repairs where that is wanted and anything can be.
StartReport look_and_repair(std::vector<StartCloth>& starts, const std::vector<ContactPartner>& bodies,
                            bool may_repair)
{
    StartReport report;
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

StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                              const std::vector<Obstacle>& obstacles)
{
    std::vector<StartCloth> starts;
    starts.reserve(scene.cloths.size());
    for (const ClothGroup& group : groups)
        for (const SceneCloth& cloth : group.cloths())
            starts.push_back(start_of(scene, scene.cloths[starts.size()], cloth));
    std::vector<ContactPartner> bodies;
    bodies.reserve(obstacles.size());
    for (const Obstacle& obstacle : obstacles)
        bodies.push_back(obstacle.partner());

    StartReport report = look_and_repair(starts, bodies, scene.contact.repair_start);
    auto start = starts.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i, ++start)
            if (report.was_repaired)
                group.place(i, start->positions);
    if (report.remaining(StartPlace::Kind::Crossing) == 0)
        for (ClothGroup& group : groups)
            group.know_no_crossings();
    return report;
}

} // namespace toile
