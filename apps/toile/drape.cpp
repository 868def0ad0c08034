#include <algorithm>
#include <cctype>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/run_log.h"
#include "apps/toile/terminal/setup_progress.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "core/compute/parallel.h"
#include "scenes/drape/drape.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;

struct DrapeOptions {
    scenes::DrapeSettings settings;
    std::filesystem::path avatar;
    std::vector<double> shift;
    std::filesystem::path folder; ///< empty: out/NAME
    int threads = 0;
    bool quiet = false;
};

/// Name of the garment: that of its file, with what can't name a cloth replaced.
std::string name_of(const std::filesystem::path& file)
{
    std::string name = file.stem().string();
    if (name.ends_with(".garment"))
        name.resize(name.size() - std::string(".garment").size());
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; }, '_');
    return name.empty() ? "garment" : name;
}

const char* to_word(scenes::DrapeOutcome outcome)
{
    switch (outcome) {
    case scenes::DrapeOutcome::Placement:
        return "placement";
    case scenes::DrapeOutcome::Tangled:
        return "tangled";
    case scenes::DrapeOutcome::NotAtRest:
        return "not at rest";
    case scenes::DrapeOutcome::SlidOff:
        return "slid off";
    case scenes::DrapeOutcome::Solver:
        return "solver";
    case scenes::DrapeOutcome::Draped:
        break;
    }
    return "draped";
}

std::string report_of(const scenes::DrapeResult& result)
{
    Json json = {{"class", to_word(result.outcome)}, {"message", result.message}};
    for (const scenes::DrapeStage& stage : result.stages)
        json["stages"].push_back({{"name", stage.name},
                                  {"seconds", stage.seconds},
                                  {"frames", stage.frames},
                                  {"vertices", stage.vertices}});
    json["pieces"] = result.pieces;
    json["border_loops"] = result.border_loops;
    json["euler_characteristic"] = result.euler_characteristic;
    for (const scenes::DrapeSeam& seam : result.seams)
        json["seams"].push_back({{"name", seam.name}, {"gap_before_weld_m", seam.gap}});
    for (const scenes::DrapeSlide& slide : result.slides)
        json["slid_m"][slide.label] = slide.slid;
    json["rest_speed_m_s"] = result.rest_speed;
    json["max_strain"] = result.max_strain;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The scene that simulates the garment on, for two seconds.
std::string scene_text(const DrapeOptions& options, const scenes::DrapeResult& result)
{
    const std::string& name = options.settings.name;
    Json json = {{"toile", 1}, {"name", name + ", draped"}, {"frames", 60}};
    Json avatar = {{"name", options.settings.body.name}};
    if (options.avatar.empty())
        avatar["mannequin"] = Json::object();
    else
        avatar["file"] = std::filesystem::absolute(options.avatar).string();
    json["avatars"] = {avatar};
    json["cloths"] = {{{"name", name},
                       {"file", name + ".obj"},
                       {"weld", false},
                       {"rest", "uv"},
                       {"uv_scale", 1.0},
                       {"fabric", result.scene.cloths.at(0).fabric}}};
    for (const scene::Attachment& attachment : result.scene.attachments)
        json["attachments"].push_back(
            {{"cloth", name},
             {"select", {{"vertices", std::get<std::vector<int>>(attachment.select.by)}}},
             {"to", attachment.to}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

scenes::WorldOptions world_options(SetupProgress& progress, const InterruptGuard& interrupt)
{
    scenes::WorldOptions options;
    options.progress = [&](const std::string& task, double fraction) { progress.update(task, fraction); };
    options.goes_on = [&] { return !interrupt.requested(); };
    options.warn = [&](const std::string& text) { progress.warn(text); };
    return options;
}

void prepare_files(DrapeOptions& options)
{
    scenes::DrapeSettings& settings = options.settings;
    settings.name = name_of(settings.garment);
    if (options.folder.empty())
        options.folder = std::filesystem::path("out") / settings.name;
    settings.folder = options.folder / "stages";
    FilePlan plan;
    plan.add_input(settings.garment, "the garment");
    if (!options.avatar.empty())
        plan.add_input(options.avatar, "the avatar");
    for (const std::string& file :
         {settings.name + ".obj", std::string("scene.json"), std::string("drape.json")})
        plan.add_output(options.folder / file, "the draped garment");
    require_writable_folder(settings.folder);
}

int drape(DrapeOptions options)
{
    const ThreadLimit threads(options.threads);
    scenes::DrapeSettings& settings = options.settings;
    prepare_files(options);
    settings.body.name = "body";
    if (options.avatar.empty())
        settings.body.shape = scene::Mannequin{};
    else
        settings.body.shape = options.avatar;
    if (!options.shift.empty())
        settings.shift = Vec3(options.shift[0], options.shift[1], options.shift[2]);

    const RunLog log(options.quiet);
    const InterruptGuard interrupt;
    scenes::DrapeResult result;
    {
        SetupProgress progress(options.quiet);
        result = scenes::drape(settings, world_options(progress, interrupt));
    }
    const std::filesystem::path report = options.folder / "drape.json";
    write_atomically(report, report_of(result));
    if (!result.mesh.positions.empty()) {
        const std::filesystem::path mesh = options.folder / (settings.name + ".obj");
        write_obj(mesh, result.mesh);
        log.file(mesh);
    }
    log.file(report);
    if (result.outcome != scenes::DrapeOutcome::Draped) {
        log.error(std::string(to_word(result.outcome)) + ": " + result.message);
        return kExitFailure;
    }
    const std::filesystem::path scene = options.folder / "scene.json";
    write_atomically(scene, scene_text(options, result));
    log.file(scene);
    return kExitOk;
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
    add.add_option("--fabric", options->settings.fabric, "Preset for panels without a fabric")
        ->capture_default_str();
    add.add_option("--edge", options->settings.edge, "Edge length of the final mesh [m]")
        ->capture_default_str();
    add.add_option("--shift", options->shift, "x,y,z added to the placement of the panels [m]")
        ->delimiter(',')
        ->expected(3);
    add.add_option("-o,--output", options->folder, "Folder of the results [out/NAME]");
    add.add_option("--threads", options->threads, "CPU threads; 0: all")->capture_default_str();
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return drape(*options); };
    return command;
}

} // namespace toile::app
