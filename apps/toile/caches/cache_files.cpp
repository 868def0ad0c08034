#include "apps/toile/caches/cache_files.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/sequence/numbered_files.h"
#include "export/usd/usd_files.h"
#include "export/usd/usdc_writer.h"
#include "scenes/format/document.h"

namespace toile::app {

namespace {

using std::filesystem::path;

/// Adds the frames of a sequence, and those of an earlier run.
void add_frames(FilePlan& plan, const exports::NumberedFiles& sequence, int first, int frame_count,
                const std::string& role)
{
    for (int frame = 0; frame < frame_count; ++frame)
        plan.add_output(sequence.file(first + frame), role);
    for (const int number : sequence.existing())
        if (number < first || number >= first + frame_count)
            plan.add_output(sequence.file(number), role);
}

/// Files of a .usda cache: the root and its clips, and those of an earlier run.
std::vector<path> files_of(const exports::UsdFiles& files, int frame_count)
{
    std::vector<path> all{files.root()};
    const int clips = exports::usd_clip_count(frame_count);
    for (int number = 0; number < clips; ++number)
        all.push_back(files.clip(number));
    if (clips > 0)
        all.push_back(files.manifest());
    for (const path& file : files.existing())
        if (std::find(all.begin(), all.end(), file) == all.end())
            all.push_back(file);
    return all;
}

/// Files of a USD cache that is written, finished and unfinished.
struct UsdOutputs {
    std::vector<path> finished, unfinished;
};
std::optional<UsdOutputs> usd_outputs(const path& cache, int frame_count)
{
    if (exports::cache_format(cache) != exports::CacheFormat::Usd)
        return std::nullopt;
    const bool is_text = lower_case_extension(cache) == ".usda";
    const path text = is_text ? cache : exports::UsdcWriter::waiting(cache);
    UsdOutputs outputs{{cache}, files_of(exports::unfinished_usd(text, frame_count), frame_count)};
    if (is_text)
        outputs.finished = files_of(exports::UsdFiles(cache), frame_count);
    else
        outputs.unfinished.push_back(partial_beside(cache));
    return outputs;
}

} // namespace

std::string readable_extensions() { return scene_format::enumerate(exports::read_extensions(), "or"); }

void add_output_and_partial(FilePlan& plan, const path& file, const std::string& role)
{
    plan.add_output(file, role);
    plan.add_output(partial_beside(file), role + ", unfinished");
}

void add_cache_output(FilePlan& plan, const path& file, int first, int frame_count, const std::string& role)
{
    const exports::CacheFormat format = exports::cache_format(file);
    if (const std::optional<exports::NumberedFiles> frames = exports::files_of_frames(file, frame_count)) {
        add_frames(plan, *frames, first, frame_count, role);
        add_frames(plan, frames->unfinished(), first, frame_count, role + ", unfinished");
        if (format == exports::CacheFormat::Vtk) {
            plan.add_output(file, role);
            plan.add_output(frames->unfinished_folder() / file.filename(), role + ", unfinished");
        }
        return;
    }
    if (const std::optional<UsdOutputs> usd = usd_outputs(file, frame_count)) {
        for (const path& finished : usd->finished)
            plan.add_output(finished, role);
        for (const path& unfinished : usd->unfinished)
            plan.add_output(unfinished, role + ", unfinished");
        return;
    }
    add_output_and_partial(plan, file, role);
    if (format == exports::CacheFormat::Mdd || format == exports::CacheFormat::Glb)
        plan.add_output(file.string() + ".partial.pc2", role + ", unfinished");
}

void add_cache_input(FilePlan& plan, const path& file, const std::string& role)
{
    std::error_code missing;
    if (!exports::features_of(exports::cache_format(file)).numbered ||
        std::filesystem::exists(file, missing)) {
        plan.add_input(exports::archive_of(file), role);
        if (exports::cache_format(file) == exports::CacheFormat::Usd)
            for (const path& clip : exports::UsdFiles(exports::archive_of(file)).existing())
                plan.add_input(clip, role);
        return;
    }
    const exports::NumberedFiles sequence(file);
    for (const int number : sequence.existing())
        plan.add_input(sequence.file(number), role);
}

/// Refuses a name that can't be replaced by a file, or should not be.
void require_replaceable(const path& file)
{
    std::error_code missing;
    if (std::filesystem::is_directory(file, missing) || is_stream(file))
        throw InvalidInput(file.string() + ": is no regular file; choose another folder or name");
    require_writable(file);
}

void require_writable_cache(const path& file, int first, int frame_count)
{
    if (const std::optional<UsdOutputs> usd = usd_outputs(file, frame_count)) {
        for (const std::vector<path>& files : {usd->finished, usd->unfinished})
            for (const path& each : files)
                require_replaceable(each);
        return;
    }
    const std::optional<exports::NumberedFiles> frames = exports::files_of_frames(file, frame_count);
    if (!frames || exports::cache_format(file) == exports::CacheFormat::Vtk) {
        require_replaceable(file);
        require_writable(partial_beside(file));
    }
    for (int frame = 0; frames && frame < frame_count; ++frame) {
        require_replaceable(frames->file(first + frame));
        require_replaceable(frames->unfinished().file(first + frame));
    }
}

} // namespace toile::app
