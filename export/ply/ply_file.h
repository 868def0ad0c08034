#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/mesh/obj.h"
#include "export/cache_layout.h"
#include "export/sequence/mesh_files.h"

namespace toile::exports {

/// Writes PLY files of a layout of one mesh, binary little endian: float x, y, z, and per polygon a list
/// vertex_indices, and a list texcoord with the texture coordinates of its corners, as MeshLab reads them. A
/// comment says the unit and the upward axis. Attributes are further properties of the vertices, panels of
/// the faces, with a comment for the name of each.
MeshFileWriter ply_file_writer(const CacheLayout& layout);

/// Reads positions, polygons and texture coordinates: those of corners (texcoord) or else those of vertices
/// (s, t or u, v or texture_u, texture_v), as Blender writes them. Text and both binary encodings; other
/// properties and elements are skipped.
/// @throws InvalidInput naming the file and the byte or line: no PLY, a size beyond the file, a vertex out of
///         range, a number that is not finite, a face of fewer than three or more than 10 000 corners
ObjMesh read_ply(const std::filesystem::path& file);

/// What the positions are, where the file says so in the comment of ply_file_writer().
/// @throws InvalidInput naming the file and the line, for a header that is none
std::optional<Axes> read_ply_axes(const std::filesystem::path& file);

/// The positions alone, with the same errors of what comes before them.
std::vector<Vec3> read_ply_positions(const std::filesystem::path& file);

} // namespace toile::exports
