#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "apps/toile/simulate/device_list.h"
#include "apps/toile/simulate/scene_run.h"
#include "apps/toile/simulate/scenes_run.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "core/base/error.h"
#include "core/compute/cuda/runtime/device.h"
#include "export/cache_format.h"
#include "scenes/format/document.h"
#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"
#include "scenes/format/validate.h"

namespace toile::app {

namespace {

const std::map<std::string, scenes::Backend> kBackends{
    {"cpu", scenes::Backend::Cpu}, {"cuda", scenes::Backend::Cuda}, {"auto", scenes::Backend::Auto}};

struct SimulateOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path output; ///< folder; empty: out/<name of the scene file>
    std::optional<int> frames;
    std::optional<int> threads;
    std::string solver;
    std::string outer;
    std::string backend = "cpu"; ///< a key of kBackends
    std::optional<std::string> devices;
    std::filesystem::path report;               ///< a file for one scene, a folder for several
    std::vector<std::filesystem::path> exports; ///< caches instead of the scene's
    scene::Export export_keys;                  ///< of these
    std::string export_unit = "m", export_up = "y";
    std::vector<std::string> export_attributes;
    bool no_velocities = false, no_weld = false;
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

/// Numbers of the GPUs to run on, 0 by default; without a GPU on this machine the first number, unchecked.
std::vector<int> devices_of(const SimulateOptions& options)
{
    if (!options.devices)
        return {0};
    if (kBackends.at(options.backend) == scenes::Backend::Cpu)
        throw InvalidInput("--devices: " + *options.devices +
                           " with the backend cpu; give --backend cuda or auto, or leave --devices out");
    std::vector<int> devices = parse_devices(*options.devices);
    const std::vector<CudaDevice> available = cuda_devices();
    if (available.empty())
        return {devices.front()};
    require_devices(devices, available);
    return devices;
}

/// The caches of --export, with the options that go with it.
std::vector<scene::Export> exports_of(const SimulateOptions& options)
{
    std::vector<scene::Export> exports;
    for (const std::filesystem::path& file : options.exports) {
        scene::Export& entry = exports.emplace_back(options.export_keys);
        entry.file = file;
        entry.unit = scene_format::value_of<scene::ExportUnit>(options.export_unit);
        entry.up = scene_format::value_of<scene::UpAxis>(options.export_up);
        entry.velocities = !options.no_velocities;
        entry.weld = !options.no_weld;
        for (const std::string& word : options.export_attributes)
            entry.attributes.push_back(scene_format::value_of<scene::ExportAttribute>(word));
    }
    return exports;
}

/// Scene with the options of the command line applied.
scenes::Scene scene_with_options(const std::filesystem::path& file, const SimulateOptions& options)
{
    scenes::Scene scene = scenes::read_scene(file);
    scene.frames = options.frames.value_or(scene.frames);
    scene.solver.threads = options.threads.value_or(scene.solver.threads);
    if (!options.solver.empty())
        scene.solver.method = scene_format::value_of<scene::SolverMethod>(options.solver);
    if (!options.outer.empty())
        scene.solver.outer = scene_format::value_of<OuterMethod>(options.outer);
    if (!options.exports.empty()) {
        scene.exports = exports_of(options);
        require_valid(scene);
    }
    if (kBackends.at(options.backend) == scenes::Backend::Cuda)
        require_runs_on_gpu(scene);
    return scene;
}

/// Job of a single scene: options give its folder and report file.
SceneJob job_of(const SimulateOptions& options)
{
    scenes::Scene scene = scene_with_options(options.scenes.front(), options);
    const std::filesystem::path folder =
        options.output.empty() ? std::filesystem::path("out") / scene.source.stem() : options.output;
    return {std::move(scene), folder, options.report};
}

/// Jobs of several scenes: options give folders, in which each scene writes under its name.
std::vector<SceneJob> jobs_of(const SimulateOptions& options)
{
    const std::filesystem::path output = options.output.empty() ? "out" : options.output;
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

/// Runs one scene. While it loads, an interrupt may end it at any point; afterwards only where no file is
/// left half-written.
int simulate_one(const SceneJob& job, const RunSettings& settings, bool quiet)
{
    SceneRun run(job, settings, RunLog(quiet), nullptr);
    const InterruptGuard interrupt;
    return run.run(interrupt);
}

int simulate(const SimulateOptions& options, const scenes::BaselineMethods* baselines)
{
    require_range("--frames", options.frames, 1, 1000000);
    require_range("--threads", options.threads, 0, 1024);
    const std::vector<int> devices = devices_of(options);
    const RunSettings settings{kBackends.at(options.backend), devices.front(), options.no_cache,
                               options.no_check, baselines};
    const bool is_single = options.scenes.size() == 1;
    const std::vector<SceneJob> jobs = is_single ? std::vector{job_of(options)} : jobs_of(options);
    require_safe_outputs(jobs);
    if (!options.no_check)
        std::for_each(jobs.begin(), jobs.end(), require_checkable);
    return is_single ? simulate_one(jobs.front(), settings, options.quiet)
                     : run_scenes(jobs, settings, devices, options.quiet);
}

/// Options of --export: the keys of the scene's "export".
void add_export_options(CLI::App& add, SimulateOptions& options)
{
    const auto in_group = [](CLI::Option* option) { return option->group("Export"); };
    CLI::Option* const file =
        in_group(add.add_option("--export", options.exports,
                                "Cache to write into the folder, instead of those of the scene (" +
                                    scene_format::enumerate(exports::written_extensions(), "or") +
                                    "); may be given several times")
                     ->expected(1)
                     ->take_all());
    scene::Export& keys = options.export_keys;
    for (CLI::Option* const option :
         {add.add_option("--export-cloth", keys.cloths, "Cloth or solid to write [all, or the only one]"),
          add.add_option("--start-frame", keys.start_frame,
                         "Number of the first frame [1 in .abc and USD, else 0]"),
          add.add_option("--subframes", keys.subframes, "Samples per frame [1]")->check(CLI::Range(1, 100)),
          add.add_option("--unit", options.export_unit, "Unit of the numbers [m]")
              ->check(CLI::IsMember(scene_format::words_of<scene::ExportUnit>())),
          add.add_option("--up", options.export_up, "Upward axis of the numbers [y]")
              ->check(CLI::IsMember(scene_format::words_of<scene::UpAxis>())),
          add.add_option("--attributes", options.export_attributes,
                         "Numbers to store with cloths: strain, gap, panel")
              ->delimiter(',')
              ->check(CLI::IsMember(scene_format::words_of<scene::ExportAttribute>())),
          add.add_flag("--avatars", keys.avatars, "Also write the avatars"),
          add.add_flag("--normals", keys.normals, "Store normals, creased at seams"),
          add.add_flag("--thickness", keys.thickness, "Close each cloth with its thickness"),
          add.add_flag("--no-velocities", options.no_velocities, "Store no velocities"),
          add.add_flag("--no-weld", options.no_weld, "Write one mesh for each group of faces")})
        in_group(option)->needs(file);
}

} // namespace

Command add_simulate(CLI::App& parser, const scenes::BaselineMethods* baselines)
{
    Command command;
    command.options = parser.add_subcommand("simulate", "Run scenes and write their caches");
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& add = *command.options;
    add.add_option("scene", options->scenes, "Scene files (.json)")->required();
    add.add_option("-o,--output", options->output,
                   "Folder for the caches [out/NAME]; for several scenes the parent of their folders [out]");
    add.add_option("--frames", options->frames, "Samples to write, instead of the scene's");
    add.add_option("--threads", options->threads, "Threads to use; 0: all");
    add.add_option("--solver", options->solver, "solver.method, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<scene::SolverMethod>()));
    add.add_option("--outer", options->outer, "Minimisation of a step, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<OuterMethod>()));
    add.add_option(
           "--backend", options->backend,
           "Where steps are minimised [cpu]; auto: on a GPU if there is one and it supports the scene")
        ->check(CLI::IsMember({"cpu", "cuda", "auto"}));
    add.add_option("--devices", options->devices,
                   "GPUs to spread scenes over, by number, e.g. 0,1 [0]; each runs one scene at a time");
    add.add_option("--report", options->report,
                   "Write stages, frames and settings to this JSON file; for several scenes to NAME.json in "
                   "this folder");
    add_export_options(add, *options);
    add.add_flag("--no-cache", options->no_cache, "Neither read nor keep quadrature tables on disk");
    add.add_flag("--no-check", options->no_check, "Write no certificate of the caches");
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options, baselines] { return simulate(*options, baselines); };
    return command;
}

} // namespace toile::app
