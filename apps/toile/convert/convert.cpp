#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "apps/toile/caches/cache_files.h"
#include "apps/toile/caches/exported_mesh.h"
#include "apps/toile/check/certify.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "core/base/number.h"
#include "export/axes.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/cache_writer.h"
#include "export/folder_lock.h"
#include "export/point_cache.h"
#include "export/times/resampled_cache.h"

namespace toile::app {

namespace {

/// Rate [frames/s] of a cache that has none, where the format written stores times.
constexpr double kUsualFps = 24.0;
constexpr double kMinFps = 0.001, kMaxFps = 10000.0;

constexpr double kMaxThickness = 0.1; ///< [m]

/// Largest coordinate that is written: far below what single precision holds.
constexpr double kMaxCoordinate = 1e30;

struct ConvertOptions {
    std::filesystem::path input, output;
    std::filesystem::path mesh; ///< faces of a cache without any; empty: none
    std::string fps;            ///< empty: the cache's
    std::optional<double> start_frame;
    std::string from_unit, from_up; ///< empty: the cache's
    exports::Axes to;
    bool normals = false, no_velocities = false, no_weld = false;
    bool avatars = false;                                ///< refused
    std::optional<double> thickness;                     ///< [m]
    std::optional<int> subframes;                        ///< empty: the cache's
    double max_error = exports::CacheLayout{}.max_error; ///< [m]
    bool quiet = false;
};

/// @param unit_option, up_option  that give them, for errors
void require_known(const exports::Axes& axes, const std::string& unit_option, const std::string& up_option)
{
    if (axes.unit != "m" && axes.unit != "cm")
        throw InvalidInput(unit_option + " " + axes.unit + ": is no unit of caches; write m or cm");
    if (axes.up != "y" && axes.up != "z")
        throw InvalidInput(up_option + " " + axes.up + ": is no upward axis; write y or z");
}

exports::Axes axes_of(const ConvertOptions& options, const std::optional<exports::Axes>& stored)
{
    exports::Axes axes = stored.value_or(exports::Axes{});
    if (!options.from_unit.empty())
        axes.unit = options.from_unit;
    if (!options.from_up.empty())
        axes.up = options.from_up;
    return axes;
}

/// Refuses options that no cache can follow, or that the output has no place for.
void require_possible(const ConvertOptions& options)
{
    const exports::CacheFeatures features = exports::features_of(exports::cache_format(options.output));
    if (options.avatars)
        throw InvalidInput("--avatars: a cache has no avatars but the meshes in it; simulate --export FILE "
                           "--avatars writes those of a scene");
    if (options.thickness && !(*options.thickness > 0.0 && *options.thickness <= kMaxThickness))
        throw InvalidInput("--thickness " + short_text(*options.thickness) +
                           ": is no thickness of cloth; give metres, above 0 and up to 0.1");
    if (options.thickness && !features.faces)
        throw InvalidInput(
            "--thickness: " + options.output.string() +
            " stores no faces, and closing a sheet makes new ones; write an .abc, .usda or .obj");
    if (options.no_weld && !features.several)
        throw InvalidInput("--no-weld: " + options.output.string() +
                           " holds one mesh; write an .abc or .usda");
}

/// @throws InvalidInput for numbers that no cache can hold
void require_finite(const std::filesystem::path& file, int frame, const std::vector<Vec3>& positions)
{
    for (size_t v = 0; v < positions.size(); ++v)
        if (!(positions[v].cwiseAbs().maxCoeff() < kMaxCoordinate))
            throw InvalidInput(file.string() + ": vertex " + std::to_string(v) + " of frame " +
                               std::to_string(frame) + " is not finite, or beyond 1e30; export it again");
}

/// A mesh of the input, and what becomes of it.
struct InputMesh {
    std::filesystem::path path;
    exports::PointCache cache;
    std::optional<ExportedMesh> exported = std::nullopt; ///< once its faces are known
};

bool have_same_times(const exports::PointCache& a, const exports::PointCache& b)
{
    return a.frame_count() == b.frame_count() && a.fps() == b.fps() && a.subframes() == b.subframes() &&
           a.start_frame() == b.start_frame();
}

std::string times_text(const exports::PointCache& cache)
{
    return std::to_string(cache.frame_count()) + " samples from frame " + short_text(cache.start_frame()) +
           (cache.fps() ? " at " + short_text(*cache.fps()) + " a second" : "");
}

/// Rate of --fps; none without it.
std::optional<double> given_fps(const ConvertOptions& options)
{
    if (options.fps.empty())
        return std::nullopt;
    const double fps = quotient_in(options.fps).value_or(0.0);
    if (!(fps >= kMinFps && fps <= kMaxFps))
        throw InvalidInput("--fps " + options.fps +
                           ": is no rate; write a number from 0.001 to 10000, or two as 24000/1001");
    return fps;
}

/// A mesh of the input at regular times.
exports::PointCache open_mesh(const std::filesystem::path& mesh, const ConvertOptions& options)
{
    exports::PointCache cache = exports::read_cache(mesh);
    if (cache.times().empty())
        return cache;
    const std::optional<double> fps = given_fps(options);
    if (!fps)
        throw InvalidInput(mesh.string() + ": has samples at irregular times, from " +
                           short_text(cache.times().front()) + " to " + short_text(cache.times().back()) +
                           " s; give --fps to resample it at this rate");
    exports::PointCache frames = exports::resampled(cache, *fps, mesh);
    if (!options.quiet)
        std::cerr << "toile: " << mesh.string() << ": " << cache.frame_count()
                  << " samples at irregular times, resampled as " << frames.frame_count() << " frames from "
                  << frames.start_frame() << " at " << options.fps << " a second\n";
    return frames;
}

/// All meshes of the input, with the same frames.
std::vector<InputMesh> open_input(const ConvertOptions& options)
{
    std::vector<InputMesh> meshes;
    for (const std::filesystem::path& path : exports::meshes_of_cache(options.input))
        meshes.push_back({path, open_mesh(path, options)});
    if (meshes.empty() || meshes.front().cache.frame_count() == 0)
        throw InvalidInput(options.input.string() + ": has no " + (meshes.empty() ? "mesh" : "frame") +
                           "; nothing is there to be converted");
    for (const InputMesh& mesh : meshes)
        if (!have_same_times(mesh.cache, meshes.front().cache))
            throw InvalidInput(mesh.path.string() + ": has other frames than " +
                               meshes.front().path.string() + " (" + times_text(mesh.cache) + ", and " +
                               times_text(meshes.front().cache) +
                               "); convert them one by one, each by its path");
    return meshes;
}

/// Faces, texture coordinates and groups of the cache or of --mesh; none if it has none.
ObjMesh faces_of(const ConvertOptions& options, const exports::PointCache& cache)
{
    if (options.mesh.empty())
        return cache.mesh() ? exports::faces_only(*cache.mesh()) : ObjMesh{};
    ObjMesh mesh = read_obj(options.mesh);
    if (int(mesh.positions.size()) != cache.vertex_count())
        throw InvalidInput(options.mesh.string() + ": has " + std::to_string(mesh.positions.size()) +
                           " vertices and the cache " + std::to_string(cache.vertex_count()) +
                           "; name the mesh that it was made for");
    return exports::faces_only(std::move(mesh));
}

double fps_of(const ConvertOptions& options, const exports::PointCache& cache)
{
    if (const std::optional<double> fps = given_fps(options))
        return *fps;
    if (!cache.fps() && exports::features_of(exports::cache_format(options.output)).times &&
        cache.frame_count() > 1 && !options.quiet)
        std::cerr << "toile: " << options.input.string()
                  << ": has no frame rate; taken to be 24 a second (--fps)\n";
    return cache.fps().value_or(kUsualFps);
}

void require_faces(const ConvertOptions& options, const exports::CacheLayout& layout)
{
    if (exports::features_of(exports::cache_format(options.output)).faces &&
        layout.meshes.front().faces.polygons.empty())
        throw InvalidInput(options.input.string() + ": has no faces, which " + options.output.string() +
                           " needs; name the mesh that it plays on with --mesh");
}

/// Refuses an output that would replace what is read, or is no file.
/// @param layout  with which make_cache_writer() is content
void require_safe_output(const ConvertOptions& options, const exports::CacheLayout& layout)
{
    const bool is_numbered = exports::features_of(exports::cache_format(options.output)).numbered;
    const int first = is_numbered ? int(layout.start_frame) : 0;
    FilePlan plan;
    add_cache_input(plan, options.input, "the cache");
    if (!options.mesh.empty())
        plan.add_input(options.mesh, "the mesh");
    add_cache_output(plan, options.output, first, layout.frame_count, "the converted cache");
    require_writable_cache(options.output, first, layout.frame_count);
}

/// Removes certificates of the cache that is about to be replaced: what they say is of that one.
void remove_certificates(const ConvertOptions& options)
{
    const std::filesystem::path of_cache = certificate_beside(options.output);
    for (const std::filesystem::path& file : {of_cache, of_cache.parent_path() / kCertificateName}) {
        std::error_code missing;
        if (std::filesystem::exists(options.output, missing) && std::filesystem::remove(file, missing) &&
            !options.quiet)
            std::cerr << "toile: removed " << file.string() << ", which is of the cache that is replaced\n";
    }
}

/// Name of a mesh and of the group that it lies in, by its path in an archive: /skirt/skirtShape is skirt,
/// and /tee/front/frontShape is front in tee. In USD both lie below the prim that is the whole file.
void name_mesh(exports::CacheMesh& mesh, const std::filesystem::path& path)
{
    const std::filesystem::path above = std::filesystem::path(exports::mesh_path_of(path)).parent_path();
    const bool is_usd = exports::cache_format(path) == exports::CacheFormat::Usd;
    const std::filesystem::path group = above.parent_path();
    mesh.name = above.filename().string();
    mesh.parent = is_usd && !group.parent_path().has_filename() ? "" : group.filename().string();
}

/// Samples of a frame that are written.
int subframes_of(const ConvertOptions& options, const exports::PointCache& cache)
{
    const int subframes = options.subframes.value_or(cache.subframes());
    if (subframes < 1 || cache.subframes() % subframes != 0)
        throw InvalidInput("--subframes " + std::to_string(subframes) + ": " + options.input.string() +
                           " has " + std::to_string(cache.subframes()) +
                           (cache.subframes() == 1 ? " sample" : " samples") +
                           " a frame; give a divisor of that, for samples can only be left out");
    return subframes;
}

/// Samples of the input from one that is written to the next.
int samples_apart(const exports::PointCache& cache, const exports::CacheLayout& layout)
{
    return cache.subframes() / layout.subframes;
}

/// Thickness of each vertex in the units written; empty: none.
std::vector<double> thickness_of(const ConvertOptions& options, const exports::CacheMesh& mesh)
{
    if (!options.thickness)
        return {};
    if (mesh.faces.polygons.empty())
        throw InvalidInput("--thickness: " + options.input.string() +
                           " has no faces; name the mesh that it plays on with --mesh");
    return std::vector<double>(size_t(mesh.vertex_count), *options.thickness / options.to.metres_per_unit());
}

/// Also makes the meshes that the input becomes.
exports::CacheLayout layout_of(const ConvertOptions& options, std::vector<InputMesh>& meshes)
{
    if (!options.mesh.empty() && meshes.size() > 1)
        throw InvalidInput("--mesh: has the faces of one mesh, and " + options.input.string() + " has " +
                           std::to_string(meshes.size()) + "; leave it out");
    const exports::PointCache& first = meshes.front().cache;
    exports::CacheLayout layout;
    for (InputMesh& input : meshes) {
        exports::CacheMesh mesh;
        mesh.vertex_count = input.cache.vertex_count();
        mesh.faces = faces_of(options, input.cache);
        if (!exports::mesh_path_of(input.path).empty())
            name_mesh(mesh, input.path);
        input.exported.emplace(mesh, ExportedMesh::Parts{.weld = !options.no_weld},
                               thickness_of(options, mesh));
        const std::vector<exports::CacheMesh>& written = input.exported->meshes();
        layout.meshes.insert(layout.meshes.end(), written.begin(), written.end());
    }
    layout.subframes = subframes_of(options, first);
    layout.frame_count = (first.frame_count() - 1) / samples_apart(first, layout) + 1;
    layout.fps = fps_of(options, first);
    layout.start_frame = options.start_frame.value_or(first.start_frame());
    layout.axes = options.to;
    layout.velocities = !options.no_velocities;
    layout.normals = options.normals;
    layout.max_error = options.max_error;
    return layout;
}

/// Positions of all meshes in a sample of the input.
std::vector<Vec3> positions_of(const ConvertOptions& options, const std::vector<InputMesh>& meshes, int frame)
{
    std::vector<Vec3> all;
    for (const InputMesh& mesh : meshes) {
        std::vector<Vec3> positions = mesh.cache.frame(frame);
        exports::change_axes(axes_of(options, mesh.cache.axes()), options.to, positions);
        require_finite(mesh.path, frame, positions);
        mesh.exported->append(positions, all);
    }
    return all;
}

int convert(const ConvertOptions& options)
{
    require_known(options.to, "--unit", "--up");
    require_known(axes_of(options, std::nullopt), "--from-unit", "--from-up");
    require_possible(options);
    std::vector<InputMesh> meshes = open_input(options);
    const exports::CacheLayout layout = layout_of(options, meshes);
    require_faces(options, layout);
    const std::unique_ptr<exports::CacheWriter> writer = exports::make_cache_writer(options.output, layout);
    require_safe_output(options, layout);
    const exports::FolderLock lock(options.output.parent_path());
    const int apart = samples_apart(meshes.front().cache, layout);
    Progress progress("convert", layout.frame_count, options.quiet);
    for (int k = 0; k < layout.frame_count; ++k) {
        writer->write(k, positions_of(options, meshes, k * apart));
        progress.update(k + 1);
    }
    writer->complete();
    remove_certificates(options);
    writer->publish();
    const std::string note = writer->note();
    std::cout << options.output.string() << (note.empty() ? "" : ": " + note) << "\n";
    return kExitOk;
}

} // namespace

Command add_convert(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("convert", "Write a cache in another format, unit or rate");
    auto options = std::make_shared<ConvertOptions>();
    CLI::App& add = *command.options;
    add.add_option("input", options->input,
                   "Cache (" + readable_extensions() + "); a mesh in an archive by a path behind #")
        ->required();
    add.add_option("output", options->output,
                   "Cache to write: .pc2, .mdd, .abc, .usda, .usdc, .obj, .ply, .glb or .pvd")
        ->required();
    add.add_option("--mesh", options->mesh, "OBJ with the faces of a .pc2 or .mdd, which have none");
    add.add_option("--fps", options->fps, "Frames per second, also as 24000/1001; without it the cache's");
    add.add_option("--start-frame", options->start_frame,
                   "Number of the first frame; without it the cache's");
    add.add_option("--from-unit", options->from_unit,
                   "Unit of the numbers read: m or cm; without it the file's, or m");
    add.add_option("--from-up", options->from_up,
                   "Upward axis of the numbers read: y or z; without it the file's, or y");
    add.add_option("--unit", options->to.unit, "Unit of the numbers written: m or cm");
    add.add_option("--up", options->to.up, "Upward axis of the numbers written: y or z");
    add.add_flag("--normals", options->normals, "Store normals, creased at seams (.abc, .usda, .usdc)");
    add.add_flag("--no-velocities", options->no_velocities, "Store no velocities (.abc, .usda, .usdc, .pvd)");
    add.add_option("--thickness", options->thickness, "Close each mesh with this thickness [m]");
    add.add_flag("--no-weld", options->no_weld,
                 "Write one mesh for each group of faces (.abc, .usda, .usdc, .glb)");
    add.add_option("--subframes", options->subframes,
                   "Samples per frame, fewer than the cache's; without it the cache's");
    add.add_flag("--avatars", options->avatars)->group("");
    add.add_option("--max-error", options->max_error,
                   "Largest error of a vertex in any frame [m], for outputs that approximate (.glb)")
        ->capture_default_str();
    add.add_flag("--quiet", options->quiet, "No progress and no notes");
    command.run = [options] { return convert(*options); };
    return command;
}

} // namespace toile::app
