#include "apps/toile/terminal/cache_files.h"

#include <optional>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/sequence/numbered_files.h"

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

} // namespace

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
    add_output_and_partial(plan, file, role);
    if (format == exports::CacheFormat::Mdd || format == exports::CacheFormat::Glb)
        plan.add_output(file.string() + ".partial.pc2", role + ", unfinished");
}

void add_cache_input(FilePlan& plan, const path& file, const std::string& role)
{
    std::error_code missing;
    if (!exports::numbers_frames(exports::cache_format(file)) || std::filesystem::exists(file, missing)) {
        plan.add_input(exports::archive_of(file), role);
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
