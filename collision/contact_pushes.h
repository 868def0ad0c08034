#pragma once

/// How contact alone moves cloth, pair by pair, where no minimisation does it: before a step's minimisation,
/// and of what that has left inside. A sweep is of the terms that push, or almost, when it begins, one after
/// the other in their TurnOrder. The same bodies on CPU and GPU.

#include <array>
#include <cmath>
#include <limits>

#include "collision/contact_rules.h"
#include "core/backend/turns.h"

namespace toile {

/// Sweeps over the pairs before a minimisation. With one the normal forces of the first minimisation are too
/// large where many pairs share vertices, and friction stops what should slide; with eight nothing changes
/// (docs/collision/contact.md).
inline constexpr int kGuessSweeps = 4;

/// Sweeps over the pairs at the end of a step: neighbouring planes push against each other.
inline constexpr int kClearSweeps = 5;

/// Farthest move of a vertex for a pair in a sweep of the end, of the shortest altitude around the pair [-]:
/// a millimetre across a sliver would be an explosion.
inline constexpr double kClearance = 0.5;

/// Clearance [m] below which velocities are left alone too: one vertex of a sliver stopped, the others not.
inline constexpr double kThinnest = 5e-5;

/// Least sum of squared weights of a pair's free vertices for which the pair is cleared by moving them [-].
/// Where fixed vertices carry nearly all of the pair, the free one would have to be thrown far; the energy
/// deals with it.
inline constexpr double kMinLeverage = 0.1;

/// Distance [m] from where it would push within which a term has its turn in a sweep too: others may push it
/// on to there. More than nothing, since sweeps leave many with nothing but rounding errors, which must not
/// decide.
inline constexpr double kAlmost = 2e-5;

/// What of a pair may be moved, and how far.
struct PushRules {
    View<const unsigned char> fixed; ///< [vertices]
    View<const int> rigid;           ///< [vertices] see rigid_bodies_of
    View<const double> masses;       ///< [vertices] [kg]
    View<const double> altitude;     ///< [vertices] the shortest of the triangles around, at the start [m]
    double dt = 0.0;                 ///< [s]
    double farthest_motion = 0.0;    ///< see ContactRules

    /// Vertices that no pair moves by itself.
    TOILE_HD bool is_held(int vertex) const
    {
        return fixed[vertex] != 0 || (!rigid.empty() && rigid[vertex] >= 0);
    }

    /// Sum of squared weights of the pair's free vertices [-]: how far its cloth point goes when each of them
    /// moves by its weight. 0 where fixed vertices carry nearly all of the pair.
    TOILE_HD double leverage_of(const ContactPair& pair) const
    {
        double squares = 0.0;
        for (int k = 0; k < pair.count(); ++k)
            if (!is_held(pair.vertex[k]))
                squares += pair.weight[k] * pair.weight[k];
        return squares < kMinLeverage ? 0.0 : squares;
    }

    /// How far a force on the pair's cloth point moves it in the step [m/N]: dt^2 sum_k b_k^2 / m_k over the
    /// free vertices. 0 where fixed ones carry nearly all of the pair.
    TOILE_HD double mobility_of(const ContactPair& pair) const
    {
        if (leverage_of(pair) == 0.0)
            return 0.0;
        double mobility = 0.0;
        for (int k = 0; k < pair.count(); ++k)
            if (const int v = pair.vertex[k]; !is_held(v))
                mobility += pair.weight[k] * pair.weight[k] / masses[v];
        return dt * dt * mobility;
    }

    /// Moves the pair's free vertices as a force [N] along its normal would in this step.
    TOILE_HD void accelerate(const ContactPair& pair, double force, View<Vec3> x) const
    {
        for (int k = 0; k < pair.count(); ++k)
            if (const int v = pair.vertex[k]; !is_held(v))
                x[v] += dt * dt * force * pair.weight[k] / masses[v] * pair.normal;
    }

    /// Adds to the field at the pair's free vertices so that its cloth point moves by `move`. False where
    /// fixed vertices carry nearly all of the pair.
    TOILE_HD bool push(const ContactPair& pair, const Vec3& move, View<Vec3> field) const
    {
        const double leverage = leverage_of(pair);
        if (leverage == 0.0)
            return false;
        for (int k = 0; k < pair.count(); ++k)
            if (!is_held(pair.vertex[k]))
                field[pair.vertex[k]] += pair.weight[k] / leverage * move;
        return true;
    }

    /// How far a pair may be pushed in a sweep without crushing a triangle [m].
    TOILE_HD double clearance_of(const ContactPair& pair) const
    {
        double shortest = std::numeric_limits<double>::max(), largest = 0.0;
        for (int k = 0; k < pair.count(); ++k) {
            shortest = std::fmin(shortest, altitude[pair.vertex[k]]);
            if (!is_held(pair.vertex[k]))
                largest = std::fmax(largest, pair.weight[k]);
        }
        return largest > 0.0 ? kClearance * shortest * leverage_of(pair) / largest : 0.0;
    }

