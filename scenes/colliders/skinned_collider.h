#pragma once

#include <memory>
#include <optional>

#include "avatars/model/contact_surface.h"
#include "avatars/model/moving_avatar.h"
#include "collision/body/mesh_poses.h"
#include "scenes/colliders/skin_insets.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// An avatar of a scene with bones, advanced from step to step. The poses are of its contact surface: all
/// faces but those of excluded bones (ContactSurface), and apart where they touched (SkinInsets).
class SkinnedCollider final : public collision::MeshPoses {
public:
    /// Loads the avatar and poses it at t = 0.
    /// @param root_transform  see advance_to()
    /// @throws InvalidInput for files, clips and bones that do not work.
    SkinnedCollider(const scene::Avatar& settings, const avatars::Affine& root_transform);

    bool is_static() const { return avatar_.is_static(); } ///< without its root transform, which may move it

    /// Advances to the step that starts at the end of the last one and ends at t_t1 [s].
    /// @param root_transform  rigid motion of the whole avatar at t_t1
    /// @return false if both poses are equal
    bool advance_to(double t_t1, const avatars::Affine& root_transform);

    /// See MovingAvatar.
    double max_motion_to(double t, const avatars::Affine& root_transform);

    // The whole body.
    const std::vector<Triangle>& triangles() const { return avatar_.avatar().triangles(); }
    int body_vertex_count() const { return avatar_.avatar().vertex_count(); }
    const avatars::Avatar& avatar() const { return avatar_.avatar(); }
    View<const avatars::Affine> bones_t0() const { return avatar_.bones_t0(); } ///< for avatar().skin()
    View<const avatars::Affine> bones_t1() const { return avatar_.bones_t1(); } ///< likewise

    const std::vector<Triangle>& contact_triangles() const
    {
        return contact_ ? contact_->triangles() : triangles();
    }
    bool is_all_collidable() const { return !contact_; }

    /// See MovingAvatar.
    std::optional<double> end_time() const { return avatar_.end_time(); }

    /// Index in triangles() of a face of the contact surface, -1 for a lid over a cut.
    int face_of(int contact_triangle) const
    {
        return contact_ ? contact_->face_of(contact_triangle) : contact_triangle;
    }

    /// Vertex of the whole body that is nearest to x at t1, within max_distance [m]; -1 if there is none.
    /// O(vertices).
    int nearest_vertex(const Vec3& x, double max_distance) const;

    /// A vertex of the contact surface at t1 [m].
    Vec3 vertex_t1(int v) const;

    /// Vertices of the contact surface: the body's, then the centres of the lids.
    int vertex_count() const override { return contact_ ? contact_->vertex_count() : body_vertex_count(); }
    void pose_t0(View<Vec3> x) const override { pose(avatar_.bones_t0(), insets_t0_, x); }
    void pose_t1(View<Vec3> x) const override { pose(avatar_.bones_t1(), insets_t1_, x); }
    std::unique_ptr<collision::DeviceMeshPoses> on_device(const CudaSpace& space) const override;

private:
    class OnDevice;
    std::vector<Triangle> faces_for_contact() const;
    avatars::SkinView skin(View<const double> insets) const;
    void pose(View<const avatars::Affine> bones, View<const double> insets, View<Vec3> x) const;

    avatars::MovingAvatar avatar_;
    std::optional<avatars::ContactSurface> contact_; ///< none: the whole body
    std::optional<SkinInsets> insets_;               ///< if skin is separated from skin
    std::vector<double> insets_t0_, insets_t1_;      ///< [body vertices] in the current step [m]
};

} // namespace toile::scenes
