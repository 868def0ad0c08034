#include <algorithm>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/preview/video.h"
#include "apps/toile/caches/cache_files.h"
#include "apps/toile/caches/exports.h"
#include "apps/toile/caches/unlisted.h"
#include "apps/toile/render/film.h"
#include "apps/toile/render/frame_range.h"
#include "apps/toile/render/map_pictures.h"
#include "apps/toile/render/viewpoint.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "apps/toile/terminal/progress.h"
#include "apps/toile/terminal/scene_inputs.h"
#include "apps/toile/terminal/setup_progress.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "core/base/file_plan.h"
#include "core/base/long_work.h"
#include "core/base/number.h"
#include "export/cache_path.h"
#include "scenes/format/read_scene.h"

namespace toile::app {

namespace {

struct RenderOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path scene;
    std::filesystem::path output;
    std::string frames;
    std::string cloth;
    int sheet = 0; ///< columns; 0: none
    int width = 0; ///< 0: the scene's
    int height = 0;
    int samples = 0;
    std::string turntable_text; ///< number of pictures, or the first input
    int turntable = 0;          ///< pictures around; 0: none
    ViewpointOptions viewpoint;
    MapOptions map;
    bool no_textures = false;
    UnlistedOptions unlisted;
    bool quiet = false;
};

/// Pictures of a turntable in a second.
constexpr double kTurntableFps = 24.0;

/// Pictures of a turntable: where no number is given, and at most.
constexpr int kTurntable = 96, kMaxTurntable = 3600;

bool is_scene(const std::filesystem::path& input) { return lower_case_extension(input) == ".json"; }

Film open_film(const RenderOptions& options, SetupProgress& progress)
{
    const LongWork::Scope loading(
        [&](const LongWork::Progress& now) { progress.update("loading", now.fraction); });
    if (is_scene(options.inputs[0])) {
        if (options.inputs.size() > 1)
            throw InvalidInput(
                options.inputs[1].string() +
                ": can't be rendered together with a scene; write toile render CACHE --scene " +
                options.inputs[0].string());
        scenes::WorldOptions world;
        world.progress = [&](const std::string& task, double fraction) { progress.update(task, fraction); };
        return Film::of_scene(scenes::read_scene(options.inputs[0]), world);
    }
    if (!options.cloth.empty() && options.inputs.size() > 1)
        throw InvalidInput("--cloth: names one cloth, but there are " +
                           std::to_string(options.inputs.size()) + " caches; leave it out");
    return options.scene.empty()
               ? Film::of_caches_with_faces(options.inputs, axes_of(options.unlisted.entry()))
               : Film::of_caches(scenes::read_scene(options.scene), options.inputs, options.cloth,
                                 options.unlisted.entry());
}

void replace_if_given(int& value, int given, const char* option)
{
    if (given < 0 || given > 8192)
        throw InvalidInput(std::string(option) + ": " + std::to_string(given) +
                           " is out of range; give a whole number from 1 to 8192");
    if (given > 0)
        value = given;
}

Film painted_film(const RenderOptions& options)
{
    SetupProgress progress(options.quiet);
    Film film = open_film(options, progress);
    if (!options.no_textures && !options.map.is_given())
        film.paint_bodies([&](const std::string& text) { progress.warn(text); });
    return film;
}

/// Frames to render: the last for a single picture, all for a film, a sheet or a folder.
std::vector<int> chosen_frames(const RenderOptions& options, const Film& film, bool is_single)
{
    const std::string text = options.frames.empty() && is_single ? "-1" : options.frames;
    return parse_frame_range(text, film.frame_count());
}

/// Pictures in the order of their numbers.
struct Shots {
    std::vector<Shot> shots;
    std::vector<int> numbers; ///< [shots] in names of files and on sheets
    double fps = 0.0;
};

/// Frames of a film, or one frame from all around.
Shots chosen_shots(const RenderOptions& options, const Film& film, bool is_picture)
{
    const bool is_single = is_picture || options.turntable > 0;
    const std::vector<int> frames = chosen_frames(options, film, is_single);
    if (is_single && frames.size() > 1)
        throw InvalidInput(is_picture ? options.output.string() + ": is one picture, but --frames chooses " +
                                            std::to_string(frames.size()) +
                                            "; add --sheet COLUMNS, or write to .mp4 or a folder"
                                      : "--turntable: goes around one frame, but --frames chooses " +
                                            std::to_string(frames.size()));
    Shots shots;
    if (options.turntable == 0) {
        const int step = frames.size() > 1 ? frames[1] - frames[0] : 1;
        shots.fps = film.fps() / step;
        shots.numbers = frames;
        for (const int frame : frames)
            shots.shots.push_back({frame});
        return shots;
    }
    shots.fps = kTurntableFps;
    for (int i = 0; i < options.turntable; ++i) {
        shots.numbers.push_back(i);
        shots.shots.push_back({frames[0], 360.0 * i / options.turntable});
    }
    return shots;
}

/// What is written: the film's pictures, or heat maps with their legend.
class Pictures {
public:
    Pictures(Film& film, const RenderOptions& options) : film_(film)
    {
        if (options.map.is_given())
            maps_.emplace(film, options.map, options.quiet);
    }

