#pragma once

#include <cmath>
#include <limits>

#include "collision/contact/spring.h"
#include "collision/geometry/contact_pair.h"

namespace toile::collision {

/// Multiplier of a term that must keep a minimum gap, as the shift of its spring: the augmented Lagrangian of
///
///   gap >= min_gap;      shift = max(0, shift + gain (min_gap - gap))
///
/// [Hestenes 1969, Powell 1969]. The gain is 1, and grows where an update does little because what presses
/// the cloth, such as cloth at its strain limit, is stiffer than the spring. Far from the minimum it does
/// not.
struct ContactMultiplier {
    double shift = 0.0;     ///< [m]
    double shortfall = 0.0; ///< [m] min_gap - gap at the last look; 0 if there was none since an update
    double before = 0.0;    ///< [m] the same at the last update
    double gain = 1.0;      ///< [-]

    /// Part of a shortfall [-] of which an update that does little leaves more; growth and bound of the gain.
    static constexpr double kLeft = 0.5, kGrowth = 2.0, kMaxGain = 64.0;
    /// Shortfall that is no reason to grow, and bound of the shift, relative to `most` [-].
    static constexpr double kNoise = 0.25, kMaxShift = 200.0;

    /// @param most     bound of the shortfall of iterates that go astray [m]
    /// @param is_near  the minimum is
    TOILE_HD void update(double most, bool is_near)
    {
        const bool did_little = shortfall > kNoise * most && before > 0.0 && shortfall > kLeft * before;
        if (shortfall < 0.0 || !is_near)
            gain = 1.0;
        else if (did_little && gain < kMaxGain)
            gain *= kGrowth;
        const double next = shift + gain * (shortfall < most ? shortfall : most);
        shift = next > 0.0 ? (next < kMaxShift * most ? next : kMaxShift * most) : 0.0;
        before = shortfall;
        shortfall = 0.0;
    }
};

/// Contact pair with the data of its energy.
struct ContactTerm {
    ContactPair pair;
    double offset = 0.0;                                       ///< [m] gap to keep between cloth and surface
    double min_gap = -std::numeric_limits<double>::infinity(); ///< [m] below which it gets a multiplier
    ContactSpring spring;                                      ///< along the normal
    double friction = 0.0;                                     ///< [-] Coulomb coefficient
    Vec3 anchor = Vec3::Zero(); ///< [m] sticking position of the cloth point, in space at t1
    double give = 0.0; ///< [m] depth below the offset at which a step may end: cloth gripped from both sides
    double normal_force = 0.0; ///< [N] lagged, bounds friction
    double pressing = 0.0;     ///< [N] its successor, from the last update
    ContactMultiplier multiplier;

    /// Slip at which friction reaches its limit, relative to the spring's ramp [-].
    static constexpr double kSlipPerRamp = 0.05;

    /// Bound of a shortfall, relative to the depth from which on the spring hardens [-].
    static constexpr double kMostPerHard = 0.4;

    TOILE_HD bool has_min_gap() const { return min_gap > -std::numeric_limits<double>::infinity(); }

    TOILE_HD void update_multiplier(bool is_near)
    {
        if (multiplier.shortfall == 0.0)
            return;
        multiplier.update(kMostPerHard * spring.hard, is_near);
        spring.shift = multiplier.shift;
    }

    /// Gap g at x [m]; negative if the term presses.
    TOILE_HD double gap(View<const Vec3> x) const { return pair.gap(x) - offset; }

    /// Force of the normal spring at x [N].
    TOILE_HD double pressing_force(View<const Vec3> x) const { return spring.force(-gap(x)); }

    /// Depth at which the spring has the lagged normal force [m].
    TOILE_HD double rest_depth() const { return spring.depth_of(normal_force); }

    /// Part of anchor-to-cloth in the tangent plane, u [m].
    TOILE_HD Vec3 slip(View<const Vec3> x) const
    {
        const Vec3 moved = pair.cloth_point(x) - anchor;
        return moved - pair.normal.dot(moved) * pair.normal;
    }

    /// True if it pressed at the last update or at the one that bounds friction.
    TOILE_HD bool has_pressed() const { return normal_force != 0.0 || pressing != 0.0; }

    TOILE_HD double friction_limit() const { return friction * normal_force; } ///< Coulomb's L [N]

    /// Stiffness k of sticking friction [N/m]. It reaches the limit no earlier than at the slip u_s =
    /// kSlipPerRamp ramp, or errors far below the tolerance of a step would turn sticking into sliding.
    TOILE_HD double sticking_stiffness() const
    {
        const double limit = friction_limit(), slip = kSlipPerRamp * spring.ramp;
        return limit < spring.stiffness * slip ? limit / slip : spring.stiffness;
    }

    /// Stiffness of friction at slip length |u| [m]: k while it sticks, L/|u| while it slides [N/m].
    TOILE_HD double tangential_stiffness(double slip_length) const
    {
        const double limit = friction_limit(), sticking = sticking_stiffness();
        return sticking * slip_length <= limit ? sticking : limit / slip_length;
    }

    /// Fraction of its limit from which on friction counts as sliding [-]. Where it has slid in the step
    /// before, it begins the next one at the limit, up to rounding.
    static constexpr double kSliding = 0.9;

    TOILE_HD bool is_sliding(double slip_length) const
    {
        return friction_limit() > 0.0 && sticking_stiffness() * slip_length > kSliding * friction_limit();
    }

    /// Energy of friction at slip length |u| [J].
    TOILE_HD double friction_energy(double slip_length) const
    {
        const double limit = friction_limit(), sticking = sticking_stiffness();
        return sticking * slip_length <= limit ? 0.5 * sticking * slip_length * slip_length
                                               : limit * (slip_length - 0.5 * limit / sticking);
    }
};

/// Stiffness of a term in its frozen Hessian: normal n n^T + tangential (I - n n^T - s s^T) [N/m].
struct FrozenContact {
    double normal = 0.0, tangential = 0.0;
    /// s [-]: unit direction in which friction slides and resists no more; zero while it sticks.
    Vec3 sliding{0.0, 0.0, 0.0};

    TOILE_HD bool is_active() const { return normal > 0.0 || tangential > 0.0; }
    TOILE_HD Vec3 times(const Vec3& n, const Vec3& u) const
    {
        const Vec3 resisted = tangential * u + (normal - tangential) * n.dot(u) * n;
        return resisted - tangential * sliding.dot(u) * sliding;
    }
    TOILE_HD Mat3 matrix(const Vec3& n) const
    {
        return bound(n) - tangential * sliding * sliding.transpose();
    }
    /// Matrix that also resists sliding.
    TOILE_HD Mat3 bound(const Vec3& n) const
    {
        return tangential * Mat3::Identity() + (normal - tangential) * n * n.transpose();
    }
};

} // namespace toile::collision
