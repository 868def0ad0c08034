#include "apps/toile/caches/cache_contents.h"

#include <memory>
#include <numeric>
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
    : state_(&state), attributes_(entry, state), thickness_(thickness_of(state))
{
    const ObjMesh& whole = state.file_mesh();
    const std::vector<exports::MeshPart> groups =
        entry.weld ? std::vector<exports::MeshPart>{} : exports::parts_of(whole);
    if (groups.size() > 1) {
        for (const exports::MeshPart& group : groups)
            add_part(entry, {group.name, state.name, int(group.vertices.size()), group.faces},
                     group.vertices);
        if (entry.stores(scene::ExportAttribute::Panel))
            number_panels(groups);
        return;
    }
    exports::CacheMesh mesh{state.name, "", int(whole.positions.size()), exports::faces_only(whole)};
    std::vector<int> all(whole.positions.size());
    std::iota(all.begin(), all.end(), 0);
    add_part(entry, std::move(mesh), std::move(all));
    if (entry.stores(scene::ExportAttribute::Panel))
        meshes_.front().panels = exports::face_panels(meshes_.front().faces);
}

/// Each mesh is a panel.
void ExportedSurface::number_panels(const std::vector<exports::MeshPart>& groups)
{
    std::vector<std::string> names;
    names.reserve(groups.size());
    for (const exports::MeshPart& group : groups)
        names.push_back(group.name);
    for (size_t m = 0; m < meshes_.size(); ++m)
        meshes_[m].panels = {std::vector<int>(meshes_[m].faces.polygons.size(), int(m)), names};
}

void ExportedSurface::add_part(const scene::Export& entry, exports::CacheMesh mesh, std::vector<int> vertices)
{
    Part part{std::move(vertices), std::nullopt};
    mesh.attributes = vertex_attributes(entry);
    if (entry.thickness) {
        std::vector<double> thickness;
        for (const int v : part.vertices)
            thickness.push_back(thickness_[size_t(v)]);
        part.closed.emplace(mesh.faces, std::move(thickness));
        mesh.vertex_count *= 2;
        mesh.faces = part.closed->faces();
    }
    meshes_.push_back(std::move(mesh));
    parts_.push_back(std::move(part));
}

void ExportedSurface::append(View<const Vec3> x, std::vector<Vec3>& positions) const
{
    const std::vector<Vec3> file = state_->to_file(x);
    for (const Part& part : parts_) {
        std::vector<Vec3> of_part;
        of_part.reserve(part.vertices.size());
        for (const int v : part.vertices)
            of_part.push_back(file[size_t(v)]);
        if (part.closed)
            of_part = part.closed->positions(of_part);
        positions.insert(positions.end(), of_part.begin(), of_part.end());
    }
}

void ExportedSurface::append_attributes(View<const Vec3> x, const SkinDistance* skin,
                                        std::vector<float>& numbers) const
{
    if (attributes_.is_empty())
        return;
    const std::vector<std::vector<double>> values = attributes_.at(x, skin);
    for (const Part& part : parts_)
        for (const std::vector<double>& of_vertex : values)
            for (int side = 0; side < (part.closed ? 2 : 1); ++side)
                for (const int v : part.vertices)
                    numbers.push_back(float(of_vertex[size_t(own_vertex(*state_, v))]));
}

std::vector<Vec3> ExportedSurface::file_positions(const std::vector<std::vector<Vec3>>& meshes) const
{
    std::vector<Vec3> file(state_->file_mesh().positions.size(), Vec3::Zero());
    std::vector<bool> is_stored(file.size(), false);
    for (size_t m = 0; m < parts_.size(); ++m) {
        const std::vector<Vec3> of_part =
            parts_[m].closed ? exports::ClosedSurface::middle(meshes[m]) : meshes[m];
        for (size_t k = 0; k < of_part.size(); ++k) {
            file[size_t(parts_[m].vertices[k])] = of_part[k];
            is_stored[size_t(parts_[m].vertices[k])] = true;
        }
    }
    // Vertices without a face are in no group; they follow the cloth.
    const std::vector<Vec3> followed = state_->to_file(state_->from_file(file));
    for (size_t v = 0; v < file.size(); ++v)
        if (!is_stored[v])
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
        if (std::holds_alternative<scene::Plane>(scene.avatars[k].shape))
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
        subframes_ = first.subframes() > 1 ? first.subframes() : entry.subframes;
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
