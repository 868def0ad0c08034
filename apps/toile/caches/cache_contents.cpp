#include "apps/toile/caches/cache_contents.h"

#include <memory>
#include <numeric>
#include <utility>

#include "apps/toile/caches/exports.h"
#include "core/base/error.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/mesh/mesh_part.h"

namespace toile::app {

namespace {

/// [file vertices] [m]
std::vector<double> thickness_of(const scenes::ClothState& state)
{
    const auto of_vertex = [&](int v) {
        return state.vertex_thickness.empty() ? state.fabric.thickness : state.vertex_thickness[size_t(v)];
    };
    std::vector<double> thickness;
    thickness.reserve(state.file_mesh().positions.size());
    for (int v = 0; v < int(state.file_mesh().positions.size()); ++v)
        thickness.push_back(of_vertex(state.has_file_order() ? state.numbers.vertex[size_t(v)] : v));
    return thickness;
}

} // namespace

ExportedSurface::ExportedSurface(const scene::Export& entry, const scenes::ClothState& state)
    : state_(&state), thickness_(thickness_of(state))
{
    const ObjMesh& whole = state.file_mesh();
    const std::vector<exports::MeshPart> groups =
        entry.weld ? std::vector<exports::MeshPart>{} : exports::parts_of(whole);
    if (groups.size() > 1) {
        for (const exports::MeshPart& group : groups)
            add_part(entry, {group.name, state.name, int(group.vertices.size()), group.faces},
                     group.vertices);
        return;
    }
    exports::CacheMesh mesh{state.name, "", int(whole.positions.size()), exports::faces_only(whole)};
    std::vector<int> all(whole.positions.size());
    std::iota(all.begin(), all.end(), 0);
    add_part(entry, std::move(mesh), std::move(all));
}

void ExportedSurface::add_part(const scene::Export& entry, exports::CacheMesh mesh, std::vector<int> vertices)
{
    Part part{std::move(vertices), std::nullopt};
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
        surfaces_.emplace_back(entry, surfaces[number]);
        for (const exports::CacheMesh& mesh : surfaces_.back().meshes())
            layout_.meshes.push_back(mesh);
    }
    if (has_avatars_)
        for (const auto& [name, mesh] : avatars)
            layout_.meshes.push_back({name, "", mesh->vertex_count(), exports::faces_only(faces_of(*mesh))});
    layout_.frame_count = sample_count(scene, entry);
        times = first.times();
    layout_.fps = scene.fps;
    layout_.subframes = entry.subframes;
    layout_.start_frame = start_frame_of(entry);
    layout_.axes = axes_of(entry);
    layout_.velocities = entry.velocities;
    layout_.normals = entry.normals;
}

std::vector<Vec3> CacheContents::positions(const std::function<View<const Vec3>(int surface)>& surface,
                                           const std::vector<std::vector<Vec3>>& avatars) const
{
    std::vector<Vec3> positions;
    positions.reserve(size_t(layout_.vertex_count()));
    for (size_t s = 0; s < surfaces_.size(); ++s)
        surfaces_[s].append(surface(numbers_[s]), positions);
    if (has_avatars_)
        for (const std::vector<Vec3>& avatar : avatars)
            positions.insert(positions.end(), avatar.begin(), avatar.end());
    exports::change_axes({}, layout_.axes, positions);
    return positions;
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
