#pragma once

#include <map>
#include <set>

#include "avatars/import/gltf_accessors.h"
#include "avatars/import/gltf_meshes.h"
#include "avatars/import/gltf_nodes.h"
#include "avatars/import/model_builder.h"

namespace toile::avatars {

/// Nodes whose blend shapes any animation of the file moves.
std::set<int> nodes_with_moving_shapes(const GltfFile& file);

/// Adds every animation of the file to the model as a clip, with the interpolation of its samplers. A clip
/// ends with its last key.        [glTF 2.0, section 3.11]
/// @param tree            from add_joints(), for the builder's skeleton
/// @param shapes_of_node  from GltfMeshes::read()
/// @throws InvalidInput naming the channel or sampler that is wrong.
void add_clips(GltfFile& file, GltfAccessors& accessors, const NodeTree& tree,
               const std::map<int, ShapeRange>& shapes_of_node, ModelBuilder& builder);

} // namespace toile::avatars
