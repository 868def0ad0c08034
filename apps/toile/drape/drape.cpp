#include <cmath>
#include <memory>

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
#include "scenes/garment_format/read_garment.h"

namespace toile::app {

namespace {

/// Default of --time-limit [s].
constexpr double kTimeLimit = 600.0;

struct DrapeOptions {
    scenes::DrapeSettings settings;
    std::filesystem::path avatar;
    ClipOptions clip;
    std::vector<double> shift;
    std::filesystem::path folder; ///< empty: out/NAME
    int threads = 0;
    bool quiet = false;
};

void require_valid(const scenes::DrapeSettings& settings)
{
    require_edge_option(settings.edge);
    garment::fabric_preset(settings.fabric, "--fabric");
    if (!(settings.time_limit > 0.0))
        throw InvalidInput("--time-limit " + short_text(settings.time_limit) +
                           ": must be a positive number of seconds");
}

/// Completes the settings by those of the options that have another form there.
void complete(DrapeOptions& options, const DrapeFiles& files)
{
    scenes::DrapeSettings& settings = options.settings;
    settings.name = files.name();
    settings.folder = files.stages();
    settings.body.name = "body";
    if (options.avatar.empty())
        settings.body.shape = scene::Mannequin{};
    else
        settings.body.shape = options.avatar;
    if (!options.shift.empty())
        settings.shift = Vec3(options.shift[0], options.shift[1], options.shift[2]);
}

/// Reads the garment, and meshes it to know that it can be sewn. A refusal is reported in the folder too.
/// @throws InvalidInput
garment::Pattern sewable_pattern(const DrapeOptions& options, const DrapeFiles& files)
{
    const scenes::DrapeSettings& settings = options.settings;
    garment::Pattern pattern;
    try {
        pattern = garment_format::read_pattern(settings.garment);
    } catch (const InvalidInput& error) {
        if (std::filesystem::exists(settings.garment))
            files.write_refusal({"pattern", error.what()});
        throw;
    }
    files.require_safe(pattern, options.avatar, options.clip);
    std::string word = "meshing";
    try {
        const MeshReport report = mesh_report_on(pattern, settings.edge);
        if (const std::string failure = failure_of(report); !failure.empty()) {
            word = report.outcome();
            throw InvalidInput(failure);
        }
    } catch (const InvalidInput& error) {
        files.write_refusal({word, error.what()});
        throw;
    }
    return pattern;
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
        if (std::string(error.what()).starts_with(options.settings.garment.string()))
            files.write_refusal({"pattern", error.what()});
        throw;
    }
}

int drape(DrapeOptions options)
{
    const scenes::DrapeSettings& settings = options.settings;
    require_valid(settings);
    const ThreadLimit threads(options.threads);
    const DrapeFiles files(settings.garment, options.folder);
    const garment::Pattern pattern = sewable_pattern(options, files);
    complete(options, files);
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
            log.error("interrupted before the garment was certified");
            return kExitFailure;
        }
        report.verdict = verdict_of(*certificate, report.result.surface.mesh);
    }

    // Report it.
    const ObjMesh& mesh = report.result.surface.mesh;
    if (!mesh.positions.empty())
        report.measures = measure_garment(report.result.surface, pattern, settings.fabric);
    files.write_report(report, pattern, log);
    if (!mesh.positions.empty())
        files.write_picture(settings, log);
    if (report.result.outcome == scenes::DrapeOutcome::Draped)
        files.write_fit(report.result, pattern, settings, log);
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
    command.options = parser.add_subcommand("drape", "Sew a pattern around a body and drape it");
    auto options = std::make_shared<DrapeOptions>();
    CLI::App& add = *command.options;
    add.add_option("garment", options->settings.garment, "Garment file or panel JSON")->required();
    add.add_option("--avatar", options->avatar,
                   "Body, .obj, .glb, .gltf or .fbx, in its bind pose; without it the built-in mannequin");
    add.add_option("--clip", options->clip.clip,
                   "Clip of the body, or of --motion, that the written scene plays");
    CLI::Option* motion = add.add_option("--motion", options->clip.motion,
                                         "Clip from a .bvh, .fbx, .glb or .gltf file for the written scene");
    add.add_option("--map", options->clip.map, "Joints of --motion: names, cmu or a .json file")
        ->capture_default_str()
        ->needs(motion);
    add.add_option("--fabric", options->settings.fabric, "Preset for panels without a fabric")
        ->capture_default_str();
    add.add_option("--edge", options->settings.edge, "Edge length of the final mesh [m]")
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
