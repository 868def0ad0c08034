#include "export/alembic/abc_archive.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <utility>

#include "core/base/error.h"
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

AbcArchive::AbcArchive(const std::filesystem::path& file, const Layout& layout) : file_(file), layout_(layout)
{
    std::set<std::string> taken;
    for (size_t m = 0; m < layout.names.size(); ++m) {
        if (!taken.insert(abc_name(layout.names[m])).second)
            throw InvalidInput(file.string() + ": two meshes would be called \"" + abc_name(layout.names[m]) +
                               "\"; give them names that differ in letters, digits or underscores");
        meshes_.emplace_back(file_, layout.names[m], layout.faces[m]);
    }
    layout_.faces.clear();
}

void AbcArchive::write(std::vector<std::vector<Vec3>> positions)
{
    file_.require_in_place();
    if (!waiting_.empty())
        write_waiting(positions);
    before_ = std::exchange(waiting_, std::move(positions));
}

/// Writes the frame that waits. @param next  the frame after it; itself if there is none
void AbcArchive::write_waiting(const std::vector<std::vector<Vec3>>& next)
{
    const std::vector<std::vector<Vec3>>& before = before_.empty() ? waiting_ : before_;
    const int frames = int(&next != &waiting_) + int(&before != &waiting_);
    const double per_second = frames > 0 ? layout_.fps / frames : 0.0;
    std::vector<Vec3> velocities;
    for (size_t m = 0; m < meshes_.size(); ++m) {
        velocities.resize(waiting_[m].size());
        for (size_t v = 0; v < velocities.size(); ++v)
            velocities[v] = per_second * (next[m][v] - before[m][v]);
        meshes_[m].add_sample(file_, waiting_[m], velocities);
    }
    ++frames_;
    if (frames_ - indexed_ >= index_interval(frames_))
        write_index();
}

void AbcArchive::write_index()
{
    indexed_ = frames_;
    std::vector<AbcObject> objects;
    for (const AbcMesh& mesh : meshes_)
        objects.push_back(mesh.add_object(file_));
    char rate[40];
    std::snprintf(rate, sizeof rate, "%.17g", layout_.fps);
    const std::string metadata =
        "FramesPerTimeUnit=" + std::string(rate) + ";_ai_Application=" + layout_.application;
    std::string times;
    append_times(times, frames_, 1.0, 0.0);
    append_times(times, frames_, 1.0 / layout_.fps, layout_.start_frame / layout_.fps);
    const OgawaNode top = add_object(file_, kOgawaNothing, objects);
    file_.set_root(file_.add_group(std::array{file_.add_data(bytes_of(kFileVersion)),
                                              file_.add_data(bytes_of(kLibraryVersion)), top,
                                              file_.add_data(metadata), file_.add_data(times), kOgawaData}));
}

void AbcArchive::complete()
{
    if (!waiting_.empty()) {
        write_waiting(waiting_);
        before_ = std::exchange(waiting_, {});
    }
    write_index();
    file_.sync();
    file_.require_in_place();
}

} // namespace toile::exports
