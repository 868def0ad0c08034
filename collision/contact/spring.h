#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile::collision {

/// Normal spring of a contact term. Its stiffness grows with the depth from 0 to w over a ramp D and stays w
/// beyond, so that the energy is twice differentiable:
///
///   force   w d^2 / (2 D)    d <= D
///           w (d - D / 2)    beyond
///
/// A linear spring as stiff as cloth has its whole stiffness at once. Depth errors of an unfinished
/// minimisation, micrometres, would then give forces above the cloth's weight and friction limits from these
/// forces. Every iteration would switch springs on and off (docs/theory/contact.md).
///
/// From the depth `hard` on, a second spring adds to it, kHardening times as stiff after a ramp of its own:
/// cloth that is squeezed meets more resistance before there is no gap left. Where that is not enough, the
/// second spring begins earlier, by `shift`: the multiplier of an augmented Lagrangian [Powell 1969].
struct ContactSpring {
    /// Stiffness of the second spring over that of the first, and its ramp over the depth where it begins
    /// [-].
    static constexpr double kHardening = 8.0, kHardRamp = 0.2;

    double stiffness = 0.0; ///< [N/m] w
    double ramp = 0.0;      ///< [m] D; 0: linear
    double hard = 0.0;      ///< [m] at least D; 0: it does not harden
    double shift = 0.0;     ///< [m]

    /// @param depth  [m] negative without contact
    TOILE_HD double force(double depth) const // [N]
    {
        return (depth > 0.0 ? soft_force(depth) : 0.0) +
               (hardens_at(depth) ? second().soft_force(depth - begin()) : 0.0);
    }
    TOILE_HD double energy(double depth) const // [J]
    {
        return (depth > 0.0 ? soft_energy(depth) : 0.0) +
               (hardens_at(depth) ? second().soft_energy(depth - begin()) : 0.0);
    }
    TOILE_HD double stiffness_at(double depth) const // [N/m]
    {
        return (depth > 0.0 ? soft_stiffness(depth) : 0.0) +
               (hardens_at(depth) ? second().soft_stiffness(depth - begin()) : 0.0);
    }

    /// Depth at a given force [N], the inverse of force() [m]; not negative.
    TOILE_HD double depth_of(double force) const
    {
        if (force <= this->force(0.0))
            return 0.0;
        if (shift > 0.0)
            return descend(unshifted().depth_of(force), 0.0, 1.0, force);
        if (hard > 0.0 && force > soft_force(hard))
            return hard + beyond_hard(force - soft_force(hard), stiffness, 1.0);
        const double beyond = force / stiffness + 0.5 * ramp;
        return beyond >= ramp ? beyond : std::sqrt(2.0 * ramp * force / stiffness);
    }

    /// Equilibrium depth d [m] of a point that is `reach` [m] deep without the spring and moves out by
    /// `mobility` [m/N] times the force: d + mobility force(d) = reach.
    TOILE_HD double depth_at_rest(double reach, double mobility) const
    {
        if (reach <= 0.0)
            return 0.0;
        if (shift > 0.0)
            return descend(unshifted().depth_at_rest(reach, mobility), 1.0, mobility, reach);
        const double wm = stiffness * mobility;
        if (hard > 0.0 && reach > hard + mobility * soft_force(hard))
            return hard + beyond_hard(reach - hard - mobility * soft_force(hard), 1.0 + wm, mobility);
        const double beyond = (reach + 0.5 * wm * ramp) / (1.0 + wm);
        if (beyond >= ramp)
            return beyond;
        return 2.0 * reach / (1.0 + std::sqrt(1.0 + 2.0 * wm * reach / ramp));
    }

private:
    TOILE_HD double begin() const { return hard - shift; } ///< of the second spring
    TOILE_HD bool hardens_at(double depth) const { return hard > 0.0 && depth > begin(); }
    TOILE_HD ContactSpring unshifted() const { return {stiffness, ramp, hard}; }
    TOILE_HD ContactSpring second() const { return {kHardening * stiffness, kHardRamp * hard, 0.0}; }
    TOILE_HD double soft_force(double depth) const
    {
        return depth < ramp ? 0.5 * stiffness * depth * depth / ramp : stiffness * (depth - 0.5 * ramp);
    }
    TOILE_HD double soft_energy(double depth) const
    {
        return depth < ramp ? stiffness * depth * depth * depth / (6.0 * ramp)
                            : 0.5 * stiffness * (depth * (depth - ramp) + ramp * ramp / 3.0);
    }
    TOILE_HD double soft_stiffness(double depth) const
    {
        return depth < ramp ? stiffness * depth / ramp : stiffness;
    }

    /// Solves slope d + scale force(d) = rest for the depth d, not negative, by Newton's method from a larger
    /// one: the left side is convex.
    TOILE_HD double descend(double depth, double slope, double scale, double rest) const
    {
        for (int k = 0; k < kNewtonSteps && depth > 0.0; ++k)
            depth -= (slope * depth + scale * force(depth) - rest) / (slope + scale * stiffness_at(depth));
        return depth > 0.0 ? depth : 0.0;
    }
    static constexpr int kNewtonSteps = 8;

    /// Solves slope z + scale second().force(z) = rest for the depth z beyond `hard`.
    TOILE_HD double beyond_hard(double rest, double slope, double scale) const
    {
        const double w = scale * kHardening * stiffness, ramp2 = kHardRamp * hard;
        const double past = (rest + 0.5 * w * ramp2) / (slope + w);
        if (past >= ramp2)
            return past;
        return 2.0 * rest / (slope + std::sqrt(slope * slope + 2.0 * w * rest / ramp2));
    }
};

} // namespace toile::collision
