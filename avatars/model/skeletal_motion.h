#pragma once

#include <string>
#include <vector>

#include "avatars/model/clip.h"

namespace toile::avatars {

/// Clips of a skeleton without a surface, in the units and axes of their file.
struct SkeletalMotion {
    std::string source; ///< the file, named in errors
    Skeleton skeleton;
    std::vector<Clip> clips;  ///< without blend shapes
    bool has_surface = false; ///< the file has triangles too
};

} // namespace toile::avatars
