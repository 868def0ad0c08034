#include "apps/toile/caches/cache_contents.h"

#include <memory>
#include <optional>
#include <utility>

#include "apps/toile/caches/exports.h"
#include "apps/toile/cloth/skin.h"
#include "core/base/error.h"
#include "export/cache_format.h"
#include "export/cache_path.h"

namespace toile::app {

namespace {

/// Vertex of the cloth that one of the file is, or follows.
int own_vertex(const scenes::ClothState& state, int file_vertex)
{
    return state.has_file_order() ? state.numbers.vertex[size_t(file_vertex)] : file_vertex;
}

/// [file vertices] [m]
std::vector<double> thickness_of(const scenes::ClothState& state)
{
    const auto of_vertex = [&](int v) {
        return state.vertex_thickness.empty() ? state.fabric.thickness : state.vertex_thickness[size_t(v)];
    };
    std::vector<double> thickness;
    thickness.reserve(state.file_mesh().positions.size());
    for (int v = 0; v < int(state.file_mesh().positions.size()); ++v)
        thickness.push_back(of_vertex(own_vertex(state, v)));
    return thickness;
}

/// A solid has no attributes.
scene::Export without_attributes(scene::Export entry)
{
    entry.attributes.clear();
    return entry;
}

} // namespace

ExportedSurface::ExportedSurface(const scene::Export& entry, const scenes::ClothState& state)
    : state_(&state), attributes_(entry, state),
      mesh_({state.name, "", int(state.file_mesh().positions.size()), exports::faces_only(state.file_mesh()),
             vertex_attributes(entry)},
            {entry.weld, entry.stores(scene::ExportAttribute::Panel)},
            entry.thickness ? thickness_of(state) : std::vector<double>{})
{
}

void ExportedSurface::append(View<const Vec3> x, std::vector<Vec3>& positions) const
{
    mesh_.append(state_->to_file(x), positions);
}

void ExportedSurface::append_attributes(View<const Vec3> x, const SkinDistance* skin,
                                        std::vector<float>& numbers) const
{
    if (attributes_.is_empty())
        return;
    std::vector<std::vector<double>> of_file;
    for (const std::vector<double>& of_vertex : attributes_.at(x, skin)) {
        std::vector<double>& values = of_file.emplace_back();
        for (int v = 0; v < int(state_->file_mesh().positions.size()); ++v)
            values.push_back(of_vertex[size_t(own_vertex(*state_, v))]);
    }
    mesh_.append_values(of_file, numbers);
}

std::vector<Vec3> ExportedSurface::file_positions(const std::vector<std::vector<Vec3>>& meshes) const
{
    const std::vector<std::optional<Vec3>> stored = mesh_.whole(meshes);
    std::vector<Vec3> file;
    file.reserve(stored.size());
    for (const std::optional<Vec3>& x : stored)
        file.push_back(x.value_or(Vec3::Zero()));
    // Vertices without a face are in no group; they follow the cloth.
    const std::vector<Vec3> followed = state_->to_file(state_->from_file(file));
    for (size_t v = 0; v < file.size(); ++v)
        if (!stored[v])
            file[v] = followed[v];
    return file;
}

CacheContents::CacheContents(const scene::Export& entry, const scenes::Scene& scene,
                             View<const scenes::ClothState> surfaces,
                             const std::vector<std::pair<std::string, const TriangleMesh*>>& avatars)
    : numbers_(surfaces_of(scene, entry)), has_avatars_(entry.avatars)
{
    for (const int number : numbers_) {
        const bool is_cloth = number < int(scene.cloths.size());
        surfaces_.emplace_back(is_cloth ? entry : without_attributes(entry), surfaces[number]);
        for (const exports::CacheMesh& mesh : surfaces_.back().meshes())
            layout_.meshes.push_back(mesh);
    }
    if (has_avatars_)
        for (const auto& [name, mesh] : avatars)
            layout_.meshes.push_back({name, "", mesh->vertex_count(), exports::faces_only(faces_of(*mesh))});
    if (entry.stores(scene::ExportAttribute::Gap))
        add_skin(scene, avatars);
    layout_.frame_count = sample_count(scene, entry);
    layout_.fps = scene.fps;
    layout_.subframes = entry.subframes;
    layout_.start_frame = start_frame_of(entry);
    layout_.axes = axes_of(entry);
    layout_.velocities = entry.velocities;
    layout_.normals = entry.normals;
}

/// The skin of toile render: avatars but planes (cloth/skin.h).
void CacheContents::add_skin(const scenes::Scene& scene,
                             const std::vector<std::pair<std::string, const TriangleMesh*>>& avatars)
{
    TriangleMesh skin;
    for (size_t k = 0; k < avatars.size(); ++k) {
        const auto named = std::find_if(scene.avatars.begin(), scene.avatars.end(),
                                        [&](const auto& avatar) { return avatar.name == avatars[k].first; });
        if (std::holds_alternative<scene::Plane>(named->shape))
            continue;
        append(skin, avatars[k].second->positions, avatars[k].second->triangles);
        skinned_.push_back(k);
    }
    skin_.emplace(std::move(skin.triangles));
}

exports::CacheSample CacheContents::sample(const std::function<View<const Vec3>(int surface)>& surface,
                                           const std::vector<std::vector<Vec3>>& avatars)
{
    if (skin_) {
        std::vector<Vec3> skin;
        for (const size_t avatar : skinned_)
            skin.insert(skin.end(), avatars[avatar].begin(), avatars[avatar].end());
        skin_->move(skin);
    }
    exports::CacheSample sample;
    sample.positions.reserve(size_t(layout_.vertex_count()));
    sample.attributes.reserve(size_t(layout_.attribute_count()));
    for (size_t s = 0; s < surfaces_.size(); ++s) {
        const View<const Vec3> x = surface(numbers_[s]);
        surfaces_[s].append(x, sample.positions);
        surfaces_[s].append_attributes(x, skin_ ? &*skin_ : nullptr, sample.attributes);
    }
    if (has_avatars_)
        for (const std::vector<Vec3>& avatar : avatars)
            sample.positions.insert(sample.positions.end(), avatar.begin(), avatar.end());
    exports::change_axes({}, layout_.axes, sample.positions);
    return sample;
}

bool needs_avatars(const scene::Export& entry)
{
    return entry.avatars || entry.stores(scene::ExportAttribute::Gap);
}

namespace {

/// A cloth in a file of an export.
class ClothSource final : public exports::PointCache::Source {
public:
    ClothSource(const std::filesystem::path& file, const scene::Export& entry,
                const scenes::ClothState& state)
        : surface_(entry, state)
    {
        const std::vector<std::filesystem::path> in_file = exports::meshes_of_cache(file);
        if (in_file.empty())
            throw InvalidInput(file.string() + ": has no mesh; give a cache of \"" + state.name + "\"");
        for (const exports::CacheMesh& of_surface : surface_.meshes())
            caches_.push_back(exports::read_cache(path_of(of_surface, in_file)));
        const exports::PointCache& first = caches_.front();
        axes_ = first.axes().value_or(axes_of(entry));
        times = first.times();
        subframes_ = first.subframes() > 1 || !times.empty() ? first.subframes() : entry.subframes;
        frame_count = (first.frame_count() + subframes_ - 1) / subframes_;
        fps = first.fps();
        if (fps && first.subframes() == 1)
            *fps /= subframes_;
        const double first_frame = first.start_frame() / (first.subframes() > 1 ? 1 : subframes_);
        start_frame = entry.start_frame ? first_frame - *entry.start_frame : 0.0;
        vertex_count =
            parts_have_their_size() ? int(state.file_mesh().positions.size()) : first.vertex_count();
    }

