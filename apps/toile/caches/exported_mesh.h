#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "export/cache_layout.h"
#include "export/mesh/closed_surface.h"
#include "export/mesh/mesh_part.h"

namespace toile::app {

/// The meshes that a mesh becomes in a cache: itself, or one for each group of its faces; each with or
/// without a thickness.
class ExportedMesh {
public:
    struct Parts {
        bool weld = true;        ///< false: one mesh for each group
        bool has_panels = false; ///< faces are numbered by their groups
    };
    /// @param whole      name, place, faces, number of vertices and names of their values
    /// @param thickness  [vertices] [units of the positions]; empty: sheets
    ExportedMesh(const exports::CacheMesh& whole, const Parts& parts, const std::vector<double>& thickness);

    const std::vector<exports::CacheMesh>& meshes() const { return meshes_; }

    /// Appends positions of all meshes. @param x  [vertices] of the whole
    void append(View<const Vec3> x, std::vector<Vec3>& positions) const;

    /// Appends values of the vertices of all meshes, for each mesh one quantity after the other.
    /// @param of_whole  [quantities][vertices]
    void append_values(const std::vector<std::vector<double>>& of_whole, std::vector<float>& values) const;

    /// Positions of the whole for those of all meshes, one vector each; none of vertices that are in no mesh,
    /// for they are in no group.
    std::vector<std::optional<Vec3>> whole(const std::vector<std::vector<Vec3>>& meshes) const;

private:
    struct Part {
        std::vector<int> vertices; ///< of the whole
        std::optional<exports::ClosedSurface> closed;
    };
    void add_part(exports::CacheMesh mesh, std::vector<int> vertices, const std::vector<double>& thickness);

    void number_panels(const std::vector<exports::MeshPart>& groups);

    int vertex_count_;
    std::vector<exports::CacheMesh> meshes_;
    std::vector<Part> parts_; ///< [meshes]
};

} // namespace toile::app
