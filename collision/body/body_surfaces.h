#pragma once

#include <vector>

#include "collision/body/collider_pairs_kernels.h"
#include "collision/body/colliders.h"

namespace toile::collision {

/// Triangle surfaces of all colliders as one list of vertices, at both ends of the current step: meshes as
/// they are, boxes by their sides, round shapes by facets just below them. Planes are left out: nothing
/// passes through a half space.
class BodySurfaces {
public:
    /// @param sag  [m] maximum depth of facets below a round shape
    BodySurfaces(const std::vector<ContactCollider>& colliders, double sag);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    int vertex_count() const { return vertex_count_; }
    bool is_empty() const { return triangles_.empty(); }
    bool is_moving() const;  ///< in the current step
    bool has_jumped() const; ///< likewise, as of the last find_jumps()

    /// Maximum speed of a surface that carries cloth along [m/s]. A faster one was replaced.
    static constexpr double kMaxSpeed = 50.0;

    /// Finds the colliders that jump in the current step of dt [s]. They are at their poses at t1 all the
    /// time.
    bool find_jumps(double dt);
    std::vector<int> colliders() const; ///< [vertices] numbers of the colliders in the constructor's list
    /// [colliders] 1: a mesh with a border, which has no inside
    View<const unsigned char> open_colliders() const { return is_open_; }
    std::vector<unsigned char> are_open() const; ///< [vertices] 1: of such a mesh

    bool is_inside(const Vec3& x) const; ///< of a body at t1 that has an inside
    /// Unit normal at t1 of a surface point, or of a solid near x.
    Vec3 normal_at(const NearestSurface& at, const Vec3& x) const;
    /// Mean displacement of that triangle in the step, or of a solid at x [m]; zero if it jumps.
    Vec3 motion_of(const NearestSurface& at, const Vec3& x) const;
    /// Distance at t1 of x from the triangle of a surface point, or from a solid [m].
    double distance_to(const NearestSurface& at, const Vec3& x) const;

    /// Positions at t0 and t1 of the current step. @param x  [vertices] out [m]
    void pose_t0(View<Vec3> x) const;
    void pose_t1(View<Vec3> x) const;

private:
    struct Part {
        ContactCollider collider;
        int number;               ///< of the collider
        int first;                ///< vertex
        int count;                ///< vertices
        std::vector<Vec3> facets; ///< [vertices] of a shape, in its own frame [m]
        bool jumps;               ///< in the current step
    };

    static bool is_moving(const Part& part);
    void pose(const Part& part, View<Vec3> x, bool is_end) const;

    std::vector<ContactCollider> colliders_;
    std::vector<unsigned char> is_open_; ///< [colliders]
    std::vector<Part> parts_;
    std::vector<Triangle> triangles_;
    int vertex_count_ = 0;
};

} // namespace toile::collision
