#pragma once

#include <filesystem>
#include <optional>

#include "core/mesh/obj.h"
#include "export/axes.h"

namespace toile::scenes {

/// A surface of a file, in the units and axes of the file.
struct MeshFile {
    ObjMesh mesh;
    std::optional<exports::Axes> axes; ///< empty if the file does not say
};

/// Reads an OBJ, or the first sample of a cache with faces: tee.abc#/tee/teeShape, tee_####.obj. Vertex
/// order, polygons, texture coordinates and groups are those of the file.
/// @throws InvalidInput as read_obj() and read_cache(), and for a cache without faces
MeshFile read_mesh_file(const std::filesystem::path& file);

/// Start of a message about a polygon: "tee.obj:12" by its line, "tee.abc (face 3)" where it has none.
std::string name_of_face(const ObjMesh& mesh, int polygon, const std::string& source);

} // namespace toile::scenes
