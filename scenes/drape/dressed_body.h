#pragma once

#include <optional>

#include "avatars/landmarks/body_segments.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// A body in the pose to be dressed.
struct DressedBody {
    TriangleMesh skin; ///< empty: a shape
    std::optional<avatars::BodySegments> segments;

    /// Loads the skin of a body that has one, and its segments if it has some.
    /// @param needs_segments  panels are placed by them
    /// @throws InvalidInput for a file that can't be read, and for needed segments that can't be found
    DressedBody(const scene::Avatar& body, bool needs_segments);
};

} // namespace toile::scenes
