#pragma once

#include <vector>

#include "avatars/import/gltf_file.h"
#include "avatars/model/skeleton.h"

namespace toile::avatars {

/// The nodes of a file as joints, parents before children.
struct NodeTree {
    std::vector<int> order;         ///< [nodes] depth first
    std::vector<int> joint_of_node; ///< [nodes] index in the skeleton
    std::vector<char> is_drawn;     ///< [nodes] 1 in the file's scene; in a file without scenes everywhere
};

/// Adds every node to the skeleton, by its index: nodes of one name get distinct names, nodes without a name
/// are "nodes_3".
/// @throws InvalidInput for a node with two parents or below itself, a scene that lists a child, and a
///         transform that is no translation, rotation and scale.
NodeTree add_joints(const GltfFile& file, Skeleton& skeleton);

/// Upper three rows of a glTF matrix.
/// @param columns  16 numbers
/// @param place    named in errors
/// @throws InvalidInput for a fourth row other than 0, 0, 0, 1.
Affine affine_of(const double* columns, const GltfValue& place);

} // namespace toile::avatars
