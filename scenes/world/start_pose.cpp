#include "scenes/world/start_pose.h"

#include <cstdio>

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

/// @throws InvalidInput for a cloth that the repair had to move or strain too much
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
        throw InvalidInput(scene.source.string() + ": cloth \"" + scene.cloths[c].name +
                           "\" does not fit its start pose: to leave bodies and other cloth " + reason +
                           "; let the avatar begin in the pose that the cloth was made for "
                           "(\"preroll\": {\"from_bind\": 1}, or another \"start\"), or give another "
                           "\"scale\", \"translate\" or size; \"contact\": {\"repair_start\": false} leaves "
                           "it as it is");
    }
}

} // namespace

collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders,
                                         const std::function<void(double)>& progress)
{
    std::vector<collision::StartCloth> starts;
    starts.reserve(scene.cloths.size());
    for (const ClothGroup& group : groups)
        for (const SceneCloth& cloth : group.cloths())
            starts.push_back(start_of(scene, scene.cloths[starts.size()], cloth));
    const std::vector<const Collider*> bodies = colliders_in_contact(scene, colliders);
    collision::StartReport report = check_and_repair(
        starts, contact_colliders(bodies), scene.contact.repair_start, collision::RepairProgress(progress));
    using Kind = collision::StartDefect::Kind;
    for (collision::StartDefect& defect : report.defects)
        if (defect.kind == Kind::InsideBody || defect.kind == Kind::CrossesBody)
            defect.other = int(bodies[defect.other] - colliders.data()); // number of the avatar
    require_fit(scene, report);
    auto start = starts.begin();
    for (ClothGroup& group : groups)
        for (int i = 0; i < int(group.cloths().size()); ++i, ++start)
            if (report.was_repaired)
                group.place(i, start->positions);
    if (report.remaining(Kind::Crossing) == 0 && report.remaining(Kind::CrossesBody) == 0)
        for (ClothGroup& group : groups)
            group.assume_no_crossings();
    return report;
}

} // namespace toile::scenes
