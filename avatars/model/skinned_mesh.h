#pragma once

#include <string>
#include <vector>

#include "avatars/model/skeleton.h"
#include "avatars/model/skinning_kernels.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// A bone of a mesh: the joint it follows, and the mesh in that joint's frame in the bind pose.
struct Bone {
    int joint = -1;
    Affine joint_from_mesh = identity_affine(); ///< the "inverse bind matrix"
};

/// A surface bound to joints, with blend shapes. Positions are in mesh space, which has a meaning only
/// through the bones.
struct SkinnedMesh {
    TriangleMesh rest;                 ///< in mesh space, in the file's units
    std::vector<Bone> bones;           ///< any number per joint; each mesh of a file has its own bones
    std::vector<int> first{0};         ///< [vertices + 1] start of a vertex's influences
    std::vector<Influence> influences; ///< [first.back()] heaviest first
    std::vector<int> space_of_vertex;  ///< [vertices] vertices of different spaces are never welded

    std::vector<double> shape_weights; ///< [shapes] in the bind pose
    std::vector<int> first_offset;    ///< [vertices + 1] start of a vertex's offsets; empty if there are none
    std::vector<ShapeOffset> offsets; ///< [first_offset.back()]

    SkinView skin() const ///< borrowed
    {
        return {rest.positions, first, influences, first_offset, offsets, int(bones.size())};
    }
};

/// Drops weights that are not positive and scales the others of each vertex to sum 1, heaviest first.
/// @param source  named in errors
/// @throws InvalidInput naming the first vertex without weight, or a weight that is not finite.
void normalise_weights(SkinnedMesh& mesh, const std::string& source);

/// Welds coincident vertices that a file separates only for texture or normal seams, and drops triangles that
/// lose a corner. Only border vertices are welded: coincident vertices inside a closed surface (lips,
/// eyelids) are two sheets that touch. A weld that would give an edge more than two triangles is undone.
/// Weights and offsets of welded vertices are averaged.
/// @param distance  below which two positions are coincident [mesh units]
/// @return [old vertices] their new indices
std::vector<int> weld_seams(SkinnedMesh& mesh, double distance);

/// False for a triangle that has lost a corner.
inline bool has_three_corners(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

/// Joint with the largest weight over the corners of each triangle; on a tie, the lowest. [triangles]
std::vector<int> heaviest_joints(const SkinnedMesh& mesh);

} // namespace toile::avatars
