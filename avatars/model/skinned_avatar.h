#pragma once

#include "avatars/model/avatar.h"
#include "avatars/model/clip.h"
#include "avatars/model/skinned_mesh.h"

namespace toile::avatars {

/// A rigged body with its motions, in the units and axes of its file.
struct RiggedModel {
    Skeleton skeleton;
    SkinnedMesh mesh;
    std::vector<Clip> clips;
    Affine metres_from_file = identity_affine();
};

/// A body with joints: clips drive the skeleton and the blend shapes, which drive the surface by linear blend
/// skinning.
class SkinnedAvatar final : public Avatar {
public:
    /// @param model  weights normalised; bones and tracks refer to joints of its skeleton
    SkinnedAvatar(std::string source, RiggedModel model);

    SkinView skin() const override { return model_.mesh.skin(); }
    int bone_count() const override
    {
        return int(model_.mesh.bones.size() + model_.mesh.shape_weights.size());
    }
    void pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones) override;

    std::vector<unsigned char> faces_on_bones(const std::vector<std::string>& bones,
                                              const std::string& user) const override;
    std::string bone_at(int vertex) const override;

    const RiggedModel& model() const { return model_; }

    /// Adds a clip, of joints of the skeleton.
    /// @return its name in clips(): "walk", or "walk#2" where the body has a "walk"
    std::string add_clip(Clip clip);

private:
    Vec3 root_travel(const Clip& clip) const;
    void pose_shapes(const PoseAt& at, View<Affine> maps);

    RiggedModel model_;
    std::vector<Vec3> travel_of_clip_; ///< [clips] horizontal displacement of the root in one cycle [m]
    std::vector<JointTransform> local_;
    std::vector<Affine> frames_;
    std::vector<double> shape_weights_;
};

} // namespace toile::avatars
