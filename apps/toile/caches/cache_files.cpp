#include "apps/toile/caches/cache_files.h"

#include <optional>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/obj/obj_sequence.h"

namespace toile::app {

namespace {

using std::filesystem::path;

/// Frames of a cache, finished and unfinished, if it is a sequence of OBJ files.
struct SequenceFiles {
    exports::ObjSequence finished, unfinished;
};
std::optional<SequenceFiles> sequence_of(const path& cache, int frame_count)
{
    if (exports::cache_format(cache) != exports::CacheFormat::Obj ||
        (frame_count == 1 && !exports::ObjSequence::has_digits_placeholder(cache)))
        return std::nullopt;
    const exports::ObjSequence finished(cache);
    return SequenceFiles{finished, exports::ObjSequence(cache.parent_path() / (finished.stem() + ".partial") /
                                                        cache.filename())};
}

/// Adds the frames of a sequence, and those of an earlier run.
void add_frames(FilePlan& plan, const exports::ObjSequence& sequence, int first, int frame_count,
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
    if (const std::optional<SequenceFiles> sequence = sequence_of(file, frame_count)) {
        add_frames(plan, sequence->finished, first, frame_count, role);
        add_frames(plan, sequence->unfinished, first, frame_count, role + ", unfinished");
        return;
    }
    add_output_and_partial(plan, file, role);
    if (exports::cache_format(file) == exports::CacheFormat::Mdd)
        plan.add_output(file.string() + ".partial.pc2", role + ", unfinished");
}

void add_cache_input(FilePlan& plan, const path& file, const std::string& role)
{
    std::error_code missing;
    if (exports::cache_format(file) != exports::CacheFormat::Obj || std::filesystem::exists(file, missing)) {
        plan.add_input(exports::archive_of(file), role);
        return;
    }
    const exports::ObjSequence sequence(file);
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
    const std::optional<SequenceFiles> sequence = sequence_of(file, frame_count);
    if (!sequence) {
        require_replaceable(file);
        require_writable(partial_beside(file));
        return;
    }
    for (int frame = 0; frame < frame_count; ++frame) {
        require_replaceable(sequence->finished.file(first + frame));
        require_replaceable(sequence->unfinished.file(first + frame));
    }
}

} // namespace toile::app
