#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "avatars/avatar.h"
#include "avatars/mannequin/mannequin.h"

namespace toile {

/// Which body to use.
struct AvatarSettings {
    std::filesystem::path file; ///< empty: the built-in mannequin
    std::string unit;           ///< "m", "cm", "mm" or "in"; empty: what the format says (FBX cm, others m)
    std::string up = "y";       ///< "y" or "z": the file's upward axis
    MannequinSettings mannequin;
};

/// The one door to every kind of avatar: the mannequin, .obj (static, vertex order kept), .gltf/.glb and
/// whatever else the importer reads (meshes of a file merged, texture seams welded).
/// @throws InvalidInput in one line: file missing or unreadable, no triangles, a position that is not finite,
///         a vertex without weight, a bone or animation channel without joint, an unknown unit or axis.
std::unique_ptr<Avatar> load_avatar(const AvatarSettings& settings);

} // namespace toile
