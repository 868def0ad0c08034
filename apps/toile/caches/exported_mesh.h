#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "export/cache_layout.h"
#include "export/mesh/closed_surface.h"

namespace toile::app {

/// The meshes that a mesh becomes in a cache: itself, or one for each group of its faces; each with or
/// without a thickness.
class ExportedMesh {
public:
    /// @param whole      name, place, faces and number of vertices
    /// @param thickness  [vertices] [units of the positions]; empty: sheets
    ExportedMesh(const exports::CacheMesh& whole, bool weld, const std::vector<double>& thickness);

    const std::vector<exports::CacheMesh>& meshes() const { return meshes_; }

    /// Appends positions of all meshes. @param x  [vertices] of the whole
    void append(View<const Vec3> x, std::vector<Vec3>& positions) const;

    /// Positions of the whole for those of all meshes, one vector each; none of vertices that are in no mesh,
    /// for they are in no group.
    std::vector<std::optional<Vec3>> whole(const std::vector<std::vector<Vec3>>& meshes) const;

private:
    struct Part {
        std::vector<int> vertices; ///< of the whole
        std::optional<exports::ClosedSurface> closed;
    };
    void add_part(exports::CacheMesh mesh, std::vector<int> vertices, const std::vector<double>& thickness);

    int vertex_count_;
    std::vector<exports::CacheMesh> meshes_;
    std::vector<Part> parts_; ///< [meshes]
};

} // namespace toile::app
