#pragma once

#include "avatars/avatar.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A body that keeps one pose, vertex for vertex as its file stores it.
class StaticAvatar final : public Avatar {
public:
    /// @param metres_from_file  units and axes of the file
    StaticAvatar(std::string source, TriangleMesh mesh, const Affine& metres_from_file);

    void pose(const PoseAt& at, const Affine& world_from_avatar, View<Vec3> out) override;

private:
    std::vector<Vec3> positions_;
    Affine metres_from_file_;
};

} // namespace toile
