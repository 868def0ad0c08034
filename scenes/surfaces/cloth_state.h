#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "garment/fabric/fabric.h"
#include "scenes/meshes/file_numbers.h"

namespace toile::scenes {

/// Public state of a cloth of a running scene, or of the surface of a solid.
struct ClothState {
    std::string name;
    std::vector<Vec3> positions; ///< [vertices] current [m]
    std::vector<Triangle> triangles;
    ObjMesh rest; ///< start placement, faces and texture coordinates as simulated
    /// [triangles] rest shape, each corner in the plane of its panel [m]; empty: the triangles of `rest`.
    std::vector<FlatTriangle> panels;
    garment::Fabric fabric; ///< of a solid: none, and a strain limit of 0, of a soft body infinity;
                            ///< thickness: the largest
    std::vector<garment::Fabric> group_fabrics; ///< of groups that have their own
    /// [triangles] 0: `fabric`; k: group_fabrics[k - 1]. Empty: all are of `fabric`.
    std::vector<int> fabric_of_triangle;

    std::vector<double> stiffness;        ///< [triangles] factor on that of the fabrics [-]; empty: 1
    std::vector<double> vertex_thickness; ///< [vertices] [m]; empty: the fabric's

    std::vector<garment::Fabric> fabrics() const; ///< `fabric`, then group_fabrics
    /// Triangles in each of fabrics(), ascending.
    std::vector<std::vector<int>> triangles_by_fabric() const;

    FileNumbers numbers; ///< of the file's vertices; empty: those of `rest` come first, in its order
    ObjMesh file;        ///< the file's mesh in the start placement; empty: `rest` has its vertices and more

    /// Caches are in its order, so that they play on it.
    const ObjMesh& file_mesh() const { return has_file_order() ? file : rest; }
    bool has_file_order() const { return !file.positions.empty(); }

    /// [file vertices] positions for those of the cloth [m].
    std::vector<Vec3> to_file(View<const Vec3> x) const;
    /// [vertices] positions of the cloth for those of file_mesh() [m].
    std::vector<Vec3> from_file(View<const Vec3> x) const;
    /// Vertex of the cloth that one of the file is.
    /// @param location  for errors
    /// @param remedy    for a vertex without a face: what to do with vertices of the surface
    /// @throws InvalidInput for one that does not exist or has no face
    int vertex_of_file(int file_vertex, const std::string& location, const std::string& remedy) const;
    /// Number in the file of a vertex of the cloth.
    int file_vertex(int vertex) const;

    struct Attachment {
        std::vector<int> vertices;
        double release = std::numeric_limits<double>::infinity(); ///< [s]
    };
    std::vector<Attachment> attachments;

    /// [vertices] 1 for those that are attached at time t [s].
    std::vector<unsigned char> attached(double t) const;
};

} // namespace toile::scenes
