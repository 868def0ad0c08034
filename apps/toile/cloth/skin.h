#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "scenes/colliders/scene_body.h"

namespace toile::app {

/// Surfaces of all bodies but planes as they are posed, in one mesh.
TriangleMesh skin_of(const std::vector<scenes::SceneBody>& bodies);

void append(TriangleMesh& mesh, View<const Vec3> positions, View<const Triangle> triangles);

} // namespace toile::app
