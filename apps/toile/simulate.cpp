#include <map>
#include <memory>
#include <utility>

#include "apps/toile/command_line.h"
#include "apps/toile/commands.h"
#include "apps/toile/device_list.h"
#include "apps/toile/scene_run.h"
#include "apps/toile/scenes_run.h"
#include "core/backend/error.h"
#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"

namespace toile {

namespace {

const std::map<std::string, Backend> kBackends{
    {"cpu", Backend::Cpu}, {"cuda", Backend::Cuda}, {"auto", Backend::Auto}};

struct SimulateOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path output; ///< folder; empty: out/<name of the scene file>
    std::optional<int> frames;
    std::optional<int> threads;
    std::string solver;
    std::string outer;
    std::string backend = "cpu"; ///< a key of kBackends
    std::optional<std::string> devices;
    std::filesystem::path report; ///< of one scene a file, of several a folder
    bool no_cache = false;
    bool no_check = false;
    bool quiet = false;
};

void require_range(const char* option, const std::optional<int>& value, int lower, int upper)
{
    if (value && (*value < lower || *value > upper))
        throw InvalidInput(std::string(option) + ": " + std::to_string(*value) + " is out of range; give a " +
                           "whole number from " + std::to_string(lower) + " to " + std::to_string(upper));
}

/// What is there of a place: itself, or the innermost of its folders.
std::filesystem::path nearest_existing(const std::filesystem::path& place)
{
    std::filesystem::path there = std::filesystem::absolute(place);
    while (!std::filesystem::exists(there))
        there = there.parent_path();
    return there;
}

/// Refuses a report before the run that could not be written after it.
void require_place(const std::filesystem::path& report)
{
    if (report.empty())
        return;
    if (std::filesystem::is_directory(report))
        throw InvalidInput(report.string() + ": is a folder; name a file for the report");
    const std::filesystem::path folder = nearest_existing(std::filesystem::absolute(report).parent_path());
    if (!std::filesystem::is_directory(folder))
        throw InvalidInput(report.string() + ": " + folder.string() + " is no folder; choose another place");
}

/// Refuses a place in which the runs of several scenes could not make their folders.
void require_folder(const char* option, const std::filesystem::path& place)
{
    if (place.empty())
        return;
    const std::filesystem::path there = nearest_existing(place);
    if (!std::filesystem::is_directory(there))
        throw InvalidInput(std::string(option) + ": " + place.string() + ": " + there.string() +
                           " is no folder; several scenes need one");
}

/// The GPUs to run on, by number; where there are none, what is told of that says 0.
std::vector<int> devices_of(const SimulateOptions& options)
{
    if (!options.devices)
        return {0};
    if (kBackends.at(options.backend) == Backend::Cpu)
        throw InvalidInput("--devices: " + *options.devices +
                           " with the backend cpu; give --backend cuda or auto, or leave --devices out");
    std::vector<int> devices = parse_devices(*options.devices);
    const std::vector<CudaDevice> there = cuda_devices();
    if (there.empty())
        return {devices.front()};
    require_devices(devices, there);
    return devices;
}

/// The scene with what the command line says otherwise.
Scene scene_with_options(const std::filesystem::path& file, const SimulateOptions& options)
{
    Scene scene = read_scene(file);
    scene.frames = options.frames.value_or(scene.frames);
    scene.solver.threads = options.threads.value_or(scene.solver.threads);
    if (!options.solver.empty())
        scene.solver.method = scene_format::value_of<scene::SolverMethod>(options.solver);
    if (!options.outer.empty())
        scene.solver.outer = scene_format::value_of<OuterMethod>(options.outer);
    if (kBackends.at(options.backend) == Backend::Cuda)
        require_runs_on_gpu(scene);
    return scene;
}

/// The only scene: what the options name is its own.
SceneJob job_of(const SimulateOptions& options)
{
    require_place(options.report);
    Scene scene = scene_with_options(options.scenes.front(), options);
    const std::filesystem::path folder =
        options.output.empty() ? std::filesystem::path("out") / scene.source.stem() : options.output;
    return {std::move(scene), folder, options.report};
}

/// Several scenes: what the options name is a folder in which each has its name.
std::vector<SceneJob> jobs_of(const SimulateOptions& options)
{
    const std::filesystem::path output = options.output.empty() ? "out" : options.output;
    require_folder("-o", output);
    require_folder("--report", options.report);
    std::map<std::filesystem::path, std::filesystem::path> by_name;
    std::vector<SceneJob> jobs;
    for (const std::filesystem::path& file : options.scenes) {
        const std::filesystem::path name = file.stem();
        if (const auto [other, is_new] = by_name.emplace(name, file); !is_new)
            throw InvalidInput(file.string() + ": would write to " + (output / name).string() + " as " +
                               other->second.string() +
                               " does; give each scene once, under a name of its own");
        const std::filesystem::path report =
            options.report.empty() ? "" : options.report / (name.string() + ".json");
        jobs.push_back({scene_with_options(file, options), output / name, report});
    }
    return jobs;
}

/// One scene, which may be interrupted at any place while it loads; from then on only where nothing is left
/// half-written.
int simulate_one(const SceneJob& job, const RunSettings& settings, bool quiet)
{
    SceneRun run(job, settings, RunLog(quiet));
    const InterruptGuard interrupt;
    return run.run(interrupt);
}

int simulate(const SimulateOptions& options)
{
    require_range("--frames", options.frames, 1, 1000000);
    require_range("--threads", options.threads, 0, 1024);
    const std::vector<int> devices = devices_of(options);
    const RunSettings settings{kBackends.at(options.backend), devices.front(), options.no_cache,
                               options.no_check};
    if (options.scenes.size() == 1)
        return simulate_one(job_of(options), settings, options.quiet);
    return run_scenes(jobs_of(options), settings, devices, options.quiet);
}

} // namespace

Command add_simulate(CLI::App& program)
{
    Command command;
    command.options = program.add_subcommand("simulate", "Run scenes and write their caches");
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& add = *command.options;
    add.add_option("scene", options->scenes, "Scene files (.json)")->required();
    add.add_option("-o,--output", options->output,
                   "Folder for the caches [out/NAME]; of several scenes the folder of their folders [out]");
    add.add_option("--frames", options->frames, "Samples to write, instead of the scene's");
    add.add_option("--threads", options->threads, "Threads to use; 0: all");
    add.add_option("--solver", options->solver, "solver.method, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<scene::SolverMethod>()));
    add.add_option("--outer", options->outer, "Minimisation of a step, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<OuterMethod>()));
    add.add_option("--backend", options->backend,
                   "Where steps are minimised [cpu]; auto: on a GPU where there is one and the scene can")
        ->check(CLI::IsMember({"cpu", "cuda", "auto"}));
    add.add_option("--devices", options->devices,
                   "GPUs to spread scenes over, by number, e.g. 0,1 [0]; each runs one scene at a time");
    add.add_option(
        "--report", options->report,
        "Write stages, frames and settings to this JSON file; of several scenes to NAME.json in this folder");
    add.add_flag("--no-cache", options->no_cache, "Neither read nor keep quadrature tables on disk");
    add.add_flag("--no-check", options->no_check, "Write no certificate of the caches");
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return simulate(*options); };
    return command;
}

} // namespace toile
