#include "export/sequence/mesh_files.h"

#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/binary_file.h"

namespace toile::exports {

namespace {

void require_exists(const std::filesystem::path& file)
{
    if (!std::filesystem::exists(file))
        throw DeviceError(file.string() + ": was removed before the cache was complete");
}

} // namespace

MeshFileCache::MeshFileCache(std::filesystem::path file, const CacheLayout& layout, MeshFileWriter write_mesh)
    : file_(std::move(file)), partial_(partial_beside(file_)), order_(file_, layout),
      write_mesh_(std::move(write_mesh))
{
    require_writable(partial_);
}

void MeshFileCache::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    write_mesh_(partial_, sample);
    order_.advance();
}

std::filesystem::path MeshFileCache::complete()
{
    order_.require_complete(partial_);
    require_exists(partial_);
    return partial_;
}

void MeshFileCache::publish() { move_into_place(partial_, file_); }

MeshSequenceCache::MeshSequenceCache(const std::filesystem::path& pattern, const CacheLayout& layout,
                                     MeshFileWriter write_mesh)
    : sequence_(pattern), unfinished_(sequence_.unfinished()), order_(pattern, layout),
      first_number_(int(std::lround(layout.start_frame))), frame_count_(layout.frame_count),
      resume_at_(layout.resume_at), write_mesh_(std::move(write_mesh))
{
    require_writable(unfinished_file(0));
    require_earlier_frames(resume_at_);
    if (resume_at_ > 0)
        remove_other_frames();
}

void MeshSequenceCache::require_earlier_frames(int frames) const
{
    for (int frame = 0; frame < frames; ++frame)
        if (!std::filesystem::exists(unfinished_file(frame)))
            throw InvalidInput(unfinished_file(frame).string() + ": missing; resuming at " +
                               std::to_string(frames) + " needs it; start the run anew");
}

/// Removes frames that a killed run left, but those that this one continues.
void MeshSequenceCache::remove_other_frames()
{
    for (const int old : unfinished_.existing())
        if (old < number(0) || old >= number(resume_at_))
            std::filesystem::remove(unfinished_.file(old));
}

void MeshSequenceCache::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    if (frame == resume_at_)
        remove_other_frames();
    write_mesh_(unfinished_file(frame), sample);
    order_.advance();
}

std::filesystem::path MeshSequenceCache::complete()
{
    order_.require_complete(partial());
    for (int frame = 0; frame < frame_count_; ++frame)
        require_exists(unfinished_file(frame));
    return unfinished_.pattern();
}

void MeshSequenceCache::publish()
{
    for (int frame = 0; frame < frame_count_; ++frame)
        move_into_place(unfinished_file(frame), sequence_.file(number(frame)));
    for (int next = number(frame_count_); std::filesystem::remove(sequence_.file(next)); ++next) {
    }
    std::error_code not_empty; // foreign files in the folder prevent its removal
    std::filesystem::remove(partial(), not_empty);
}

} // namespace toile::exports
