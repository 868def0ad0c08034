#include <iostream>
#include <memory>
#include <optional>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "export/alembic/abc_cache.h"
#include "export/cache_format.h"
#include "export/cache_writer.h"
#include "export/point_cache.h"

namespace toile::app {

namespace {

/// Rate [frames/s] of a cache that has none, where the format written stores times.
constexpr double kUsualFps = 24.0;

struct ConvertOptions {
    std::filesystem::path input, output;
    std::filesystem::path mesh; ///< faces of a cache without any; empty: none
    std::optional<double> fps, start_frame;
    std::string unit = "m", up = "y";
    bool quiet = false;
};

/// Numbers of the written positions: those of metres with Y up, in another unit and along other axes.
class Axes {
public:
    explicit Axes(const ConvertOptions& options)
        : scale_(options.unit == "cm" ? 100.0 : 1.0), has_z_up_(options.up == "z")
    {
        if (options.unit != "m" && options.unit != "cm")
            throw InvalidInput("--unit " + options.unit + ": is no unit of caches; write m or cm");
        if (options.up != "y" && options.up != "z")
            throw InvalidInput("--up " + options.up + ": is no upward axis; write y or z");
    }
    void apply(std::vector<Vec3>& positions) const
    {
        for (Vec3& x : positions)
            x = scale_ * (has_z_up_ ? Vec3(x.x(), -x.z(), x.y()) : x);
    }

private:
    double scale_;
    bool has_z_up_;
};

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

int convert(const ConvertOptions& options)
{
    const Axes axes(options);
    FilePlan plan;
    plan.add_input(exports::archive_of(options.input), "the cache");
    if (!options.mesh.empty())
        plan.add_input(options.mesh, "the mesh");
    plan.add_output(options.output, "the converted cache");
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
    const std::unique_ptr<exports::CacheWriter> writer = exports::make_cache_writer(options.output, layout);
    Progress progress("convert", cache.frame_count(), options.quiet);
    for (int k = 0; k < cache.frame_count(); ++k) {
        std::vector<Vec3> positions = cache.frame(k);
        axes.apply(positions);
        writer->write(k, positions);
        progress.update(k + 1);
    }
    writer->finish();
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
        ->check(CLI::PositiveNumber);
    add.add_option("--start-frame", options->start_frame,
                   "Number of the first frame; without it the cache's");
    add.add_option("--unit", options->unit, "Unit of the numbers written: m or cm");
    add.add_option("--up", options->up, "Upward axis of the numbers written: y or z");
    add.add_flag("--quiet", options->quiet, "No progress and no notes");
    command.run = [options] { return convert(*options); };
    return command;
}

} // namespace toile::app
