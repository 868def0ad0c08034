#include <iostream>
#include <memory>
#include <optional>

#include "apps/toile/check/certify.h"
#include "apps/toile/terminal/cache_files.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "export/cache_format.h"
#include "export/cache_writer.h"
#include "export/folder_lock.h"
#include "export/point_cache.h"

namespace toile::app {

namespace {

/// Rate [frames/s] of a cache that has none, where the format written stores times.
constexpr double kUsualFps = 24.0;
constexpr double kMinFps = 0.001, kMaxFps = 10000.0;

/// Largest coordinate that is written: far below what single precision holds.
constexpr double kMaxCoordinate = 1e30;

/// Unit and upward axis of the numbers in a cache.
struct Axes {
    std::string unit = "m", up = "y";

    /// @param unit_option, up_option  that give them, for errors
    void require_known(const std::string& unit_option, const std::string& up_option) const
    {
        if (unit != "m" && unit != "cm")
            throw InvalidInput(unit_option + " " + unit + ": is no unit of caches; write m or cm");
        if (up != "y" && up != "z")
            throw InvalidInput(up_option + " " + up + ": is no upward axis; write y or z");
    }
    double scale() const { return unit == "cm" ? 100.0 : 1.0; } ///< numbers per metre
    bool has_z_up() const { return up == "z"; }
};

Vec3 z_up(const Vec3& x) { return {x.x(), -x.z(), x.y()}; }
Vec3 y_up(const Vec3& x) { return {x.x(), x.z(), -x.y()}; }

struct ConvertOptions {
    std::filesystem::path input, output;
    std::filesystem::path mesh; ///< faces of a cache without any; empty: none
    std::optional<double> fps, start_frame;
    Axes from, to;
    bool quiet = false;
};

/// Changes unit and axes of a frame. Equal ones leave its bits.
/// @throws InvalidInput for numbers that no cache can hold
void change_axes(const ConvertOptions& options, int frame, std::vector<Vec3>& positions)
{
    const double scale = options.to.scale() / options.from.scale();
    for (size_t v = 0; v < positions.size(); ++v) {
        Vec3& x = positions[v];
        if (options.from.has_z_up() != options.to.has_z_up())
            x = options.to.has_z_up() ? z_up(x) : y_up(x);
        if (scale != 1.0)
            x *= scale;
        if (!(x.cwiseAbs().maxCoeff() < kMaxCoordinate))
            throw InvalidInput(options.input.string() + ": vertex " + std::to_string(v) + " of frame " +
                               std::to_string(frame) + " is not finite, or beyond 1e30; export it again");
    }
}

/// Faces, texture coordinates and groups of the cache or of --mesh; none if it has none.
ObjMesh faces_of(const ConvertOptions& options, const exports::PointCache& cache)
{
    if (options.mesh.empty())
        return cache.mesh() ? *cache.mesh() : ObjMesh{};
    ObjMesh mesh = read_obj(options.mesh);
    if (int(mesh.positions.size()) != cache.vertex_count())
        throw InvalidInput(options.mesh.string() + ": has " + std::to_string(mesh.positions.size()) +
                           " vertices and the cache " + std::to_string(cache.vertex_count()) +
                           "; name the mesh that it was made for");
    return mesh;
}

double fps_of(const ConvertOptions& options, const exports::PointCache& cache)
{
    if (options.fps)
        return *options.fps;
    const exports::CacheFormat format = exports::cache_format(options.output);
    const bool stores_times = format == exports::CacheFormat::Abc || format == exports::CacheFormat::Mdd;
    if (!cache.fps() && stores_times && cache.frame_count() > 1 && !options.quiet)
        std::cerr << "toile: " << options.input.string()
                  << ": has no frame rate; taken to be 24 a second (--fps)\n";
    return cache.fps().value_or(kUsualFps);
}

void require_faces(const ConvertOptions& options, const exports::CacheLayout& layout)
{
    if (exports::stores_faces(exports::cache_format(options.output)) && layout.faces.polygons.empty())
        throw InvalidInput(options.input.string() + ": has no faces, which " + options.output.string() +
                           " needs; name the mesh that it plays on with --mesh");
}

/// Refuses an output that would replace what is read, or is no file.
/// @param layout  with which make_cache_writer() is content
void require_safe_output(const ConvertOptions& options, const exports::CacheLayout& layout)
{
    const bool is_numbered = exports::cache_format(options.output) == exports::CacheFormat::Obj;
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

int convert(const ConvertOptions& options)
{
    options.from.require_known("--from-unit", "--from-up");
    options.to.require_known("--unit", "--up");
    const exports::PointCache cache = exports::read_cache(options.input);
    if (cache.frame_count() == 0)
        throw InvalidInput(options.input.string() + ": has no frame; nothing is there to be converted");

    exports::CacheLayout layout;
    layout.vertex_count = cache.vertex_count();
    layout.frame_count = cache.frame_count();
    layout.faces = faces_of(options, cache);
    layout.faces.positions.clear();
    layout.fps = fps_of(options, cache);
    layout.start_frame = options.start_frame.value_or(cache.start_frame());
    require_faces(options, layout);
    const std::unique_ptr<exports::CacheWriter> writer = exports::make_cache_writer(options.output, layout);
    require_safe_output(options, layout);
    const exports::FolderLock lock(options.output.parent_path());
    Progress progress("convert", cache.frame_count(), options.quiet);
    for (int k = 0; k < cache.frame_count(); ++k) {
        std::vector<Vec3> positions = cache.frame(k);
        change_axes(options, k, positions);
        writer->write(k, positions);
        progress.update(k + 1);
    }
    writer->complete();
    remove_certificates(options);
    writer->publish();
    std::cout << options.output.string() << "\n";
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
                   "Cache: .pc2, .mdd, .obj or .abc; a mesh in an archive by a path behind #")
        ->required();
    add.add_option("output", options->output, "Cache to write: .pc2, .mdd, .obj or .abc")->required();
    add.add_option("--mesh", options->mesh, "OBJ with the faces of a .pc2 or .mdd, which have none");
    add.add_option("--fps", options->fps, "Frames per second; without it the cache's")
        ->check(CLI::Range(kMinFps, kMaxFps));
    add.add_option("--start-frame", options->start_frame,
                   "Number of the first frame; without it the cache's");
    add.add_option("--from-unit", options->from.unit, "Unit of the numbers read: m or cm");
    add.add_option("--from-up", options->from.up, "Upward axis of the numbers read: y or z");
    add.add_option("--unit", options->to.unit, "Unit of the numbers written: m or cm");
    add.add_option("--up", options->to.up, "Upward axis of the numbers written: y or z");
    add.add_flag("--quiet", options->quiet, "No progress and no notes");
    command.run = [options] { return convert(*options); };
    return command;
}

} // namespace toile::app
