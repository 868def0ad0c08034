#pragma once

#include "avatars/model/avatar.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// A body with one pose, in the vertex order of its file: all of it follows one bone.
class StaticAvatar final : public Avatar {
public:
    /// @param metres_from_file  units and axes of the file
    StaticAvatar(std::string source, TriangleMesh mesh, const Affine& metres_from_file);

    SkinView skin() const override { return {positions_, first_, influences_}; }
    int bone_count() const override { return 1; }
    void pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones) override;

private:
    std::vector<Vec3> positions_;
    std::vector<int> first_; ///< [vertices + 1] 0, 1, 2, ...
    std::vector<Influence> influences_;
    Affine metres_from_file_;
};

} // namespace toile::avatars
