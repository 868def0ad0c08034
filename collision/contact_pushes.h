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

/// Distance [m] from pushing within which a term has its turn in a sweep in any case: rounding may leave what
/// was pushed out on either side.
inline constexpr double kSurelyOut = 1e-9;

/// A term that does not push has its turn in a sweep too where it is no farther from pushing than so many
/// times the depth of one that does and shares a vertex with it [-], and no farther than this [m]: the sweep
/// may push it on to there. What is pushed from farther comes in the next (docs/collision/contact.md#turns).
inline constexpr double kCarry = 3.0, kFarthestCarried = 5e-4;

/// Of a move or force by vertex of a pair; 0 where unused or held.
using PairShares = std::array<double, 4>;

/// Adds its share of a move to each vertex of a pair. False where none has one.
TOILE_HD inline bool push(const ContactPair& pair, const PairShares& shares, const Vec3& move,
                          View<Vec3> field)
{
    bool moved = false;
    for (int k = 0; k < 4; ++k) {
        if (shares[k] == 0.0)
            continue;
        field[pair.vertex[k]] += shares[k] * move;
        moved = true;
    }
    return moved;
}

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

    /// What a force of 1 N along the pair's normal moves its vertices by in this step, dt^2 b_k / m_k [m/N];
    /// 0 of held ones, and of all where fixed vertices carry nearly all of the pair.
    TOILE_HD PairShares shares_of_force(const ContactPair& pair) const
    {
        PairShares shares{};
        if (leverage_of(pair) == 0.0)
            return shares;
        for (int k = 0; k < pair.count(); ++k)
            if (const int v = pair.vertex[k]; !is_held(v))
                shares[k] = dt * dt * pair.weight[k] / masses[v];
        return shares;
    }

    /// What moves the pair's cloth point by 1, by the same amount for equal weights [-]; likewise.
    TOILE_HD PairShares shares_of_move(const ContactPair& pair) const
    {
        PairShares shares{};
        const double leverage = leverage_of(pair);
        for (int k = 0; k < pair.count(); ++k)
            if (leverage != 0.0 && !is_held(pair.vertex[k]))
                shares[k] = pair.weight[k] / leverage;
        return shares;
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

/// What pushes know of a term before its turn.
struct TermInTurn {
    ContactTerm term;
    PairShares shares{};
    double clearance = 0.0;               ///< see PushRules::clearance_of [m]
    Vec3 surface_velocity = Vec3::Zero(); ///< [m/s]
    double left = 0.0;                    ///< depth that it is left, see PushOut [m]
};

// A push changes fields(), and over(other fields) is the same push of vertices that are there. Its depth()
// tells how far a term is in what the push takes it out of [m]: positive where it pushes, and where not, as
// far as it is from there. It pushes on others, or not (kCarries).

/// A sweep's push of term i where contact alone would take it, with masses and the compliance of its spring
/// [Macklin et al. 2016, eq. 18], and a force that never pulls. Momentum goes where contact sends it, and
/// pairs that press begin as deep as their force asks for: friction reads it from there.
struct PushToRest {
    PushRules rules;
    View<double> force; ///< [terms] so far [N]
    View<Vec3> x;       ///< [vertices] [m]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {x}; }
    TOILE_HD PushToRest over(const SharedFields<1>& there) const { return {rules, force, there[0]}; }

    static constexpr bool kCarries = true;
    TOILE_HD double depth(int i, const ContactTerm& term) const
    {
        const double depth = depth_of(term);
        return force[i] != 0.0 ? std::fabs(depth) : depth; // it lets go, too
    }

    TOILE_HD TermInTurn prepare(const ContactTerm& term) const
    {
        return {term, rules.shares_of_force(term.pair)};
    }

    /// True where something moved.
    TOILE_HD bool operator()(int i, const TermInTurn& own) const
    {
        const ContactTerm& term = own.term;
        const double depth = depth_of(term);
        if (depth <= 0.0 && force[i] == 0.0)
            return false;
        double mobility = 0.0; // how far a force on the pair's cloth point moves it [m/N]
        for (int k = 0; k < 4; ++k)
            mobility += term.pair.weight[k] * own.shares[k];
        const double reach = depth + mobility * force[i];
        const double change = term.spring.force(term.spring.depth_at_rest(reach, mobility)) - force[i];
        if (mobility == 0.0 || change == 0.0)
            return false;
        force[i] += change;
        return push(term.pair, own.shares, change * term.pair.normal, x);
    }

private:
    TOILE_HD double depth_of(const ContactTerm& term) const { return -term.gap(x) - term.give; }
};

/// A sweep's push of a term out of what it is in.
struct PushOut {
    PushRules rules;
    double most;  ///< depth that is left to a pair which rests there [m]
    View<Vec3> x; ///< [vertices] [m]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {x}; }
    TOILE_HD PushOut over(const SharedFields<1>& there) const { return {rules, most, there[0]}; }

    static constexpr bool kCarries = true;
    TOILE_HD double depth(int, const ContactTerm& term) const { return depth_of(term, left_to(term)); }

    TOILE_HD TermInTurn prepare(const ContactTerm& term) const
    {
        TermInTurn own{term, rules.shares_of_move(term.pair), rules.clearance_of(term.pair)};
        own.left = left_to(term);
        return own;
    }

    TOILE_HD bool operator()(int, const TermInTurn& own) const
    {
        const double depth = depth_of(own.term, own.left);
        const ContactPair& pair = own.term.pair;
        return depth > 0.0 && push(pair, own.shares, std::fmin(depth, own.clearance) * pair.normal, x);
    }

private:
    TOILE_HD double left_to(const ContactTerm& term) const { return std::fmin(most, term.rest_depth()); }
    TOILE_HD double depth_of(const ContactTerm& term, double left) const
    {
        return -term.gap(x) - term.give - left;
    }
};

/// Cloth inside moves at least as fast out of a surface as that does.
struct StopAtSurface {
    PushRules rules;
    View<const Vec3> x; ///< [vertices] [m]
    View<Vec3> v;       ///< [vertices] [m/s]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {v}; }
    TOILE_HD StopAtSurface over(const SharedFields<1>& there) const { return {rules, x, there[0]}; }

    static constexpr bool kCarries = false; // it changes no depth
    TOILE_HD double depth(int, const ContactTerm& term) const
    {
        const double depth = -term.gap(x);
        return depth > 0.0 && rules.clearance_of(term.pair) < kThinnest ? 0.0 : depth;
    }

    TOILE_HD TermInTurn prepare(const ContactTerm& term) const
    {
        return {term, rules.shares_of_move(term.pair), 0.0, rules.surface_velocity(term.pair)};
    }

    TOILE_HD bool operator()(int, const TermInTurn& own) const
    {
        const ContactPair& pair = own.term.pair;
        const double approach = pair.normal.dot(own.surface_velocity - pair.cloth_point(v));
        return approach > 0.0 && push(pair, own.shares, approach * pair.normal, v);
    }
};

/// Takes back what slips, as far as friction holds it, and pushes out at once: pairs that share a vertex
/// share its depth. Velocities obey the same law by themselves: a method of many substeps ends faster than it
/// has moved. Coulomb's law with the distance pushed out for the normal impulse [Macklin et al. 2014, eq.
/// 24].
struct Rub {
    PushRules rules;
    View<Vec3> x, v; ///< [vertices] [m], [m/s]

    static constexpr int kFields = 2;
    TOILE_HD SharedFields<2> fields() const { return {x, v}; }
    TOILE_HD Rub over(const SharedFields<2>& there) const { return {rules, there[0], there[1]}; }

    static constexpr bool kCarries = true;
    TOILE_HD double depth(int, const ContactTerm& term) const { return -term.gap(x); }

    TOILE_HD TermInTurn prepare(const ContactTerm& term) const
    {
        const ContactPair& pair = term.pair;
        return {term, rules.shares_of_move(pair), rules.clearance_of(pair), rules.surface_velocity(pair)};
    }

    TOILE_HD bool operator()(int, const TermInTurn& own) const
    {
        const ContactTerm& term = own.term;
        const double depth = -term.gap(x);
        if (depth <= 0.0)
            return false;
        const ContactPair& pair = term.pair;
        push(pair, own.shares, at_most(-term.slip(x), term.friction * depth), x);
        const double out = std::fmin(std::fmax(depth - term.give, 0.0), own.clearance);
        const bool moved = push(pair, own.shares, out * pair.normal, x);

        const Vec3 lag = own.surface_velocity - pair.cloth_point(v);
        const double approach = pair.normal.dot(lag);
        if (approach > 0.0 && own.clearance >= kThinnest)
            push(pair, own.shares,
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

} // namespace toile
