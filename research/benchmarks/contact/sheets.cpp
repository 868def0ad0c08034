#include "research/benchmarks/contact/sheets.h"

namespace toile::research::contact_stress {

namespace {

const char* const kFabric = "sheet";

} // namespace

scenes::Scene empty_scene(const std::string& name, double dt, int steps, double thickness, int threads)
{
    scenes::Scene scene;
    scene.source = scene.name = name;
    scene.fps = 1.0 / dt;
    scene.frames = 1 + steps;
    scene.solver.substeps = 1;
    scene.solver.method = scene::SolverMethod::Direct;
    scene.solver.sleep.enabled = false;
    scene.solver.threads = threads;
    scene.contact.repair_start = false;
    scene.air.density = 0.0; // air would stop cloth of 100 m/s within a step
    scene.fabrics[kFabric].thickness = thickness;
    return scene;
}

std::string add_sheet(scenes::Scene& scene, double side, const Vec3& translate, double rotate_deg)
{
    scene::Cloth cloth;
    cloth.name = "sheet" + std::to_string(scene.cloths.size());
    cloth.fabric = kFabric;
    cloth.shape = scene::Rectangle{Vec2(side, side), kEdge};
    cloth.translate = translate;
    cloth.rotate_deg = Vec3(0.0, rotate_deg, 0.0);
    scene.cloths.push_back(cloth);
    return cloth.name;
}

} // namespace toile::research::contact_stress
