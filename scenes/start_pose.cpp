#include "scenes/start_pose.h"

#include "collision/untangle/repair_start.h"
#include "core/backend/stages.h"

namespace toile {

namespace {

StartCloth start_of(const Scene& scene, const scene::Cloth& settings, const ClothBody& cloth)
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

StartReport repair_start_pose(const Scene& scene, std::vector<ClothBody>& cloths,
                              const std::vector<Obstacle>& obstacles)
{
    std::vector<StartCloth> starts;
    starts.reserve(cloths.size());
    for (size_t i = 0; i < cloths.size(); ++i)
        starts.push_back(start_of(scene, scene.cloths[i], cloths[i]));
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
    for (size_t i = 0; i < cloths.size(); ++i)
        cloths[i].place(starts[i].positions);
    return report;
}

} // namespace toile
