#include "research/benchmarks/scaling/run.h"

#include <cmath>
#include <variant>

#include "core/base/error.h"
#include "research/benchmarks/memory_meter.h"
#include "research/benchmarks/stages/run.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::scaling {

namespace {

const Row kHeader{"vertices", "ms/frame", "iterations", "contacts", "self-collision", "kB/vertex"};

Row cells_of(const Result& r)
{
    return {std::to_string(r.vertices),       format("%.1f", r.ms_per_frame),
            format("%.1f", r.iterations),     format("%.0f", r.contacts),
            format("%.3f", r.self_collision), format("%.2f", 1e-3 * r.bytes_per_vertex)};
}

} // namespace

scenes::Scene with_vertices(scenes::Scene scene, int vertices)
{
    auto* const rectangle =
        scene.cloths.size() == 1 ? std::get_if<scene::Rectangle>(&scene.cloths.front().shape) : nullptr;
    if (rectangle == nullptr)
        throw InvalidInput(scene.source.string() +
                           ": its size is changed by the resolution of a rectangle; give a "
                           "scene with a single cloth of that shape");
    rectangle->resolution = std::sqrt(rectangle->size.prod() / vertices);
    return scene;
}

Result run(const scenes::Scene& scene, const std::function<bool(int)>& after_frame)
{
    MemoryMeter memory;
    const stages::Result run = stages::run(scene, after_frame);
    Result result;
    result.vertices = run.vertices;
    result.ms_per_frame = run.ms_per_frame;
    result.iterations = run.iterations;
    result.contacts = run.contacts;
    result.bytes_per_vertex = 1e6 * memory.peak_mb() / run.vertices;
    for (const stages::Stage& stage : run.stages)
        if (stage.name == "collision/near_pairs" || stage.name == "collision/collision_free_step")
            result.self_collision += stage.fraction;
    return result;
}

PowerFit fit(const std::vector<Result>& results)
{
    std::vector<double> vertices, ms;
    for (const Result& result : results) {
        vertices.push_back(result.vertices);
        ms.push_back(result.ms_per_frame);
    }
    return fit_power(vertices, ms);
}

std::string markdown_table(const std::vector<Result>& results)
{
    const PowerFit power = fit(results);
    const std::string table = markdown(kHeader, rows_of(results, cells_of));
    return power.points < 2 ? table
                            : table + "\nMilliseconds a frame grow as the vertices to the power " +
                                  format("%.2f", power.exponent) + ".\n";
}

std::string csv_table(const std::vector<Result>& results) { return csv(kHeader, rows_of(results, cells_of)); }

} // namespace toile::research::scaling