    std::vector<Vec3> frame(int index) const override
    {
        std::vector<std::vector<Vec3>> meshes;
        for (const exports::PointCache& cache : caches_) {
            meshes.push_back(cache.frame(index * subframes_));
            exports::change_axes(axes_, {}, meshes.back());
        }
        return surface_.file_positions(meshes);
    }

private:
    /// The only mesh of a file, or that of this path. In USD a prim may be above it.
    static std::filesystem::path path_of(const exports::CacheMesh& of_surface,
                                         const std::vector<std::filesystem::path>& in_file)
    {
        const std::string ending = exports::path_of_mesh(of_surface);
        for (const std::filesystem::path& path : in_file) {
            const std::string mesh = exports::mesh_path_of(path);
            if (in_file.size() == 1 ||
                (mesh.ends_with(ending) && mesh.rfind('/', mesh.size() - ending.size() - 1) + 1 <= 1))
                return path;
        }
        return exports::archive_of(in_file.front()).string() + "#" + ending; // which will be refused
    }

    /// Otherwise the cache is of another cloth, which who opened it will say.
    bool parts_have_their_size() const
    {
        for (size_t m = 0; m < caches_.size(); ++m)
            if (caches_[m].vertex_count() != surface_.meshes()[m].vertex_count)
                return false;
        return true;
    }

    ExportedSurface surface_;
    std::vector<exports::PointCache> caches_; ///< [meshes of the surface]
    exports::Axes axes_;
    int subframes_ = 1;
};

} // namespace

exports::PointCache open_cloth(const std::filesystem::path& file, const scene::Export& entry,
                               const scenes::ClothState& state)
{
    return exports::PointCache(std::make_unique<ClothSource>(file, entry, state));
}

} // namespace toile::app
