#include "research/benchmarks/error_time/run.h"

#include "research/benchmarks/accuracy/run.h"
#include "research/benchmarks/text_table.h"
#include "research/scenes/literature_methods.h"
#include "scenes/format/solver_methods.h"

namespace toile::research::error_time {

namespace {

bool supports(const scene::Solver& solver, const scenes::Scene& scene)
{
    return !scene::is_baseline(solver.method) || !scene.contact.self;
}

std::vector<Contender> supported(const accuracy::Case& problem, std::vector<Contender> contenders)
{
    std::erase_if(contenders, [&](const Contender& c) { return !supports(c.solver, problem.scene); });
    return contenders;
}

const Row kHeader{"problem", "quantity", "method", "setting", "default", "ms/frame", "error", "unfinished"};

Row cells_of(const Point& p)
{
    return {p.problem,
            p.quantity,
            p.method,
            p.setting,
            p.is_default ? "yes" : "",
            format("%.2f", p.ms_per_frame),
            format("%.3g", p.error),
            std::to_string(p.unfinished) + " of " + std::to_string(p.frames)};
}

} // namespace

int frames_of(const accuracy::Case& problem, const std::vector<Contender>& contenders)
{
    return (problem.scene.frames - 1) * (1 + int(supported(problem, contenders).size()));
}

std::vector<Point> run(const accuracy::Case& problem, const std::vector<Contender>& contenders,
                       const std::function<bool(const std::string& name)>& after_frame)
{
    static const LiteratureMethods literature;
    scenes::WorldOptions options;
    options.baselines = &literature;
    std::vector<Point> points;
    const accuracy::Run reference =
        accuracy::run_scene(problem, *problem.reference, options, [&] { return after_frame(problem.name); });
    for (const Contender& contender : supported(problem, contenders)) {
        scenes::Scene scene = problem.scene;
        scene.solver = contender.solver;
        const accuracy::Run own = accuracy::run_scene(
            problem, scene, options, [&] { return after_frame(problem.name + ", " + contender.method); });
        if (!reference.is_complete || !own.is_complete)
            return points;
        Point point{problem.name, (problem.is_relative ? "relative error of " : "") + problem.quantity,
                    contender.method, contender.setting, contender.is_default};
        point.frames = int(own.trajectory.positions.size()) - 1;
        point.ms_per_frame = 1e3 * own.seconds / point.frames;
        point.unfinished = own.unfinished;
        point.error = accuracy::error_of(problem, problem.measure(own.trajectory, &reference.trajectory),
                                         accuracy::right_value(problem, &reference.trajectory));
        points.push_back(std::move(point));
    }
    return points;
}

std::string markdown_table(const std::vector<Point>& points)
{
    return markdown(kHeader, rows_of(points, cells_of));
}

std::string csv_table(const std::vector<Point>& points) { return csv(kHeader, rows_of(points, cells_of)); }

} // namespace toile::research::error_time
