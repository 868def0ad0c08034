#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>

#include "apps/toile/certify.h"
#include "apps/toile/command_line.h"
#include "apps/toile/commands.h"
#include "apps/toile/exports.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "apps/toile/run_report.h"
#include "apps/toile/start_text.h"
#include "apps/toile/table_progress.h"
#include "core/backend/error.h"
#include "core/backend/parallel.h"
#include "core/mesh/obj.h"
#include "core/quadrature/table_store.h"
#include "export/async_cache_writer.h"
#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"
#include "scenes/world.h"

namespace toile {

namespace {

const std::map<std::string, Backend> kBackends{
    {"cpu", Backend::Cpu}, {"cuda", Backend::Cuda}, {"auto", Backend::Auto}};

struct SimulateOptions {
    std::filesystem::path scene;
    std::filesystem::path output; ///< folder; empty: out/<name of the scene file>
    std::optional<int> frames;
    std::optional<int> threads;
    std::string solver;
    std::string outer;
    std::string backend = "cpu"; ///< a key of kBackends
    std::filesystem::path report;
    bool no_cache = false;
    bool no_check = false;
    bool quiet = false;
};

/// A cache on its way to disk and the cloth whose positions it takes.
struct OpenCache {
    std::filesystem::path file;
    int cloth;
    std::unique_ptr<CacheWriter> writer;
};

void require_range(const char* option, const std::optional<int>& value, int lower, int upper)
{
    if (value && (*value < lower || *value > upper))
        throw InvalidInput(std::string(option) + ": " + std::to_string(*value) + " is out of range; give a " +
                           "whole number from " + std::to_string(lower) + " to " + std::to_string(upper));
}

/// Refuses a report before the run that could not be written after it.
void require_place(const std::filesystem::path& report)
{
    if (report.empty())
        return;
    if (std::filesystem::is_directory(report))
        throw InvalidInput(report.string() + ": is a folder; name a file for the report");
    std::filesystem::path folder = std::filesystem::absolute(report).parent_path();
    while (!std::filesystem::exists(folder))
        folder = folder.parent_path();
    if (!std::filesystem::is_directory(folder))
        throw InvalidInput(report.string() + ": " + folder.string() + " is no folder; choose another place");
}

/// The scene with what the command line says otherwise.
Scene scene_with_options(const SimulateOptions& options)
{
    require_range("--frames", options.frames, 1, 1000000);
    require_range("--threads", options.threads, 0, 1024);
    require_place(options.report);
    Scene scene = read_scene(options.scene);
    scene.frames = options.frames.value_or(scene.frames);
    scene.solver.threads = options.threads.value_or(scene.solver.threads);
    if (!options.solver.empty())
        scene.solver.method = scene_format::value_of<scene::SolverMethod>(options.solver);
    if (!options.outer.empty())
        scene.solver.outer = scene_format::value_of<OuterMethod>(options.outer);
    return scene;
}

std::vector<OpenCache> open_caches(const Scene& scene, const World& world,
                                   const std::filesystem::path& folder)
{
    std::vector<OpenCache> caches;
    for (const scene::Export& entry : exports_of(scene)) {
        const int cloth = surface_index(scene, entry.cloth);
        CacheLayout layout = cache_layout(world.surfaces()[cloth].rest, scene.frames);
        layout.fps = scene.fps;
        const std::filesystem::path file = folder / entry.file;
        caches.push_back({file, cloth, std::make_unique<AsyncCacheWriter>(make_cache_writer(file, layout))});
    }
    return caches;
}

void write_frame(const World& world, std::vector<OpenCache>& caches)
{
    for (OpenCache& cache : caches)
        cache.writer->write(world.frame(), world.surfaces()[cache.cloth].positions);
}

/// PC2 and MDD hold positions only: the mesh they play on goes beside them, in its start state, unless an OBJ
/// of that name is among the caches.
void write_start_mesh(const World& world, const OpenCache& cache, const std::vector<OpenCache>& caches)
{
    const std::filesystem::path file = std::filesystem::path(cache.file).replace_extension(".obj");
    if (std::any_of(caches.begin(), caches.end(), [&](const OpenCache& other) { return other.file == file; }))
        return;
    ObjMesh mesh = world.surfaces()[cache.cloth].rest;
    mesh.positions = world.surfaces()[cache.cloth].positions;
    write_obj(file, mesh);
}

std::string note_of(const StepReport& report)
{
    return std::to_string(report.iterations) + " iterations, " + std::to_string(report.contacts) +
           " contacts";
}

/// How a run ended.
struct Outcome {
    std::string word = "complete"; ///< or "interrupted", "failed"
    std::string message;           ///< why it failed
};

/// Settles and runs to the last frame, to an interrupt, or to a failure.
/// @throws Cancelled when interrupted while tables were built
Outcome run_frames(World& world, const Scene& scene, std::vector<OpenCache>& caches, RunReport& report,
                   const InterruptGuard& interrupt, bool quiet)
{
    world.settle();
    Progress progress("frame", scene.frames, quiet);
    write_frame(world, caches);
    progress.update(1);
    while (world.frame() + 1 < scene.frames) {
        if (interrupt.requested())
            return {"interrupted", ""};
        const auto start = std::chrono::steady_clock::now();
        const StepReport step = world.advance_frame();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        report.add_frame(world.frame(), step, seconds.count());
        if (step.status == StepReport::Status::NonFinite)
            return {"failed", step.message};
        write_frame(world, caches);
        progress.update(world.frame() + 1, note_of(step));
    }
    return {};
}

Outcome run(World& world, const Scene& scene, std::vector<OpenCache>& caches, RunReport& report,
            const InterruptGuard& interrupt, bool quiet)
{
    try {
        return run_frames(world, scene, caches, report, interrupt, quiet);
    } catch (const Cancelled&) {
        return {"interrupted", ""};
    }
}

/// Says where a run ended that did not get to its end, and lists the partial caches.
int explain_stop(int last_frame, const Outcome& outcome, std::vector<OpenCache>& caches)
{
    for (OpenCache& cache : caches) {
        const std::filesystem::path partial = cache.writer->partial();
        cache.writer.reset(); // delivers what is still queued
        std::cout << partial.string() << std::endl;
    }
    std::cerr << "toile: error: " << outcome.word << " at frame " << last_frame
              << (outcome.message.empty() ? "" : ": " + outcome.message)
              << "; the frames before it are in the partial caches" << std::endl;
    return kExitFailure;
}

/// One cache of each cloth, as it lies on disk.
std::vector<CachedCloth> cloths_to_check(const World& world, const std::vector<OpenCache>& caches)
{
    std::vector<CachedCloth> cloths;
    for (const OpenCache& cache : caches) {
        const ClothState* cloth = &world.surfaces()[cache.cloth];
        if (std::none_of(cloths.begin(), cloths.end(),
                         [&](const CachedCloth& other) { return other.cloth == cloth; }))
            cloths.push_back({cloth, cache.file});
    }
    return cloths;
}

/// Certifies what lies on disk now.
int check_caches(const World& world, const Scene& scene, const std::vector<OpenCache>& caches,
                 const std::filesystem::path& folder, const InterruptGuard& interrupt, bool quiet)
{
    const ThreadLimit threads(scene.solver.threads);
    std::optional<Progress> progress(std::in_place, "check", scene.frames, quiet);
    const std::optional<Certificate> certificate =
        certify(scene, cloths_to_check(world, caches), {}, [&](int done, int) {
            progress->update(done);
            return !interrupt.requested();
        });
    progress.reset(); // what follows starts on a line of its own
    if (!certificate) {
        std::cerr << "toile: error: interrupted while checking; the caches are complete, toile check "
                  << folder.string() << " --scene " << scene.source.string() << " certifies them"
                  << std::endl;
        return kExitFailure;
    }
    const std::filesystem::path file = folder / kCertificateName;
    std::cout << file.string() << std::endl;
    return conclude(*certificate, file, quiet);
}

/// Runs a prepared world and writes what it is to leave.
int run_into_caches(World& world, const Scene& scene, const SimulateOptions& options,
                    const InterruptGuard& interrupt)
{
    const std::filesystem::path folder =
        options.output.empty() ? std::filesystem::path("out") / scene.source.stem() : options.output;
    std::vector<OpenCache> caches = open_caches(scene, world, folder);

    int vertex_count = 0;
    for (const auto& cloth : world.surfaces())
        vertex_count += int(cloth.positions.size());
    RunReport report(scene, vertex_count, world.start(), world.device());
    for (const OpenCache& cache : caches)
        write_start_mesh(world, cache, caches);

    const Outcome outcome = run(world, scene, caches, report, interrupt, options.quiet);
    if (!options.report.empty())
        report.write(options.report, outcome.word, world.stages());
    if (outcome.word != "complete")
        return explain_stop(world.frame(), outcome, caches);
    for (OpenCache& cache : caches) {
        cache.writer->finish();
        std::cout << cache.file.string() << std::endl;
    }
    // A certificate of an earlier run says nothing of these caches.
    std::error_code none_there;
    std::filesystem::remove(folder / kCertificateName, none_there);
    if (options.no_check)
        return kExitOk;
    return check_caches(world, scene, caches, folder, interrupt, options.quiet);
}

int simulate(const SimulateOptions& options)
{
    const Scene scene = scene_with_options(options);
    TableProgress tables(options.quiet);
    std::optional<InterruptGuard> interrupt;
    WorldOptions world_options;
    world_options.backend = kBackends.at(options.backend);
    if (options.no_cache)
        world_options.tables = std::make_shared<TableStore>();
    world_options.building = [&](const std::string& cloth, double share) {
        const bool goes_on = !interrupt->requested();
        goes_on ? tables.update(cloth, share) : tables.stop();
        return goes_on;
    };
    world_options.warn = [&](const std::string& text) { tables.warn(text); };
    World world(scene, world_options);
    if (const std::string text = start_text(world.start(), scene); !text.empty())
        std::cerr << "toile: " << text << std::endl;

    // Loading may be interrupted at any place; from here on it is done where nothing is left half-written.
    interrupt.emplace();
    try {
        world.prepare();
    } catch (const Cancelled&) {
        std::cerr << "toile: error: interrupted before the first frame; nothing was written" << std::endl;
        return kExitFailure;
    }
    return run_into_caches(world, scene, options, *interrupt);
}

} // namespace

Command add_simulate(CLI::App& program)
{
    Command command;
    command.options = program.add_subcommand("simulate", "Run a scene and write its caches");
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& add = *command.options;
    add.add_option("scene", options->scene, "Scene file (.json)")->required();
    add.add_option("-o,--output", options->output, "Folder for the caches [out/NAME]");
    add.add_option("--frames", options->frames, "Samples to write, instead of the scene's");
    add.add_option("--threads", options->threads, "Threads to use; 0: all");
    add.add_option("--solver", options->solver, "solver.method, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<scene::SolverMethod>()));
    add.add_option("--outer", options->outer, "Minimisation of a step, instead of the scene's")
        ->check(CLI::IsMember(scene_format::words_of<OuterMethod>()));
    add.add_option("--backend", options->backend,
                   "Where steps are minimised [cpu]; auto: on a GPU where there is one and the scene can")
        ->check(CLI::IsMember({"cpu", "cuda", "auto"}));
    add.add_option("--report", options->report, "Write stages, frames and settings to this JSON file");
    add.add_flag("--no-cache", options->no_cache, "Neither read nor keep quadrature tables on disk");
    add.add_flag("--no-check", options->no_check, "Write no certificate of the caches");
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return simulate(*options); };
    return command;
}

} // namespace toile
