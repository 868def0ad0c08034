#include <cmath>
#include <iostream>
#include <memory>

#include "apps/preview/video.h"
#include "apps/toile/caches/cache_files.h"
#include "apps/toile/render/film.h"
#include "apps/toile/render/frame_range.h"
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
    bool quiet = false;
};

bool is_scene(const std::filesystem::path& input) { return lower_case_extension(input) == ".json"; }

Film open_film(const RenderOptions& options)
{
    SetupProgress progress(options.quiet);
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
               ? Film::of_obj_caches(options.inputs)
               : Film::of_caches(scenes::read_scene(options.scene), options.inputs, options.cloth);
}

void replace_if_given(int& value, int given, const char* option)
{
    if (given < 0 || given > 8192)
        throw InvalidInput(std::string(option) + ": " + std::to_string(given) +
                           " is out of range; give a whole number from 1 to 8192");
    if (given > 0)
        value = given;
}

/// Frames to render: the last for a single picture, all for a film, a sheet or a folder.
std::vector<int> chosen_frames(const RenderOptions& options, const Film& film, bool is_single)
{
    const std::string text = options.frames.empty() && is_single ? "-1" : options.frames;
    return parse_frame_range(text, film.frame_count());
}

std::vector<preview::Image> take_pictures(Film& film, const std::vector<int>& frames, bool quiet)
{
    Progress progress("picture", int(frames.size()), quiet);
    std::vector<preview::Image> pictures;
    for (const int frame : frames) {
        pictures.push_back(film.picture(frame));
        progress.update(int(pictures.size()));
    }
    return pictures;
}

void write_video(Film& film, const std::vector<int>& frames, const std::filesystem::path& file, bool quiet)
{
    const int step = frames.size() > 1 ? frames[1] - frames[0] : 1;
    preview::VideoWriter video(file, film.render().width, film.render().height, film.fps() / step);
    Progress progress("picture", int(frames.size()), quiet);
    for (size_t i = 0; i < frames.size(); ++i) {
        video.write(film.picture(frames[i]));
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

void write_folder(Film& film, const std::vector<int>& frames, const std::filesystem::path& folder, bool quiet)
{
    Progress progress("picture", int(frames.size()), quiet);
    for (size_t i = 0; i < frames.size(); ++i) {
        try {
            write_png(picture_file(folder, frames[i]), film.picture(frames[i]));
        } catch (const InvalidInput& error) { // at first, nothing is written yet
            if (i > 0)
                throw DeviceError(error.what() + std::string("; the pictures before are written"));
            throw;
        }
        progress.update(int(i) + 1);
    }
}

/// Refuses pictures that would replace a file that they are made from, or could not be written.
void require_safe_output(const RenderOptions& options, const std::filesystem::path& output,
                         const std::vector<int>& frames)
{
    FilePlan plan;
    for (const std::filesystem::path& input : options.inputs)
        plan.add_input(exports::archive_of(input), "an input");
    if (is_scene(options.inputs[0]) || !options.scene.empty())
        add_inputs(plan, scenes::read_scene(is_scene(options.inputs[0]) ? options.inputs[0] : options.scene));
    if (!output.extension().empty()) {
        plan.add_output(output, "the picture");
        require_writable(output);
        return;
    }
    for (const int frame : frames) {
        plan.add_output(picture_file(output, frame), "a picture");
        require_writable(picture_file(output, frame));
    }
}

int render(const RenderOptions& options)
{
    const std::filesystem::path output =
        options.output.empty() ? std::filesystem::path(options.inputs[0].stem().string() + ".png")
                               : options.output;
    const std::string extension = lower_case_extension(output);
    if (!extension.empty() && extension != ".png" && extension != ".mp4")
        throw InvalidInput(output.string() +
                           ": pictures are .png or .mp4; a name without extension is a folder");
    if (options.sheet < 0 || (options.sheet > 0 && extension != ".png"))
        throw InvalidInput("--sheet: needs a number of columns above 0 and an output ending in .png");

    Film film = open_film(options);
    replace_if_given(film.render().width, options.width, "--width");
    replace_if_given(film.render().height, options.height, "--height");
    replace_if_given(film.render().samples, options.samples, "--samples");
    const bool is_picture = extension == ".png" && options.sheet == 0;
    const std::vector<int> frames = chosen_frames(options, film, is_picture);
    if (is_picture && frames.size() > 1)
        throw InvalidInput(output.string() + ": is one picture, but --frames chooses " +
                           std::to_string(frames.size()) +
                           "; add --sheet COLUMNS, or write to .mp4 or a folder");

    require_safe_output(options, output, frames);
    film.choose(frames);
    if (is_picture)
        write_png(output, film.picture(frames[0]));
    else if (extension == ".png")
        write_png(output, contact_sheet(take_pictures(film, frames, options.quiet), options.sheet, frames));
    else if (extension == ".mp4")
        write_video(film, frames, output, options.quiet);
    else
        write_folder(film, frames, output, options.quiet);
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
    add.add_option("inputs", options->inputs, "Caches (" + readable_extensions() + "), or one scene (.json)")
        ->required();
    add.add_option("--scene", options->scene, "Scene that the caches were made from");
    add.add_option("-o,--output", options->output, "PNG, MP4, or folder for numbered PNGs [NAME.png]");
    add.add_option("--frames", options->frames, "FIRST:LAST:STEP [last for a PNG, else all]");
    add.add_option("--sheet", options->sheet, "One PNG of all frames in this many columns");
    add.add_option("--cloth", options->cloth, "Cloth of the scene [from the cache's name]");
    add.add_option("--width", options->width, "Pixels, instead of the scene's");
    add.add_option("--height", options->height, "Pixels, instead of the scene's");
    add.add_option("--samples", options->samples, "Light paths per pixel, instead of the scene's");
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return render(*options); };
    return command;
}

} // namespace toile::app
