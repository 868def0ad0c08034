#include "export/vtk/vtk_writer.h"

#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/sequence/numbered_files.h"

namespace toile::exports {

namespace {

/// What a writer keeps of a layout, which begins a new run.
CacheLayout without_faces(const std::filesystem::path& file, CacheLayout layout)
{
    if (layout.resume_at > 0)
        throw InvalidInput(file.string() +
                           ": a list of VTK files can't be continued; start the run anew, or write a .pc2");
    layout.meshes.front().faces = {};
    return layout;
}

} // namespace

VtkWriter::VtkWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), layout_(without_faces(file_, layout)), order_(file_, layout),
      mesh_(layout.meshes.front()),
      files_(
          frames_of_pvd(file_).pattern(), layout_,
          [this](const std::filesystem::path& frame, const SampleView& sample) {
              const double time = layout_.frame_of(written_) / layout_.fps;
              write_atomically(frame, mesh_.bytes(time, {sample.positions, velocities_, sample.attributes}));
          }),
      list_(files_.partial() / file_.filename()), moving_(layout.samples_per_second())
{
}

void VtkWriter::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    if (!layout_.velocities)
        write_frame({sample.positions, {}, sample.attributes});
    else if (moving_.advance(sample))
        write_frame(moving_.completed());
    order_.advance();
}

void VtkWriter::write_frame(const MovingSample& sample)
{
    velocities_ = sample.velocities;
    files_.write(written_, {sample.positions, sample.attributes});
    list_.add(layout_.frame_of(written_) / layout_.fps, files_.unfinished_file(written_).filename().string());
    ++written_;
}

std::filesystem::path VtkWriter::complete()
{
    order_.require_complete(partial());
    keep();
    files_.complete();
    list_.complete();
    return list_.path();
}

void VtkWriter::keep()
{
    if (moving_.finish())
        write_frame(moving_.completed());
}

void VtkWriter::publish()
{
    files_.publish();
    move_into_place(list_.path(), file_);
    std::error_code not_empty; // foreign files in the folder prevent its removal
    std::filesystem::remove(partial(), not_empty);
}

} // namespace toile::exports
