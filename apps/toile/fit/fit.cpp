#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/caches/cache_contents.h"
#include "apps/toile/caches/cache_files.h"
#include "apps/toile/caches/unlisted.h"
#include "apps/toile/check/cache_cloth.h"
#include "apps/toile/cloth/skin.h"
#include "apps/toile/fit/fit_files.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/run_log.h"
#include "apps/toile/terminal/scene_inputs.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "core/compute/parallel.h"
#include "export/cache_path.h"
#include "export/point_cache.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"

namespace toile::app {

namespace {

struct FitOptions {
    std::vector<std::filesystem::path> caches;
    std::filesystem::path scene;
    std::filesystem::path folder = "fit";
    std::string cloth;
    int frame = -1; ///< negative: from the end
    int threads = 0;
    UnlistedOptions unlisted;
};

/// A cloth of the scene as a frame of its cache has it.
struct CacheFrame {
    std::filesystem::path cache;
    FittedGarment garment;
    int frame = 0;
};

TriangleMesh skin_at(const scenes::Scene& scene, double time)
{
    std::vector<scenes::SceneBody> bodies = scenes::make_bodies(scene);
    for (scenes::SceneBody& body : bodies)
        body.advance_to(time);
    TriangleMesh skin = skin_of(bodies);
    if (skin.triangles.empty())
        throw InvalidInput(scene.source.string() + ": has no avatar with a skin; a garment fits a body");
    return skin;
}

int frame_of(const exports::PointCache& cache, const std::filesystem::path& file, int asked)
{
    const int count = cache.frame_count(), frame = asked < 0 ? count + asked : asked;
    if (frame < 0 || frame >= count)
        throw InvalidInput("--frame " + std::to_string(asked) + ": " + file.string() + " has frames 0 to " +
                           std::to_string(count - 1) + ", or -1 for the last");
    return frame;
}

CacheFrame read_frame(const scenes::Scene& scene, const std::filesystem::path& file,
                      const FitOptions& options)
{
    const std::vector<ClothInCache> cloths =
        cloths_of_cache(scene, file, options.cloth, options.unlisted.entry());
    if (cloths.size() > 1)
        throw InvalidInput(file.string() + ": has " + std::to_string(cloths.size()) +
                           " cloths; give --cloth with one of them");
    const size_t index = size_t(cloths.front().surface);
    if (index >= scene.cloths.size())
        throw InvalidInput(file.string() + ": is of a solid; only cloths fit a body");
    const scenes::LoadedCloth cloth = unattached_cloth(scene, index);
    const exports::PointCache cache = open_cloth(file, cloths.front().entry, cloth.state);
    require_same_points(cache, file, cloth.state.name, int(cloth.state.file_mesh().positions.size()));
    const int frame = frame_of(cache, file, options.frame);
    const std::vector<Vec3> x = cache.frame_in_metres(frame);
    require_in_range(x, file.string() + ": frame " + std::to_string(frame));
    return {file, fitted_garment(cloth, cloth.state.from_file(x)), frame};
}

/// Refuses results that would replace what is read, or could not be written.
void require_safe(const FitFiles& files, const scenes::Scene& scene, const FitOptions& options)
{
    FilePlan plan;
    add_inputs(plan, scene);
    for (const std::filesystem::path& cache : options.caches)
        plan.add_input(exports::archive_of(cache), "a cache");
    for (const std::filesystem::path& file : files.all()) {
        plan.add_output(file, "a result of the fit");
        require_writable(file);
    }
}

int fit(const FitOptions& options)
{
    if (!options.cloth.empty() && options.caches.size() > 1)
        throw InvalidInput("--cloth: names the cloth of a single cache; name the caches after their cloths");
    const ThreadLimit threads(options.threads);
    const scenes::Scene scene = scenes::read_scene(options.scene);
    std::vector<CacheFrame> frames;
    std::vector<std::string> names;
    for (const std::filesystem::path& cache : options.caches) {
        frames.push_back(read_frame(scene, cache, options));
        names.push_back(frames.back().garment.name);
        if (frames.back().frame != frames.front().frame)
            throw InvalidInput(cache.string() + ": its frame " + std::to_string(options.frame) + " is " +
                               std::to_string(frames.back().frame) + ", that of " +
                               options.caches.front().string() + " " + std::to_string(frames.front().frame) +
                               "; give --frame from the start");
    }
    const FitFiles files(options.folder, names);
    require_safe(files, scene, options);

    const TriangleMesh skin = skin_at(scene, frames.front().frame * scene.frame_duration());
    std::vector<GarmentFit> fits;
    for (CacheFrame& frame : frames)
        fits.push_back(fit_of(std::move(frame.garment), skin, scene.source.string()));
    files.write(fits, skin, RunLog(false));
    return kExitOk;
}

} // namespace

Command add_fit(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("fit", "Measure how garments fit their body at a frame");
    auto options = std::make_shared<FitOptions>();
    CLI::App& add = *command.options;
    add.add_option("caches", options->caches, "Caches (" + readable_extensions() + ") of cloths of the scene")
        ->required();
    add.add_option("--scene", options->scene, "Scene that they were made from")->required();
    add.add_option("--frame", options->frame, "Frame of the caches; negative: from the end")
        ->capture_default_str();
    add.add_option("--cloth", options->cloth, "Cloth of the scene [from the cache's name]");
    options->unlisted.add_to(add);
    add.add_option("-o,--output", options->folder, "Folder of the results")->capture_default_str();
    add.add_option("--threads", options->threads, "CPU threads; 0: all")->capture_default_str();
    command.run = [options] { return fit(*options); };
    return command;
}

} // namespace toile::app
