#include "scenes/start_pose.h"

#include <cmath>

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

std::string millimetres(double metres)
{
    const double tenths = std::round(1e4 * metres);
    return std::to_string(int(tenths) / 10) + "." + std::to_string(int(tenths) % 10) + " mm";
}

std::string per_cent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

} // namespace

StartReport repair_start_pose(const Scene& scene, std::vector<ClothBody>& cloths,
                              const std::vector<Obstacle>& obstacles)
{
    std::vector<StartCloth> starts;
    for (size_t i = 0; i < cloths.size(); ++i)
        starts.push_back(start_of(scene, scene.cloths[i], cloths[i]));
    std::vector<ContactPartner> bodies;
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

std::string summary_of(const StartReport& report)
{
    using Kind = StartPlace::Kind;
    if (report.places.empty())
        return "";
    std::string text = "start pose: " + std::to_string(report.vertices_inside()) + " vertices (" +
                       std::to_string(report.count(Kind::InsideBody)) +
                       " places, edges and faces included) inside bodies, up to " +
                       millimetres(report.deepest(Kind::InsideBody)) + " deep, and " +
                       std::to_string(report.count(Kind::Crossing)) + " crossings of cloth with cloth";
    if (!report.was_repaired)
        return text + "; not repaired";
    return text + "; repaired: " + std::to_string(report.remaining(Kind::InsideBody)) + " places and " +
           std::to_string(report.remaining(Kind::Crossing)) + " crossings remain, moved by " +
           millimetres(report.max_move) + " at most, edges strained by " + per_cent(report.rms_strain) +
           " (RMS), " + per_cent(report.max_strain) + " at most";
}

} // namespace toile
