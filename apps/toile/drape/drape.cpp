#include <algorithm>
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/drape/continuation.h"
#include "apps/toile/drape/drape_files.h"
#include "apps/toile/drape/drape_progress.h"
#include "apps/toile/drape/drape_report.h"
#include "apps/toile/pattern/mesh_report.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/run_log.h"
#include "apps/toile/terminal/setup_progress.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"
#include "garment/fabric/fabric.h"
#include "scenes/format/cache_files.h"
#include "scenes/garment_format/read_garment.h"

namespace toile::app {

namespace {

/// Default of --time-limit [s].
constexpr double kTimeLimit = 600.0;
/// Of each number of --shift [m].
constexpr double kMaxShift = 1000.0;

struct DrapeOptions {
    scenes::DrapeSettings settings;
    std::vector<std::filesystem::path> garments;
    std::vector<std::string> fabrics = {scenes::DrapeGarment{}.fabric};
    std::filesystem::path avatar;
    ClipOptions clip;
    std::vector<double> shift;
    std::filesystem::path folder; ///< empty: out/NAME
    int threads = 0;
    bool quiet = false;
};

void require_valid(const DrapeOptions& options)
{
    require_edge_option(options.settings.edge);
    for (const std::string& fabric : options.fabrics)
        garment::fabric_preset(fabric, "--fabric");
    if (options.fabrics.size() != 1 && options.fabrics.size() != options.garments.size())
        throw InvalidInput("--fabric: names " + std::to_string(options.fabrics.size()) + " fabrics for " +
                           std::to_string(options.garments.size()) +
                           (options.garments.size() == 1 ? " garment" : " garments") +
                           "; give one for all or one for each");
    for (const double metres : options.shift)
        if (!(std::abs(metres) <= kMaxShift))
            throw InvalidInput("--shift " + short_text(metres) + ": must be three numbers from -" +
                               std::to_string(int(kMaxShift)) + " to " + std::to_string(int(kMaxShift)) +
                               " m");
    if (!(options.settings.time_limit > 0.0))
        throw InvalidInput("--time-limit " + short_text(options.settings.time_limit) +
                           ": must be a positive number of seconds");
}

/// Completes the settings by those of the options that have another form there.
void complete(DrapeOptions& options, const DrapeFiles& files)
{
    scenes::DrapeSettings& settings = options.settings;
    for (size_t g = 0; g < options.garments.size(); ++g)
        settings.garments.push_back(
            {options.garments[g], files.names()[g],
             options.fabrics.size() == 1 ? options.fabrics.front() : options.fabrics[g]});
    settings.folder = files.stages();
    settings.body.name = "body";
    if (options.avatar.empty())
        settings.body.shape = scene::Mannequin{};
    else
        settings.body.shape = options.avatar;
    if (scene_format::is_cache(options.avatar)) {
        settings.body.speed = 0.0; // stays in its first sample
        if (!scene_format::has_times(options.avatar))
            settings.body.fps = scenes::Scene{}.fps;
    }
    if (!options.shift.empty())
        settings.shift = Vec3(options.shift[0], options.shift[1], options.shift[2]);
}

/// A refusal is reported in the folder too. @throws InvalidInput
garment::Pattern read_pattern(const std::filesystem::path& file, const DrapeFiles& files)
{
    try {
        return garment_format::read_pattern(file);
    } catch (const InvalidInput& error) {
        if (std::filesystem::exists(file))
            files.write_refusal({"pattern", error.what()});
        throw;
    }
}

/// Meshes the pattern to know that it can be sewn. A refusal is reported in the folder too.
/// @throws InvalidInput
void require_sewable(const garment::Pattern& pattern, double edge, const DrapeFiles& files)
{
    std::string word = "meshing";
    try {
        const MeshReport report = mesh_report_on(pattern, edge);
        if (const std::string failure = failure_of(report); !failure.empty()) {
            word = report.outcome();
            throw InvalidInput(failure);
        }
    } catch (const InvalidInput& error) {
        files.write_refusal({word, error.what()});
        throw;
    }
}

/// Reads the garments, and makes sure that they can be sewn. @throws InvalidInput
std::vector<garment::Pattern> sewable_patterns(const DrapeOptions& options, const DrapeFiles& files)
{
    std::vector<garment::Pattern> patterns;
    for (const std::filesystem::path& file : options.garments)
        patterns.push_back(read_pattern(file, files));
    files.require_safe(patterns, options.avatar, options.clip);
    for (const garment::Pattern& pattern : patterns)
        require_sewable(pattern, options.settings.edge, files);
    return patterns;
}

/// Drapes with a progress line. What the drape refuses of the garment is reported in the folder too.
scenes::DrapeResult drape_with_progress(DrapeOptions& options, const DrapeFiles& files,
                                        const InterruptGuard& interrupt)
{
    SetupProgress progress(options.quiet);
    DrapeProgressLine line(progress);
    scenes::WorldOptions world;
    world.progress = [&](const std::string& task, double fraction) { line.update_world(task, fraction); };
    world.goes_on = [&] { return !interrupt.requested(); };
    world.warn = [&](const std::string& text) { progress.warn(text); };
    options.settings.progress = [&](const scenes::DrapeProgress& now) { line.update(now); };
    try {
        return scenes::drape(options.settings, world);
    } catch (const InvalidInput& error) {
        // Errors begin with the file at fault: the garment, or the avatar, which is no class of garments.
        const std::string text = error.what();
        if (std::any_of(options.garments.begin(), options.garments.end(),
                        [&](const auto& file) { return text.starts_with(file.string()); }))
            files.write_refusal({"pattern", text});
        throw;
    }
}

int drape(DrapeOptions options)
{
    require_valid(options);
    const ThreadLimit threads(options.threads);
    const DrapeFiles files(options.garments, options.folder);
    const std::vector<garment::Pattern> patterns = sewable_patterns(options, files);
    complete(options, files);
    const scenes::DrapeSettings& settings = options.settings;
    const Continuation continuation = continuation_of(settings.body, options.clip);

    // Drape, and certify what rests.
    const RunLog log(options.quiet);
    const exports::FolderLock lock = files.lock(log);
    const InterruptGuard interrupt;
    DrapeReport report;
    report.result = drape_with_progress(options, files, interrupt);
    files.write_garment(continuation, report.result, log);
    report.verdict = verdict_of(report.result);
    if (report.verdict.is_draped()) {
        const std::optional<Certificate> certificate = files.write_certificate(log, interrupt);
        if (!certificate) {
            log.error("interrupted before the drape was certified");
            return kExitFailure;
        }
        report.verdict = verdict_of(*certificate, report.result.garments);
    }

    // Report it.
    for (size_t g = 0; g < report.result.garments.size(); ++g) {
        const scenes::GarmentSurface& surface = report.result.garments[g].surface;
        if (!surface.mesh.positions.empty())
            report.measures.push_back(measure_garment(surface, patterns[g], settings.garments[g].fabric));
    }
    files.write_report(report, patterns, log);
    files.write_picture(settings, log);
    if (report.result.outcome == scenes::DrapeOutcome::Draped)
        try {
            files.write_fit(report.result, patterns, settings, log);
        } catch (const InvalidInput& error) {
            log.note(std::string("the fit was not measured: ") + error.what());
        }
    log.result(summary_of(report));
    if (report.verdict.is_draped()) {
        log.result("simulate it on by: toile simulate " + files.scene().string() + " -o " +
                   files.simulated().string());
        return kExitOk;
    }
    log.error(report.verdict.word + ": " + report.verdict.message);
    return kExitFailure;
}

} // namespace

Command add_drape(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("drape", "Sew patterns around a body and drape them");
    auto options = std::make_shared<DrapeOptions>();
    CLI::App& add = *command.options;
    add.add_option("garments", options->garments, "Garment files or panel JSON, innermost first")->required();
    add.add_option("--avatar", options->avatar,
                   "Body, .obj, .glb, .gltf or .fbx, in its bind pose; without it the built-in mannequin");
    add.add_option("--clip", options->clip.clip,
                   "Clip of the body, or of --motion, that the written scene plays");
    CLI::Option* motion = add.add_option("--motion", options->clip.motion,
                                         "Clip from a .bvh, .fbx, .glb or .gltf file for the written scene");
    add.add_option("--map", options->clip.map, "Joints of --motion: names, cmu or a .json file")
        ->capture_default_str()
        ->needs(motion);
    add.add_option("--fabric", options->fabrics,
                   "Preset for panels without a fabric: one for all garments, or one for each, by commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    add.add_option("--edge", options->settings.edge, "Edge length of the final meshes [m]")
        ->capture_default_str();
    add.add_option("--shift", options->shift, "x,y,z added to the placement of the panels [m]")
        ->delimiter(',')
        ->expected(3);
    options->settings.time_limit = kTimeLimit;
    add.add_option("--time-limit", options->settings.time_limit, "Ends the drape after these seconds")
        ->capture_default_str();
    add.add_option("-o,--output", options->folder, "Folder of the results [out/NAME]");
    add.add_option("--threads", options->threads, "CPU threads; 0: all")->capture_default_str();
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return drape(*options); };
    return command;
}

} // namespace toile::app
