#pragma once

#include <cmath>

#include "collision/contact_pair.h"

namespace toile {

/// A contact pair with everything its energy needs.
struct ContactTerm {
    ContactPair pair;
    double offset = 0.0;        ///< [m] gap to keep between cloth and surface
    double stiffness = 0.0;     ///< [N/m] w, of the normal spring and of sticking
    double friction = 0.0;      ///< [-] Coulomb coefficient
    Vec3 anchor = Vec3::Zero(); ///< [m] where the cloth point would stick, in space at t1
    double give = 0.0;          ///< [m] below the offset where a step may end: cloth gripped from both sides
    double normal_force = 0.0;  ///< [N] lagged, bounds friction

    /// Gap g at x [m]; negative where it pushes.
    TOILE_HD double gap(View<const Vec3> x) const { return pair.gap(x) - offset; }

    /// Force of the normal spring at x [N].
    TOILE_HD double pressing_force(View<const Vec3> x) const
    {
        const double depth = -gap(x);
        return depth > 0.0 ? stiffness * depth : 0.0;
    }

    /// Part of anchor-to-cloth in the tangent plane, u [m].
    TOILE_HD Vec3 slip(View<const Vec3> x) const
    {
        const Vec3 moved = pair.cloth_point(x) - anchor;
        return moved - pair.normal.dot(moved) * pair.normal;
    }

    TOILE_HD double friction_limit() const { return friction * normal_force; } ///< Coulomb's L [N]

    /// Friction's stiffness at slip length |u| [m]: w while sticking, L/|u| while sliding [N/m].
    TOILE_HD double tangential_stiffness(double slip_length) const
    {
        const double limit = friction_limit();
        return stiffness * slip_length <= limit ? stiffness : limit / slip_length;
    }
};

/// Stiffness of a term in its Hessian as it was frozen: normal n n^T + tangential (I - n n^T) [N/m].
struct FrozenContact {
    double normal = 0.0, tangential = 0.0;

    TOILE_HD bool acts() const { return normal > 0.0 || tangential > 0.0; }
    TOILE_HD Vec3 times(const Vec3& n, const Vec3& u) const
    {
        return tangential * u + (normal - tangential) * n.dot(u) * n;
    }
    TOILE_HD Mat3 matrix(const Vec3& n) const
    {
        return tangential * Mat3::Identity() + (normal - tangential) * n * n.transpose();
    }
};

} // namespace toile
