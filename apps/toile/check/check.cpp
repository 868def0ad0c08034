#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "apps/toile/caches/cache_contents.h"
#include "apps/toile/caches/cache_files.h"
#include "apps/toile/caches/exports.h"
#include "apps/toile/caches/unlisted.h"
#include "apps/toile/caches/written_exports.h"
#include "apps/toile/check/cache_cloth.h"
#include "apps/toile/check/certify.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/scene_inputs.h"
#include "apps/toile/terminal/setup_progress.h"
#include "core/base/atomic_file.h"
#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "core/base/long_work.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/folder_lock.h"
#include "export/sequence/numbered_files.h"
#include "scenes/format/read_scene.h"
#include "scenes/format/validate.h"
#include "scenes/surfaces/load_cloth.h"

namespace toile::app {

namespace {

struct CheckOptions {
    std::vector<std::filesystem::path> caches; ///< or one folder of them
    std::filesystem::path scene;
    std::filesystem::path output; ///< empty: next to the caches, and standard output
    std::string cloth;
    CertificateLimits limits;
    std::optional<int> frames;
    UnlistedOptions unlisted;
    bool quiet = false;
};

/// Whether a cache of this name exists, as a file or as numbered ones.
bool cache_exists(const std::filesystem::path& file)
{
    return std::filesystem::exists(file) || (exports::features_of(exports::cache_format(file)).numbered &&
                                             !exports::NumberedFiles(file).existing().empty());
}

/// Caches written by simulate into a folder, one per cloth; missing ones are omitted.
std::vector<ClothInCache> caches_in(const std::filesystem::path& folder, const scenes::Scene& scene)
{
    std::string searched;
    std::vector<scene::Export> entries;
    std::vector<std::filesystem::path> files;
    for (const scene::Export& entry : exports_of(scene)) {
        searched += (searched.empty() ? "" : ", ") + entry.file.string();
        std::filesystem::path file = folder / entry.file.lexically_normal();
        if (scene.frames > 1 && exports::features_of(exports::cache_format(file)).numbered)
            file = exports::NumberedFiles(file).pattern(); // skirt.obj may be the start mesh beside skirt.pc2
        if (!cache_exists(file))
            continue;
        entries.push_back(entry);
        entries.back().start_frame = start_frame_of(entry);
        files.push_back(file);
    }
    std::vector<ClothInCache> caches;
    for (int surface = 0; surface < simulated_count(scene); ++surface)
        if (const std::optional<size_t> checked = export_to_check(scene, entries, surface))
            caches.push_back({files[*checked], entries[*checked], surface});
    if (caches.empty())
        throw InvalidInput(folder.string() + ": has no cache of " + scene.source.string() + "; looked for " +
                           searched + "; name other caches, such as those of simulate --export, one by one");
    return caches;
}

/// Gives a scene the exports of the run that wrote into a folder, which its certificate has: those of
/// `simulate --export` are not in the scene.
void use_exports_of_run(const std::filesystem::path& folder, scenes::Scene& scene)
{
    const std::filesystem::path certificate = folder / kCertificateName;
    const std::optional<std::vector<scene::Export>> exports = exports_in(certificate);
    if (!exports || exports->empty())
        return;
    scene.exports = *exports;
    try {
        require_valid(scene);
    } catch (const InvalidInput& error) {
        throw InvalidInput(certificate.string() +
                           ": its exports do not suit the scene; name the caches one by one (" +
                           error.what() + ")");
    }
}

/// A path from the folder of a certificate.
std::filesystem::path from_certificate(const std::filesystem::path& certificate,
                                       const std::filesystem::path& file)
{
    const auto whole = [](const std::filesystem::path& path) {
        return std::filesystem::absolute(path).lexically_normal();
    };
    return whole(file).lexically_proximate(whole(certificate).parent_path());
}

/// Exports of a run into `folder`, with their files from the folder of the certificate.
std::vector<scene::Export> exports_in_folder(const std::filesystem::path& certificate,
                                             const std::filesystem::path& folder,
                                             std::vector<scene::Export> exports)
{
    for (scene::Export& entry : exports)
        entry.file = from_certificate(certificate, folder / entry.file);
    return exports;
}

/// The caches as exports of a run whose folder is that of the certificate.
std::vector<scene::Export> exports_beside(const std::filesystem::path& certificate,
                                          const std::vector<ClothInCache>& caches,
                                          const std::vector<std::string>& names)
{
    std::vector<scene::Export> exports;
    for (const ClothInCache& cache : caches) {
        const std::string& name = names[size_t(cache.surface)];
        const std::filesystem::path file = from_certificate(certificate, exports::archive_of(cache.file));
        const auto same = std::find_if(exports.begin(), exports.end(),
                                       [&](const auto& other) { return other.file == file; });
        if (same != exports.end()) {
            same->cloths.push_back(name);
            continue;
        }
        exports.push_back(cache.entry);
        exports.back().file = file;
        exports.back().cloths = {name};
    }
    return exports;
}

/// Pairs each cache with its cloths.
std::vector<ClothInCache> named_caches(const std::vector<std::filesystem::path>& files,
                                       const scenes::Scene& scene, const std::string& named,
                                       const scene::Export& unlisted)
{
    std::vector<ClothInCache> caches;
    for (const std::filesystem::path& file : files)
        for (const ClothInCache& cloth : cloths_of_cache(scene, file, named, unlisted)) {
            if (cloth.surface >= simulated_count(scene))
                continue; // follows a soft body, whose own surface is checked
            for (const ClothInCache& other : caches)
                if (other.surface == cloth.surface)
                    throw InvalidInput(file.string() + ": is of the same cloth \"" +
                                       scenes::surface_names(scene)[size_t(cloth.surface)] + "\" as " +
                                       other.file.string() + "; give one cache of each cloth");
            caches.push_back(cloth);
        }
    if (caches.empty())
        throw InvalidInput(files.front().string() +
                           ": has only a render surface, which nothing collides with; check the cache of its "
                           "soft body");
    return caches;
}

/// Path next to the caches: NAME.certificate.json for one, certificate.json for several or a folder.
std::filesystem::path certificate_path_of(const CheckOptions& options)
{
    if (!options.output.empty())
        return options.output;
    const std::filesystem::path first = exports::archive_of(options.caches.front());
    if (std::filesystem::is_directory(first))
        return first / kCertificateName;
    if (options.caches.size() > 1)
        return first.parent_path() / kCertificateName;
    return certificate_beside(first);
}

/// Refuses a certificate that would replace a file that it is made from, or could not be written.
void require_safe_output(const std::filesystem::path& file, const scenes::Scene& scene,
                         const std::vector<ClothInCache>& caches)
{
    FilePlan plan;
    add_inputs(plan, scene);
    for (const ClothInCache& cache : caches)
        add_cache_input(plan, cache.file, "a cache to check");
    plan.add_output(file, "the certificate");
    require_writable(file);
}

std::vector<scenes::ClothState> load_surfaces(const scenes::Scene& scene, const RunLog& log,
                                              const InterruptGuard& interrupt)
{
    const std::function<bool()> goes_on = [&] { return !interrupt.requested(); };
    const Cancellation::Scope cancellation(goes_on);
    SetupProgress progress(log.quiet());
    const LongWork::Scope loading(
        [&](const LongWork::Progress& now) { progress.update("loading the cloths", now.fraction); });
    return scenes::load_surfaces(scene);
}

int check(const CheckOptions& options)
{
    if (!(options.limits.penetration >= 0.0) || !(options.limits.strain_margin >= 0.0))
        throw InvalidInput("--penetration and --strain-margin must be 0 or more");
    const bool is_folder = options.caches.size() == 1 && std::filesystem::is_directory(options.caches[0]);
    if (!options.cloth.empty() && (is_folder || options.caches.size() > 1))
        throw InvalidInput("--cloth: names the cloth of a single cache; name the caches after their cloths");
    for (const std::filesystem::path& cache : options.caches)
        if (!cache.has_extension() && exports::mesh_path_of(cache).empty() && !std::filesystem::exists(cache))
            throw InvalidInput(cache.string() + ": no such folder; check the path");
    scenes::Scene scene = scenes::read_scene(options.scene);
    scene.frames = options.frames.value_or(scene.frames);
    if (is_folder)
        use_exports_of_run(options.caches[0], scene);
    const std::vector<ClothInCache> caches =
        is_folder ? caches_in(options.caches[0], scene)
                  : named_caches(options.caches, scene, options.cloth, options.unlisted.entry());
    const std::filesystem::path output = certificate_path_of(options);
    scene.exports = is_folder ? exports_in_folder(output, options.caches[0], exports_of(scene))
                              : exports_beside(output, caches, surface_names(scene));
    require_safe_output(output, scene, caches);
    const InterruptGuard interrupt;
    const RunLog log(options.quiet);
    // A run must not replace the caches before their certificate lies beside them.
    std::optional<exports::FolderLock> lock;
    if (options.output.empty())
        lock.emplace(output.parent_path(), [&](const std::string& text) { log.note("warning: " + text); });
    const std::vector<scenes::ClothState> surfaces = load_surfaces(scene, log, interrupt);
    std::vector<CachedCloth> cloths;
    cloths.reserve(caches.size());
    for (const ClothInCache& cache : caches) {
        const scenes::ClothState& cloth = surfaces[size_t(cache.surface)];
        cloths.push_back({&cloth, cache.file, open_cloth(cache.file, cache.entry, cloth)});
    }
    const std::optional<Certificate> certificate = certify(scene, cloths, options.limits, log, interrupt);
    if (!certificate)
        throw Cancelled("interrupted");
    if (options.output.empty())
        std::cout << to_json(*certificate);
    write_atomically(output, to_json(*certificate));
    return conclude(*certificate, output, log);
}

} // namespace

Command add_check(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand(
        "check", "Certify caches: crossings, penetration, strain, finite numbers, every frame");
    auto options = std::make_shared<CheckOptions>();
    CLI::App& add = *command.options;
    add.add_option("caches", options->caches,
                   "Caches (" + readable_extensions() + "), one of each cloth, or their folder")
        ->required();
    add.add_option("--scene", options->scene, "Scene that they were made from")->required();
    add.add_option("-o,--output", options->output, "Write the JSON here [beside the caches, and to stdout]");
    add.add_option("--cloth", options->cloth, "Cloth of a single cache [from the cache's name]");
    add.add_option("--penetration", options->limits.penetration, "Accepted depth inside an avatar [m]")
        ->capture_default_str();
    add.add_option("--strain-margin", options->limits.strain_margin,
                   "Accepted strain beyond the fabric's limit")
        ->capture_default_str();
    add.add_option("--frames", options->frames, "Number of frames that the caches must have [the scene's]")
        ->check(CLI::Range(1, 1000000));
    options->unlisted.add_to(add);
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return check(*options); };
    return command;
}

} // namespace toile::app
