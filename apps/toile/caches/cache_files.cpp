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
#include "export/obj/obj_sequence.h"
#include "export/usd/usd_files.h"
#include "export/usd/usdc_writer.h"

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
    if (const std::optional<UsdOutputs> usd = usd_outputs(file, frame_count)) {
        for (const path& finished : usd->finished)
            plan.add_output(finished, role);
        for (const path& unfinished : usd->unfinished)
            plan.add_output(unfinished, role + ", unfinished");
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
    if (const std::optional<UsdOutputs> usd = usd_outputs(file, frame_count)) {
        for (const std::vector<path>& files : {usd->finished, usd->unfinished})
            for (const path& each : files)
                require_replaceable(each);
        return;
    }
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
