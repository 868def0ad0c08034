#include "research/benchmarks/sheet/settings.h"

namespace toile::research::sheet {

namespace {

/// Strain limit that hanging cloth never reaches [-]: no limit.
constexpr double kNoLimit = 10.0;

/// Tolerances [m] of converged references, and of settings that end steps by the iteration limit.
constexpr double kReferenceTolerance = 1e-7;
constexpr double kCheckTolerance = 3e-8;

constexpr int kReferenceIterations = 3000;

const char* const kFabric = "sheet cotton";

} // namespace

Sheet full_sheet() { return {}; }

Sheet quick_sheet() { return {30, 30, {8, 15, 30}}; }

std::vector<Setting> ladder()
{
    std::vector<Setting> settings{
        {"reference", kReferenceTolerance, kReferenceIterations, false, true},
        {"second reference", kCheckTolerance, kReferenceIterations, false, false},
        {"reference with strain limit", kReferenceTolerance, kReferenceIterations, true, true}};
    for (const int iterations : {3, 5, 8, 12, 20, 50})
        settings.push_back({std::to_string(iterations) + " iterations", kReferenceTolerance, iterations});
    for (const auto& [name, tolerance] : {std::pair("3e-4", 3e-4), {"2e-4", 2e-4}, {"1e-4", 1e-4}})
        settings.push_back({std::string("tolerance ") + name + " m", tolerance});
    settings.push_back({"tolerance 1e-4 m with strain limit", 1e-4, 300, true});
    return settings;
}

bool is_timed(const Setting& setting) { return setting.max_iterations < kReferenceIterations; }

scenes::Scene make_scene(const Sheet& sheet, const Setting& setting)
{
    scenes::Scene scene;
    scene.source = "sheet";
    scene.fps = 1.0 / kStep;
    scene.frames = 1 + sheet.steps;
    scene.solver.substeps = 1;
    scene.solver.tolerance = setting.tolerance;
    scene.solver.max_iterations = setting.max_iterations;
    scene.solver.outer = OuterMethod::Lbfgs;
    scene.solver.integrator = Integrator::ImplicitEuler;
    scene.solver.sleep.enabled = false;

    scene::Cloth cloth;
    cloth.name = "sheet";
    cloth.shape = scene::Rectangle{Vec2(1.0, 1.0), sheet.edge()};
    if (!setting.limits_strain) {
        scene.fabrics[kFabric].strain_limit = kNoLimit;
        cloth.fabric = kFabric;
    }
    scene.cloths = {cloth};

    scene::Attachment pins;
    pins.cloth = cloth.name;
    pins.select.by = std::vector<int>{0, sheet.side - 1};
    scene.attachments = {pins};
    return scene;
}

} // namespace toile::research::sheet
