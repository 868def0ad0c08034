#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "avatars/mannequin/mannequin.h"
#include "avatars/model/avatar.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Source of an avatar, with units and axes.
struct AvatarSettings {
    std::filesystem::path file; ///< empty: the built-in mannequin
    std::string unit;           ///< "m", "cm", "mm" or "in"; empty: default of the format (FBX cm, others m)
    std::string up;             ///< "y" or "z": the file's upward axis; empty: y
    MannequinSettings mannequin;
};

/// True for a format in centimetres, unless another unit is given: FBX.
bool is_in_centimetres(const std::filesystem::path& file);

/// Map from the units and axes of the file to metres with Y up.
/// @throws InvalidInput for an unknown unit or axis
Affine metres_from_file(const AvatarSettings& settings);

/// @throws InvalidInput naming `source` if no triangle has an area
void require_surface(const TriangleMesh& mesh, const std::string& source);

/// Loads any kind of avatar: the mannequin, .obj (static, vertex order kept), glTF, and every format of
/// assimp (meshes of a file merged, texture seams welded).
/// @throws InvalidInput in one line: file missing or unreadable, no triangles, a position, key or matrix that
///         is not finite, key times that descend, a vertex without weight, a bone or animation channel
///         without joint, an unknown unit or axis.
std::unique_ptr<Avatar> load_avatar(const AvatarSettings& settings);

} // namespace toile::avatars
