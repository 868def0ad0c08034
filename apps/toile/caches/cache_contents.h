#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/toile/caches/cloth_attributes.h"
#include "apps/toile/caches/exported_mesh.h"
#include "core/mesh/triangle_mesh.h"
#include "export/cache_layout.h"
#include "export/mesh/cache_sample.h"
#include "export/point_cache.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::app {

/// The meshes that a cloth or solid becomes in a cache (ExportedMesh).
class ExportedSurface {
public:
    /// @param state  outlives this; its positions are ignored
    ExportedSurface(const scene::Export& entry, const scenes::ClothState& state);

    const std::vector<exports::CacheMesh>& meshes() const { return mesh_.meshes(); }

    /// Appends positions of all meshes. @param x  [vertices] of the cloth as simulated [m]
    void append(View<const Vec3> x, std::vector<Vec3>& positions) const;

    /// Appends the attributes of all meshes at that moment. @param skin  as ClothAttributes::at()
    void append_attributes(View<const Vec3> x, const SkinDistance* skin, std::vector<float>& numbers) const;

    /// Positions of the cloth's file_mesh() for those of all meshes, one vector each.
    std::vector<Vec3> file_positions(const std::vector<std::vector<Vec3>>& meshes) const;

private:
    const scenes::ClothState* state_;
    ClothAttributes attributes_;
    ExportedMesh mesh_;
};

/// What a scene's export writes: surfaces, and avatars after them. Cloths have the attributes of the entry.
class CacheContents {
public:
    /// @param surfaces  of the scene; outlive this
    /// @param avatars   of the scene, with their names; used if needs_avatars()
    CacheContents(const scene::Export& entry, const scenes::Scene& scene,
                  View<const scenes::ClothState> surfaces,
                  const std::vector<std::pair<std::string, const TriangleMesh*>>& avatars);

    const exports::CacheLayout& layout() const { return layout_; }

    /// Positions of all meshes in the export's axes, and their attributes. Called by one thread at a time.
    /// @param surface  gives the positions of a surface, numbered as World::surfaces() [m]
    /// @param avatars  [avatars of the scene] [m]; used if needs_avatars()
    exports::CacheSample sample(const std::function<View<const Vec3>(int surface)>& surface,
                                const std::vector<std::vector<Vec3>>& avatars);

private:
    void add_skin(const scenes::Scene& scene,
                  const std::vector<std::pair<std::string, const TriangleMesh*>>& avatars);

    std::vector<int> numbers_; ///< of the surfaces
    std::vector<ExportedSurface> surfaces_;
    bool has_avatars_;
    std::vector<size_t> skinned_; ///< avatars whose surfaces are the skin
    std::optional<SkinDistance> skin_;
    exports::CacheLayout layout_;
};

/// Whether an export depends on the avatars.
bool needs_avatars(const scene::Export& entry);

/// Opens the cache of a cloth in the file of an export: whole frames, in the order of the cloth's
/// file_mesh(), in metres with Y up. Its start frame counts from that of the entry, or is 0 if the entry has
/// none. Samples at irregular times are all there, with their times.
/// @param file   the export's, or what it is named until it is complete; may name the cloth's mesh
/// @param state  outlives the cache
/// @throws InvalidInput as read_cache(), or if the file has other meshes
exports::PointCache open_cloth(const std::filesystem::path& file, const scene::Export& entry,
                               const scenes::ClothState& state);

} // namespace toile::app