    preview::Image without_legend(size_t shot) { return maps_ ? maps_->picture(shot) : film_.picture(shot); }
    preview::Image with_legend(const preview::Image& picture, const std::string& caption) const
    {
        return maps_ ? preview::with_colour_bar({&picture, 1}, {&caption, 1}, maps_->legend()) : picture;
    }
    preview::Image operator()(size_t shot)
    {
        return with_legend(without_legend(shot), "frame " + std::to_string(film_.shots()[shot].frame));
    }

private:
    Film& film_;
    std::optional<MapPictures> maps_;
};

preview::Image sheet_of(Pictures& pictures, const Shots& shots, const RenderOptions& options)
{
    Progress progress("picture", int(shots.shots.size()), options.quiet);
    std::vector<preview::Image> taken;
    for (size_t i = 0; i < shots.shots.size(); ++i) {
        taken.push_back(pictures.without_legend(i));
        progress.update(int(i) + 1);
    }
    return pictures.with_legend(contact_sheet(taken, options.sheet, shots.numbers), "");
}

void write_video(Pictures& pictures, const Shots& shots, const std::filesystem::path& file, bool quiet)
{
    preview::require_encoder(file);
    Progress progress("picture", int(shots.shots.size()), quiet);
    const preview::Image first = pictures(0);
    preview::VideoWriter video(file, first.width, first.height, shots.fps);
    for (size_t i = 0; i < shots.shots.size(); ++i) {
        video.write(i == 0 ? first : pictures(i));
        progress.update(int(i) + 1);
    }
    video.finish();
}

/// Numbered picture of a folder.
std::filesystem::path picture_file(const std::filesystem::path& folder, int frame)
{
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04d.png", frame);
    return folder / name;
}

void write_folder(Pictures& pictures, const Shots& shots, const std::filesystem::path& folder, bool quiet)
{
    Progress progress("picture", int(shots.numbers.size()), quiet);
    for (size_t i = 0; i < shots.numbers.size(); ++i) {
        try {
            write_png(picture_file(folder, shots.numbers[i]), pictures(i));
        } catch (const InvalidInput& error) { // at first, nothing is written yet
            if (i > 0)
                throw DeviceError(error.what() + std::string("; the pictures before are written"));
            throw;
        }
        progress.update(int(i) + 1);
    }
}

/// Refuses pictures that would replace a file that they are made from, or could not be written.
void require_safe_output(const RenderOptions& options, const Film& film, const std::filesystem::path& output,
                         const std::vector<int>& numbers)
{
    FilePlan plan;
    for (const std::filesystem::path& input : options.inputs)
        plan.add_input(exports::archive_of(input), "an input");
    if (is_scene(options.inputs[0]) || !options.scene.empty())
        add_inputs(plan, scenes::read_scene(is_scene(options.inputs[0]) ? options.inputs[0] : options.scene));
    for (const std::filesystem::path& file : film.paint_files())
        plan.add_input(file, "a texture or material of an avatar");
    if (!output.extension().empty()) {
        plan.add_output(output, "the picture");
        require_writable(output);
        return;
    }
    for (const int number : numbers) {
        plan.add_output(picture_file(output, number), "a picture");
        require_writable(picture_file(output, number));
    }
}

/// Refuses a combination of options before anything is loaded.
void require_possible(const RenderOptions& options)
{
    const std::string extension = lower_case_extension(options.output);
    if (!extension.empty() && extension != ".png" && extension != ".mp4")
        throw InvalidInput(options.output.string() +
                           ": pictures are .png or .mp4; a name without extension is a folder");
    if (options.sheet < 0 || (options.sheet > 0 && extension != ".png"))
        throw InvalidInput("--sheet: needs a number of columns above 0 and an output ending in .png");
    if (!options.turntable_text.empty() && (options.turntable < 2 || options.turntable > kMaxTurntable))
        throw InvalidInput("--turntable: " + options.turntable_text +
                           " pictures; give a number from 2 to 3600");
    if (options.turntable > 0 && extension == ".png" && options.sheet == 0)
        throw InvalidInput(options.output.string() + ": is one picture, but --turntable makes " +
                           std::to_string(options.turntable) +
                           "; add --sheet COLUMNS, or write to .mp4 or a folder");
    options.map.require_valid();
    if (options.map.is_given() && options.scene.empty() && !is_scene(options.inputs[0]))
        throw InvalidInput(
            "--map: give --scene with the scene that the caches were made from; it has the cloth's "
            "shape at rest, its fabric and the body");
}

/// The number behind --turntable may be left out; what is none there is an input.
void read_turntable(RenderOptions& options)
{
    if (const std::optional<std::int64_t> count = whole_number_in(options.turntable_text))
        options.turntable = int(std::clamp<std::int64_t>(*count, -1, kMaxTurntable + 1));
    else if (!options.turntable_text.empty()) {
        options.inputs.insert(options.inputs.begin(), options.turntable_text);
        options.turntable = kTurntable;
    }
    if (options.inputs.empty())
        throw InvalidInput("inputs is required; toile render --help says what it is");
}

int render(RenderOptions options)
{
    read_turntable(options);
    if (options.output.empty())
        options.output = options.inputs[0].stem().string() + ".png";
    require_possible(options);
    const CameraTarget target = options.viewpoint.target();
    const preview::Crop crop = options.viewpoint.crop();

    Film film = painted_film(options);
    replace_if_given(film.render().width, options.width, "--width");
    replace_if_given(film.render().height, options.height, "--height");
    replace_if_given(film.render().samples, options.samples, "--samples");
    options.viewpoint.apply(film.render());
    const std::filesystem::path& output = options.output;
    const std::string extension = lower_case_extension(output);
    const bool is_png = extension == ".png", is_picture = is_png && options.sheet == 0;
    const Shots shots = chosen_shots(options, film, is_picture);

    require_safe_output(options, film, output, shots.numbers);
    film.choose(shots.shots, target, crop);
    Pictures pictures(film, options);
    if (is_picture)
        write_png(output, pictures(0));
    else if (is_png)
        write_png(output, sheet_of(pictures, shots, options));
    else if (extension == ".mp4")
        write_video(pictures, shots, output, options.quiet);
    else
        write_folder(pictures, shots, output, options.quiet);
    std::cout << output.string() << std::endl;
    return kExitOk;
}

} // namespace

