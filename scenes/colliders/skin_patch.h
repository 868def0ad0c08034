#pragma once

#include <vector>

#include "collision/body/colliders.h"

namespace toile::scenes {

/// Frame of the skin around a point: the rigid motion that fits all vertices within 2 cm best, nearer ones
/// more. The frame of a single triangle would turn and stretch with every fold of the skin.
class SkinPatch {
public:
    /// @param at     point of the mesh's surface at the start
    /// @param index  [mesh vertices] number of each in the list that later gives positions; -1: not yet in it
    /// @param used   that list of mesh vertices; grows by those that this patch needs
    SkinPatch(const collision::MeshCollider& mesh, View<const Vec3> normals,
              const collision::SurfacePoint& at, std::vector<int>& index, std::vector<int>& used);

    /// Where a point that moves with the skin is now. @param start  at the start [m]
    /// @param positions  [used] now [m]
    Vec3 moved(const Vec3& start, View<const Vec3> positions) const;

private:
    std::vector<int> vertex_;    ///< numbers in `used`
    std::vector<double> weight_; ///< sum 1
    std::vector<Vec3> start_;    ///< [vertex_] from the weighted mean at the start [m]
    Vec3 mean_ = Vec3::Zero();   ///< at the start [m]
};

} // namespace toile::scenes
