#include "export/obj/obj_writer.h"

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

ObjWriter::ObjWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial_beside(file_)), order_(file_, layout),
      mesh_(layout.meshes.front().faces)
{
    require_writable(partial_);
}

void ObjWriter::write(int frame, View<const Vec3> positions)
{
    order_.require_next(frame, positions);
    mesh_.positions.assign(positions.begin(), positions.end());
    write_obj(partial_, mesh_);
    order_.advance();
}

std::filesystem::path ObjWriter::complete()
{
    order_.require_complete(partial_);
    require_exists(partial_);
    return partial_;
}

void ObjWriter::publish() { move_into_place(partial_, file_); }

ObjSequenceWriter::ObjSequenceWriter(const std::filesystem::path& pattern, const CacheLayout& layout)
    : sequence_(pattern), folder_(pattern.parent_path() / (sequence_.stem() + ".partial")),
      waiting_pattern_(folder_ / pattern.filename()), waiting_(waiting_pattern_), order_(pattern, layout),
      first_number_(int(std::lround(layout.start_frame))), frame_count_(layout.frame_count),
      resume_at_(layout.resume_at), mesh_(layout.meshes.front().faces)
{
    require_writable(waiting_.file(number(0)));
    require_earlier_frames(resume_at_);
    if (resume_at_ > 0)
        remove_other_frames();
}

void ObjSequenceWriter::require_earlier_frames(int frames) const
{
    for (int frame = 0; frame < frames; ++frame)
        if (!std::filesystem::exists(waiting_.file(number(frame))))
            throw InvalidInput(waiting_.file(number(frame)).string() + ": missing; resuming at " +
                               std::to_string(frames) + " needs it; start the run anew");
}

/// Removes frames that a killed run left, but those that this one continues.
void ObjSequenceWriter::remove_other_frames()
{
    for (const int old : waiting_.existing())
        if (old < number(0) || old >= number(resume_at_))
            std::filesystem::remove(waiting_.file(old));
}

void ObjSequenceWriter::write(int frame, View<const Vec3> positions)
{
    order_.require_next(frame, positions);
    if (frame == resume_at_)
        remove_other_frames();
    mesh_.positions.assign(positions.begin(), positions.end());
    write_obj(waiting_.file(number(frame)), mesh_);
    order_.advance();
}

std::filesystem::path ObjSequenceWriter::complete()
{
    order_.require_complete(folder_);
    for (int frame = 0; frame < frame_count_; ++frame)
        require_exists(waiting_.file(number(frame)));
    return waiting_pattern_;
}

void ObjSequenceWriter::publish()
{
    for (int frame = 0; frame < frame_count_; ++frame)
        move_into_place(waiting_.file(number(frame)), sequence_.file(number(frame)));
    for (int next = number(frame_count_); std::filesystem::remove(sequence_.file(next)); ++next) {
    }
    std::error_code not_empty; // foreign files in the folder prevent its removal
    std::filesystem::remove(folder_, not_empty);
}

} // namespace toile::exports
