#pragma once

#include <memory>
#include <optional>

#include "avatars/contact_surface.h"
#include "avatars/moving_avatar.h"
#include "collision/mesh_poses.h"
#include "scenes/format/scene.h"

namespace toile {

/// An avatar of a scene that has bones, from one step to the next. As poses: of the surface that cloth
/// touches, all of it but for faces of excluded bones (ContactSurface).
class Figure final : public MeshPoses {
public:
    /// Loads the avatar and shows it at t = 0.
    /// @param carried  see advance_to()
    /// @throws InvalidInput for files, clips and bones that do not work.
    Figure(const scene::Avatar& settings, const Affine& carried);

    bool is_static() const { return avatar_.is_static(); } ///< of itself: it may be carried

    /// The end of the last step becomes the start of this one, which ends at t_t1 [s].
    /// @param carried  moves it as a whole at its end
    /// @return false when both ends are the same
    bool advance_to(double t_t1, const Affine& carried);

    // The whole body's.
    const std::vector<Triangle>& triangles() const { return avatar_.avatar().triangles(); }
    int body_vertex_count() const { return avatar_.avatar().vertex_count(); }

    const std::vector<Triangle>& contact_triangles() const
    {
        return contact_ ? contact_->triangles() : triangles();
    }
    bool is_all_touched() const { return !contact_; }

    /// The body's number of a face of the contact surface, -1 where that is a lid over a cut.
    int face_of(int contact_triangle) const
    {
        return contact_ ? contact_->face_of(contact_triangle) : contact_triangle;
    }

    /// A vertex of the contact surface at t1 [m].
    Vec3 vertex_t1(int v) const;

    /// Of the contact surface: the body's, then the lids' middles.
    int vertex_count() const override { return contact_ ? contact_->vertex_count() : body_vertex_count(); }
    void pose_t0(View<Vec3> x) const override { pose(avatar_.bones_t0(), x); }
    void pose_t1(View<Vec3> x) const override { pose(avatar_.bones_t1(), x); }
    std::unique_ptr<DeviceMeshPoses> on_device(const CudaSpace& space) const override;

private:
    class OnDevice;
    void pose(View<const Affine> bones, View<Vec3> x) const;

    MovingAvatar avatar_;
    std::optional<ContactSurface> contact_; ///< none: all of the body
};

} // namespace toile
