#pragma once

#include <filesystem>
#include <string>

#include "avatars/model/avatar.h"

namespace toile::avatars {

/// A clip in a file of its own.
struct MotionSource {
    std::filesystem::path file; ///< .bvh, .fbx, .glb or .gltf
    std::string clip{};         ///< empty: the longest of the file

    /// "names": the body has bones of the same names and axes, see copy_clip(). "cmu": retargeted from a
    /// skeleton of the CMU library, see map_from_cmu(). Else the path of a map, see read_joint_map().
    std::string map = "names";
};

/// Adds the clip to the clips of the body.
/// @return its name there: that in the file, or with a number if the body has a clip of that name
/// @throws InvalidInput in one line: a body without bones, and see read_motion_file(), clip_named() and the
///         functions of the map
std::string add_motion(Avatar& body, const MotionSource& source);

} // namespace toile::avatars
