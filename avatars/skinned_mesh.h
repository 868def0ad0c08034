#pragma once

#include <string>
#include <vector>

#include "avatars/skeleton.h"
#include "avatars/skinning_kernels.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A bone of a mesh: the joint it follows and where the mesh stood in that joint's frame when it was bound.
struct Bone {
    int joint = -1;
    Affine joint_from_mesh = identity_affine(); ///< the "inverse bind matrix"
};

/// A surface tied to joints. Positions are in mesh space, which only the bones give a meaning.
struct SkinnedMesh {
    TriangleMesh rest;         ///< in mesh space, in the file's units
    std::vector<Bone> bones;   ///< any number per joint; files with several meshes bind each on its own
    std::vector<int> first{0}; ///< [vertices + 1] where a vertex's influences begin
    std::vector<Influence> influences; ///< [first.back()] heaviest first
    std::vector<int> space_of_vertex;  ///< [vertices] vertices of different spaces are never one point

    SkinView skin() const { return {rest.positions, first, influences}; } ///< borrowed
};

/// Drops weights that are not positive and scales the rest of each vertex to sum 1, heaviest first.
/// @param source  named in errors
/// @throws InvalidInput naming the first vertex that no weight holds, or a weight that is not finite.
void normalise_weights(SkinnedMesh& mesh, const std::string& source);

/// Joins vertices at one place that a file keeps apart only for texture or normal seams, and drops triangles
/// that lose a corner. Only border vertices are joined: coincident vertices inside a closed surface (lips,
/// eyelids) are two sheets that touch. Joining that would give an edge more than two triangles is undone.
/// Weights of joined vertices are averaged.
/// @param distance  two positions closer than this are one place [mesh units]
void weld_seams(SkinnedMesh& mesh, double distance);

/// The joint with the most weight over the corners of each triangle, of equals the lowest. [triangles]
std::vector<int> heaviest_joints(const SkinnedMesh& mesh);

} // namespace toile
