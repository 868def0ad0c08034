#include "export/alembic/abc_archive.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/base/number.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::int32_t kFileVersion = 0, kLibraryVersion = 10812;

/// Frames between two indices.
int index_interval(int frames) { return std::max(frames < 10 ? 1 : 10, frames / 32); }

/// Regular times: number of samples, time per cycle, and the times in the first cycle.
void append_times(std::string& bytes, int samples, double step, double start)
{
    append(bytes, std::uint32_t(samples));
    append(bytes, step);
    append(bytes, std::uint32_t{1});
    append(bytes, start);
}

std::string bytes_of(std::int32_t value)
{
    std::string bytes;
    append(bytes, value);
    return bytes;
}

} // namespace

AbcArchive::AbcArchive(const std::filesystem::path& file, const CacheLayout& layout, std::string application)
    : file_(file), layout_(layout), application_(std::move(application)), moving_(layout.samples_per_second())
{
    for (CacheMesh& mesh : layout_.meshes) {
        meshes_.emplace_back(file_, mesh, AbcMesh::Options{layout.velocities, layout.normals});
        mesh.faces = {};
    }
}

void AbcArchive::write(const SampleView& sample)
{
    file_.require_in_place();
    if (moving_.advance(sample))
        write_sample();
}

void AbcArchive::write_sample()
{
    const std::vector<MovingSample> samples = by_mesh(moving_.completed(), layout_.meshes);
    for (size_t m = 0; m < meshes_.size(); ++m)
        meshes_[m].add_sample(file_, samples[m]);
    ++frames_;
    if (frames_ - indexed_ >= index_interval(frames_))
        write_index();
}

/// Objects of the top: meshes without a parent, and the parents, each once.
std::vector<AbcObject> AbcArchive::add_objects()
{
    std::vector<AbcObject> objects;
    std::map<std::string, std::vector<AbcObject>> children;
    for (size_t m = 0; m < meshes_.size(); ++m) {
        const std::string& parent = layout_.meshes[m].parent;
        (parent.empty() ? objects : children[parent]).push_back(meshes_[m].add_object(file_));
    }
    for (const auto& [parent, below] : children)
        objects.push_back(add_transform(file_, parent, below));
    return objects;
}

void AbcArchive::write_index()
{
    indexed_ = frames_;
    const std::string metadata = "FramesPerTimeUnit=" + shortest_text(layout_.fps) +
                                 ";_ai_Application=" + application_ + ";toile_unit=" + layout_.axes.unit +
                                 ";toile_up=" + layout_.axes.up;
    std::string times;
    append_times(times, frames_, 1.0, 0.0);
    append_times(times, frames_, 1.0 / layout_.samples_per_second(), layout_.start_frame / layout_.fps);
    const OgawaNode top = add_object(file_, kOgawaNothing, add_objects());
    file_.set_root(file_.add_group(std::array{file_.add_data(bytes_of(kFileVersion)),
                                              file_.add_data(bytes_of(kLibraryVersion)), top,
                                              file_.add_data(metadata), file_.add_data(times), kOgawaData}));
}

void AbcArchive::complete()
{
    if (moving_.finish())
        write_sample();
    write_index();
    file_.sync();
    file_.require_in_place();
}

} // namespace toile::exports