    /// Velocity of the surface at the pair [m/s]; 0 where it jumped.
    TOILE_HD Vec3 surface_velocity(const ContactPair& pair) const
    {
        return pair.motion.norm() <= farthest_motion ? Vec3(pair.motion / dt) : Vec3(0.0, 0.0, 0.0);
    }
};

/// A sweep's push of term i where contact alone would take it, with masses and the compliance of its spring
/// [Macklin et al. 2016, eq. 18], and a force that never pulls. Momentum goes where contact sends it, and
/// pairs that press begin as deep as their force asks for: friction reads it from there.
struct PushToRest {
    PushRules rules;
    View<double> force; ///< [terms] so far [N]
    View<Vec3> x;       ///< [vertices] [m]

    TOILE_HD bool acts(int i, const ContactTerm& term) const
    {
        return term.gap(x) + term.give < kAlmost || force[i] != 0.0;
    }

    /// True where something moved.
    TOILE_HD bool operator()(int i, const ContactTerm& term) const
    {
        const double depth = -term.gap(x) - term.give;
        if (depth <= 0.0 && force[i] == 0.0)
            return false;
        const double mobility = rules.mobility_of(term.pair);
        const double reach = depth + mobility * force[i];
        const double change = term.spring.force(term.spring.depth_at_rest(reach, mobility)) - force[i];
        if (mobility == 0.0 || change == 0.0)
            return false;
        force[i] += change;
        rules.accelerate(term.pair, change, x);
        return true;
    }
};

/// A sweep's push of a term out of what it is in.
struct PushOut {
    PushRules rules;
    double most;  ///< depth that is left to a pair which rests there [m]
    View<Vec3> x; ///< [vertices] [m]

    TOILE_HD bool acts(int, const ContactTerm& term) const { return depth_of(term) > -kAlmost; }

    TOILE_HD bool operator()(int, const ContactTerm& term) const
    {
        const double depth = depth_of(term);
        return depth > 0.0 &&
               rules.push(term.pair, std::fmin(depth, rules.clearance_of(term.pair)) * term.pair.normal, x);
    }

private:
    TOILE_HD double depth_of(const ContactTerm& term) const
    {
        return -term.gap(x) - term.give - std::fmin(most, term.rest_depth());
    }
};

/// Cloth inside moves at least as fast out of a surface as that does.
struct StopAtSurface {
    PushRules rules;
    View<const Vec3> x; ///< [vertices] [m]
    View<Vec3> v;       ///< [vertices] [m/s]

    TOILE_HD bool acts(int, const ContactTerm& term) const
    {
        return term.gap(x) < 0.0 && rules.clearance_of(term.pair) >= kThinnest;
    }

    TOILE_HD bool operator()(int, const ContactTerm& term) const
    {
        const ContactPair& pair = term.pair;
        const double approach = pair.normal.dot(rules.surface_velocity(pair) - pair.cloth_point(v));
        return approach > 0.0 && rules.push(pair, approach * pair.normal, v);
    }
};

/// Takes back what slips, as far as friction holds it, and pushes out at once: pairs that share a vertex
/// share its depth. Velocities obey the same law by themselves: a method of many substeps ends faster than it
/// has moved. Coulomb's law with the distance pushed out for the normal impulse [Macklin et al. 2014, eq.
/// 24].
struct Rub {
    PushRules rules;
    View<Vec3> x, v; ///< [vertices] [m], [m/s]

    TOILE_HD bool acts(int, const ContactTerm& term) const { return term.gap(x) < kAlmost; }

    TOILE_HD bool operator()(int, const ContactTerm& term) const
    {
        const double depth = -term.gap(x);
        if (depth <= 0.0)
            return false;
        const ContactPair& pair = term.pair;
        const double clearance = rules.clearance_of(pair);
        rules.push(pair, at_most(-term.slip(x), term.friction * depth), x);
        const double out = std::fmin(std::fmax(depth - term.give, 0.0), clearance);
        const bool moved = rules.push(pair, out * pair.normal, x);

        const Vec3 lag = rules.surface_velocity(pair) - pair.cloth_point(v);
        const double approach = pair.normal.dot(lag);
        if (approach > 0.0 && clearance >= kThinnest)
            rules.push(
                pair,
                approach * pair.normal + at_most(lag - approach * pair.normal, term.friction * approach), v);
        return moved;
    }

private:
    TOILE_HD static Vec3 at_most(const Vec3& move, double limit)
    {
        const double length = move.norm();
        return length > limit ? Vec3(limit / length * move) : move;
    }
};

/// Flags the place of term i where it pushes; for i in [0, place_count()), as places beyond the terms are
/// empty.
template <typename Push>
struct FlagActing {
    Push push;
    View<const ContactTerm> terms;
    TurnOrder order;
    View<unsigned char> flags; ///< [places] out

    TOILE_HD void operator()(int i) const
    {
        flags[order.place_of(i)] = i < order.count && push.acts(i, terms[i]) ? 1 : 0;
    }
};

/// A push of a listed term.
template <typename Push>
struct PushInTurn {
    Push push;
    View<const ContactTerm> terms;
    View<int> moved; ///< [1] becomes 1 where something moves

    TOILE_HD ContactTerm early(int i) const { return terms[i]; }
    TOILE_HD std::array<int, 4> shared(const ContactTerm& term) const { return term.pair.vertex; }
    TOILE_HD void operator()(int i, const ContactTerm& term) const
    {
        if (push(i, term))
            moved[0] = 1;
    }
};

} // namespace toile
