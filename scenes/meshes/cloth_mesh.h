#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "scenes/format/scene.h"
#include "scenes/meshes/file_numbers.h"

namespace toile::scenes {

/// Name of the cloth's mesh in errors: its file, or cloth "name".
std::string source_of(const scene::Cloth& cloth);

/// Name of the mesh whose texture is the cloth's rest shape, in errors: its rest file, or as source_of().
std::string rest_source_of(const scene::Cloth& cloth);

/// Mesh of a cloth: scaled and rotated, but not translated. Equal cloths at several positions then have
/// bitwise equal rest shapes and share factors and tables.
struct ClothMesh {
    ObjMesh mesh;        ///< to simulate: seams joined, loose vertices dropped, windings agree
    FileNumbers numbers; ///< empty: the file's vertices are the first of `mesh`
    ObjMesh file;        ///< as in the file; empty without numbers, and where `mesh` is subdivided
    std::vector<std::string> warnings; ///< what was changed, without the source
};

/// Reads or cuts the cloth.
/// @throws InvalidInput for an unusable mesh, with the numbers of the file
ClothMesh cloth_mesh(const scene::Cloth& cloth);

/// The mesh of cloth_mesh() with the texture of the rest file in place of its own; positions of that file are
/// ignored.
/// @param cloth  with a rest file
/// @throws InvalidInput as cloth_mesh(), and naming the first face of the rest file that differs
ObjMesh mesh_at_rest(const scene::Cloth& cloth);

} // namespace toile::scenes
