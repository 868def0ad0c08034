#include "research/benchmarks/contact/scaling.h"

#include <algorithm>
#include <cmath>

#include "research/benchmarks/contact/sheets.h"
#include "scenes/world/world.h"

namespace toile::research::contact_stress {

namespace {

constexpr double kTimeStep = 1.0 / 120.0; ///< [s]
constexpr double kThickness = 1e-3;       ///< [m]

/// Amplitude and period of the shaken points [m], [s]: slow enough for layers to follow and stay in contact.
constexpr double kAmplitude = 0.01, kPeriod = 0.4;

constexpr int kEdgesBetweenAttachments = 10;

/// Random shift [m] and rotation [degrees] of the sheets that lie on the attached one: they avoid coincident
/// vertices but keep the overlap nearly complete.
constexpr double kShift = 0.005, kRotation = 5.0;

/// Edges along a side.
int edges_of(const ScalingCase& trial)
{
    return std::max(2, int(std::lround(std::sqrt(double(trial.vertices) / trial.layers))) - 1);
}

/// Attaches every second point of a lattice at rest and shakes the others.
void attach_lattice(scenes::Scene& scene, const std::string& sheet, int edges, double duration)
{
    const int cells = std::max(1, int(std::lround(double(edges) / kEdgesBetweenAttachments)));
    std::vector<Vec3> points[2];
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j)
            points[(i + j) % 2].emplace_back((double(i) / cells - 0.5) * edges * kEdge, 0.0,
                                             (double(j) / cells - 0.5) * edges * kEdge);
    scene::Attachment still, shaken;
    still.cloth = shaken.cloth = sheet;
    still.select.by = points[0];
    shaken.select.by = points[1];
    for (int quarter = 0; quarter * 0.25 * kPeriod < duration + kPeriod; ++quarter) {
        const double height = quarter % 2 == 0 ? 0.0 : quarter % 4 == 1 ? kAmplitude : -kAmplitude;
        shaken.keyframes.push_back({quarter * 0.25 * kPeriod, Vec3(0.0, height, 0.0), Vec3::Zero()});
    }
    scene.attachments = {still, shaken};
}

ScalingCase make_case(Series series, int vertices, int layers)
{
    ScalingCase result;
    result.name = "scaling " + std::string(series == Series::Vertices ? "size " : "layers ") +
                  std::to_string(vertices) + " vertices " + std::to_string(layers) + " layers";
    result.series = series;
    result.vertices = vertices;
    result.layers = layers;
    return result;
}

/// Value of a result to be fitted.
double value_of(const ScalingResult& result, const std::string& what)
{
    if (what == "step")
        return 1e3 * step_seconds(result.parts);
    if (what == "contacts")
        return result.contacts;
    if (what == "iterations")
        return result.iterations;
    for (int part = 0; part < kPartCount; ++part)
        if (what == name_of(Part(part)))
            return 1e3 * result.parts[part];
    return 0.0;
}

std::vector<std::string> fitted_names()
{
    std::vector<std::string> names{"step"};
    for (int part = 0; part < kPartCount; ++part)
        if (Part(part) != Part::Factor)
            names.emplace_back(name_of(Part(part)));
    names.insert(names.end(), {"contacts", "iterations"});
    return names;
}

} // namespace

std::vector<ScalingCase> scaling_cases(Size size)
{
    const bool quick = size == Size::Quick;
    std::vector<ScalingCase> cases;
    for (int vertices = quick ? 500 : 1000; vertices <= (quick ? 2000 : 32000); vertices *= 2)
        cases.push_back(make_case(Series::Vertices, vertices, 4));
    for (int layers = 1; layers <= (quick ? 8 : 32); layers *= 2)
        cases.push_back(make_case(Series::Layers, quick ? 1000 : 8000, layers));
    if (quick)
        for (ScalingCase& trial : cases)
            trial.warm_up = trial.steps = 8;
    return cases;
}

scenes::Scene scaling_scene(const ScalingCase& trial, int threads)
{
    const int steps = trial.warm_up + trial.steps, edges = edges_of(trial);
    scenes::Scene scene = empty_scene(trial.name, kTimeStep, steps, kThickness, threads);
    Random random(1);
    attach_lattice(scene, add_sheet(scene, edges * kEdge, Vec3::Zero(), 0.0), edges, steps * kTimeStep);
    for (int layer = 1; layer < trial.layers; ++layer) {
        const Vec3 center(random.between(-kShift, kShift), 1.5 * layer * kThickness,
                          random.between(-kShift, kShift));
        add_sheet(scene, edges * kEdge, center, random.between(-kRotation, kRotation));
    }
    return scene;
}

ScalingResult run(const ScalingCase& trial, int threads, const std::function<bool(int)>& after_step)
{
    ScalingResult result;
    result.trial = trial;
    scenes::World world(scaling_scene(trial, threads));
    for (const scenes::ClothState& cloth : world.cloths())
        result.vertices += int(cloth.positions.size());
    const double weight = 1.0 / trial.steps;
    PartSeconds start{};
    for (int step = 1; step <= trial.warm_up + trial.steps; ++step) {
        if (step == trial.warm_up + 1)
            start = seconds_by_part(world.stages());
        const StepReport report = world.advance_frame();
        if (step > trial.warm_up) {
            result.contacts += weight * report.contacts;
            result.iterations += weight * report.iterations;
            result.linear_iterations += weight * report.linear_iterations;
        }
        if (!after_step(step))
            break;
    }
    result.parts = difference(seconds_by_part(world.stages()), start);
    for (double& seconds : result.parts)
        seconds *= weight;
    return result;
}

std::vector<ScalingFit> fit(const std::vector<ScalingResult>& results)
{
    std::vector<ScalingFit> fits;
    for (const Series series : {Series::Vertices, Series::Layers}) {
        std::vector<ScalingResult> members;
        std::copy_if(results.begin(), results.end(), std::back_inserter(members),
                     [&](const ScalingResult& result) { return result.trial.series == series; });
        if (members.size() < 2)
            continue;
        std::vector<double> vertices, contacts;
        for (const ScalingResult& member : members) {
            vertices.push_back(member.vertices);
            contacts.push_back(member.contacts);
        }
        for (const std::string& what : fitted_names()) {
            std::vector<double> values;
            values.reserve(members.size());
            for (const ScalingResult& member : members)
                values.push_back(value_of(member, what));
            const PowerFit by_vertices =
                series == Series::Vertices ? fit_power(vertices, values) : PowerFit{};
            fits.push_back({series, what, by_vertices, fit_power(contacts, values)});
        }
    }
    return fits;
}

} // namespace toile::research::contact_stress
