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

    StartReport report;
    {
        const StageScope stage("scenes/start_check");
        report = check_start(starts, bodies);
    }
    if (report.is_clean() || !scene.contact.repair_start)
        return report;
    const StageScope stage("scenes/start_repair");
    report = repair_start(starts, bodies);
    auto start = starts.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i)
            group.place(i, (start++)->positions);
    return report;
}

} // namespace toile
