#include "research/benchmarks/accuracy/scene_text.h"

#include <cstdio>

#include "scenes/format/read_scene.h"

namespace toile::research::accuracy {

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

scenes::Scene scene_of(const std::string& name, const std::string& keys)
{
    return scenes::parse_scene(R"({"toile": 1, )" + keys + "}", name);
}

std::string lossless_fabric(double areal_density, double stretch, double bend, double damping)
{
    return R"("fabrics": {"f": {"areal_density": )" + number(areal_density) + R"(, "stretch": {"warp": )" +
           number(stretch) + R"(, "weft": )" + number(stretch) + R"(}, "shear": )" + number(0.5 * stretch) +
           R"(, "bend": {"warp": )" + number(bend) + R"(, "weft": )" + number(bend) + R"(}, "damping": )" +
           number(damping) +
           R"(, "strain_limit": 9, "stretch_damping": 0, "shear_damping": 0, "bend_damping": 0,
              "bend_friction": 0}})";
}

scenes::Scene converged(scenes::Scene scene, int finer, double velocity_tolerance)
{
    scene.solver.quality = scene::Quality::Final;
    scene.solver.velocity_tolerance = velocity_tolerance;
    scene.solver.max_iterations = 2000;
    scene.solver.substeps = finer * scene.solver.substeps.value_or(scene::Solver::kSubsteps);
    return scene;
}

} // namespace toile::research::accuracy
