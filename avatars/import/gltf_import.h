#pragma once

#include <filesystem>
#include <vector>

#include "avatars/model/skeletal_motion.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// True for a glTF file: by its extension, .gltf or .glb in any case, or by the first bytes of a .glb.
bool is_gltf(const std::filesystem::path& file);

/// Reads a glTF 2.0 model, in the file's units and axes. Every node becomes a joint, the meshes of the file's
/// scene are merged, seams are welded, weights sum to 1. A mesh without skin follows its node.
///
/// Read: skins, blend shapes, all interpolations of animations, sparse and normalised accessors, triangle
/// lists, strips and fans, KHR_mesh_quantization. Left out: points, lines, materials, images, cameras.
/// @throws InvalidInput in one line, naming the file and the place in its JSON, see load_avatar().
RiggedModel import_gltf(const std::filesystem::path& file);

/// Reads the joints and clips of a glTF 2.0 file, whether it has a surface or not.
/// @throws InvalidInput as import_gltf()
SkeletalMotion import_gltf_motion(const std::filesystem::path& file);

/// Files that a glTF file names: buffers and images.
/// @throws InvalidInput as import_gltf() if the JSON can't be read
std::vector<std::filesystem::path> files_of_gltf(const std::filesystem::path& file);

} // namespace toile::avatars
