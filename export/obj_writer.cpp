#include "export/obj_writer.h"

#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "export/binary_file.h"

namespace toile::exports {

namespace {

std::filesystem::path partial_file(const std::filesystem::path& file)
{
    return file.parent_path() / (file.stem().string() + ".partial" + file.extension().string());
}

void require_writable_folder(const std::filesystem::path& folder)
{
    const std::filesystem::path probe = folder / ".writable";
    {
        const BinaryFile file(probe, BinaryFile::Mode::Create);
    }
    std::filesystem::remove(probe);
}

} // namespace

ObjWriter::ObjWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial_file(file_)), order_(file_, layout), mesh_(layout.faces)
{
    require_writable_folder(file_.parent_path());
}

void ObjWriter::write(int frame, View<const Vec3> positions)
{
    order_.require_next(frame, positions);
    mesh_.positions.assign(positions.begin(), positions.end());
    write_obj(partial_, mesh_);
    order_.advance();
}

void ObjWriter::finish()
{
    order_.require_complete(partial_);
    move_into_place(partial_, file_);
}

ObjSequenceWriter::ObjSequenceWriter(const std::filesystem::path& pattern, const CacheLayout& layout)
    : sequence_(pattern), folder_(pattern.parent_path() / (sequence_.stem() + ".partial")),
      waiting_(sequence_.in(folder_)), order_(pattern, layout),
      first_number_(int(std::lround(layout.start_frame))), frame_count_(layout.frame_count),
      mesh_(layout.faces)
{
    require_writable_folder(folder_);
    keep_earlier_frames(layout.resume_at);
}

void ObjSequenceWriter::keep_earlier_frames(int frames)
{
    for (int frame = 0; frame < frames; ++frame)
        if (!std::filesystem::exists(waiting_.file(number(frame))))
            throw InvalidInput(waiting_.file(number(frame)).string() + ": missing; resuming at " +
                               std::to_string(frames) + " needs it; start the run anew");
    for (const int old : waiting_.existing())
        if (old < number(0) || old >= number(frames))
            std::filesystem::remove(waiting_.file(old));
}

void ObjSequenceWriter::write(int frame, View<const Vec3> positions)
{
    order_.require_next(frame, positions);
    mesh_.positions.assign(positions.begin(), positions.end());
    write_obj(waiting_.file(number(frame)), mesh_);
    order_.advance();
}

void ObjSequenceWriter::finish()
{
    order_.require_complete(folder_);
    for (int frame = 0; frame < frame_count_; ++frame)
        move_into_place(waiting_.file(number(frame)), sequence_.file(number(frame)));
    for (int next = number(frame_count_); std::filesystem::remove(sequence_.file(next)); ++next) {
    }
    std::error_code not_empty; // foreign files in the folder prevent its removal
    std::filesystem::remove(folder_, not_empty);
}

} // namespace toile::exports