Command add_render(CLI::App& parser)
{
    Command command;
    command.options =
        parser.add_subcommand("render", "Render preview pictures of caches or of a scene's start");
    auto options = std::make_shared<RenderOptions>();
    CLI::App& add = *command.options;
    add.add_option("inputs", options->inputs,
                   "Caches (" + readable_extensions() + "), or one scene (.json); required");
    add.add_option("--scene", options->scene, "Scene that the caches were made from");
    add.add_option("-o,--output", options->output, "PNG, MP4, or folder for numbered PNGs [NAME.png]");
    add.add_option("--frames", options->frames, "FIRST:LAST:STEP [last for a PNG, else all]");
    add.add_option("--sheet", options->sheet, "One PNG of all frames in this many columns");
    add.add_option("--cloth", options->cloth, "Cloth of the scene [from the cache's name]");
    options->unlisted.add_to(add);
    add.add_option("--width", options->width, "Pixels, instead of the scene's");
    add.add_option("--height", options->height, "Pixels, instead of the scene's");
    add.add_option("--samples", options->samples, "Light paths per pixel, instead of the scene's");
    options->viewpoint.add_to(add);
    options->map.add_to(add);
    add.add_flag("--no-textures", options->no_textures,
                 "Avatars in their color, not in the colors and images of their files");
    add.add_option("--turntable", options->turntable_text, "Once around one frame, in this many pictures")
        ->expected(0, 1)
        ->default_str(std::to_string(kTurntable));
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return render(*options); };
    return command;
}

} // namespace toile::app
