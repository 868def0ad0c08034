#pragma once

/// Projections: moves of cloth by contact alone, pair by pair. They run before a step's minimisation, and
/// after it for cloth left inside. A sweep projects the terms that are active or nearly active at its start,
/// one after the other in their GaussSeidelSchedule. The same bodies on CPU and GPU.

#include <array>
#include <cmath>
#include <limits>

#include "collision/contact/rules.h"
#include "core/compute/gauss_seidel.h"

namespace toile::collision {

/// Sweeps over the pairs before a minimisation. With one sweep, the normal forces of the first minimisation
/// are too large where many pairs share vertices, and friction stops cloth that should slide. Eight sweeps
/// change nothing (docs/theory/contact_projection.md).
inline constexpr int kGuessSweeps = 4;

/// Sweeps over the pairs at the end of a step: neighbouring planes act against each other.
inline constexpr int kClearSweeps = 5;

/// Maximum move of a vertex by a pair in a sweep at the end of a step, relative to the shortest altitude
/// around the pair [-]: a millimetre across a sliver would be an explosion.
inline constexpr double kClearance = 0.5;

/// Clearance [m] below which velocities are not changed either: that would stop one vertex of a sliver and
/// not the others.
inline constexpr double kThinnest = 5e-5;

/// Minimum sum of squared weights of a pair's free vertices for which a projection moves them [-]. If fixed
/// vertices have nearly all of the weight, the free one would have to move far; the energy handles such
/// pairs.
inline constexpr double kMinLeverage = 0.1;

/// Distance [m] from contact within which a term is always scheduled in a sweep: rounding may leave a
/// projected term on either side.
inline constexpr double kSurelyOut = 1e-9;

/// Bounds on the distance from contact within which an inactive term is scheduled too, because the sweep may
/// move it there: relative to the depth of an active term with a common vertex [-], and absolute [m]. A term
/// that is moved from farther away joins the next sweep
/// (docs/theory/contact_projection.md#which-terms-take-part).
inline constexpr double kPropagationFactor = 3.0, kMaxPropagation = 5e-4;

/// Weights of a move or force by vertex of a pair; 0 if unused or immovable.
using PairWeights = std::array<double, 4>;

/// Adds a weighted move to each vertex of a pair. False if all weights are 0.
TOILE_HD inline bool add_move(const ContactPair& pair, const PairWeights& weights, const Vec3& move,
                              View<Vec3> field)
{
    bool moved = false;
    for (int k = 0; k < 4; ++k) {
        if (weights[k] == 0.0)
            continue;
        field[pair.vertex[k]] += weights[k] * move;
        moved = true;
    }
    return moved;
}

/// Bounds and weights of the moves of a pair.
struct ProjectionRules {
    View<const unsigned char> fixed; ///< [vertices]
    View<const int> rigid;           ///< [vertices] see rigid_bodies_of
    View<const double> masses;       ///< [vertices] [kg]
    View<const double> altitude;     ///< [vertices] shortest of the adjacent triangles, at the start [m]
    double dt = 0.0;                 ///< [s]
    double max_motion = 0.0;         ///< see ContactRules

    /// True for a vertex that no projection moves: fixed or of a rigid body.
    TOILE_HD bool is_immovable(int vertex) const
    {
        return fixed[vertex] != 0 || (!rigid.empty() && rigid[vertex] >= 0);
    }

    /// Sum of squared weights of the pair's free vertices [-]: the displacement of its cloth point when each
    /// of them moves by its weight. 0 if it is below kMinLeverage.
    TOILE_HD double leverage_of(const ContactPair& pair) const
    {
        double squares = 0.0;
        for (int k = 0; k < pair.count(); ++k)
            if (!is_immovable(pair.vertex[k]))
                squares += pair.weight[k] * pair.weight[k];
        return squares < kMinLeverage ? 0.0 : squares;
    }

    /// Displacements of the pair's vertices by a force of 1 N along its normal in this step, dt^2 b_k / m_k
    /// [m/N]. 0 for immovable vertices, and for all if leverage_of() is 0.
    TOILE_HD PairWeights mobilities_of(const ContactPair& pair) const
    {
        PairWeights weights{};
        if (leverage_of(pair) == 0.0)
            return weights;
        for (int k = 0; k < pair.count(); ++k)
            if (const int v = pair.vertex[k]; !is_immovable(v))
                weights[k] = dt * dt * pair.weight[k] / masses[v];
        return weights;
    }

    /// Displacements of the vertices that move the pair's cloth point by 1, equal for equal weights [-]. 0 as
    /// in mobilities_of().
    TOILE_HD PairWeights displacement_weights_of(const ContactPair& pair) const
    {
        PairWeights weights{};
        const double leverage = leverage_of(pair);
        for (int k = 0; k < pair.count(); ++k)
            if (leverage != 0.0 && !is_immovable(pair.vertex[k]))
                weights[k] = pair.weight[k] / leverage;
        return weights;
    }

    /// Maximum move of a pair in a sweep that crushes no triangle [m].
    TOILE_HD double clearance_of(const ContactPair& pair) const
    {
        double shortest = std::numeric_limits<double>::max(), largest = 0.0;
        for (int k = 0; k < pair.count(); ++k) {
            shortest = std::fmin(shortest, altitude[pair.vertex[k]]);
            if (!is_immovable(pair.vertex[k]))
                largest = std::fmax(largest, pair.weight[k]);
        }
        return largest > 0.0 ? kClearance * shortest * leverage_of(pair) / largest : 0.0;
    }

    /// Velocity of the surface at the pair [m/s]; 0 if it jumped.
    TOILE_HD Vec3 surface_velocity(const ContactPair& pair) const
    {
        return pair.motion.norm() <= max_motion ? Vec3(pair.motion / dt) : Vec3(0.0, 0.0, 0.0);
    }
};

/// Data of a term prepared before it is projected.
struct PreparedTerm {
    ContactTerm term;
    PairWeights weights{};
    double clearance = 0.0;               ///< see ProjectionRules::clearance_of [m]
    Vec3 surface_velocity = Vec3::Zero(); ///< [m/s]
    double left = 0.0;                    ///< remaining depth, see ProjectNormal [m]
};

// Interface of a projection. It changes fields(); over(others) is the same projection on other fields.
// depth() is the constraint violation of a term [m]: positive if the projection is active, else minus the
// distance from activity. kPropagates: it may move other terms deeper.

/// Compliant projection of term i, with masses and the compliance of its spring [Macklin et al. 2016, eq.
/// 18], and a force that never pulls. The minimisation thus starts with the momentum that contact transfers.
/// Pressing pairs start at the depth of their force, from which friction reads it.
struct ProjectCompliant {
    ProjectionRules rules;
    View<double> force; ///< [terms] accumulated [N]
    View<Vec3> x;       ///< [vertices] [m]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {x}; }
    TOILE_HD ProjectCompliant over(const SharedFields<1>& local) const { return {rules, force, local[0]}; }

    static constexpr bool kPropagates = true;
    TOILE_HD double depth(int i, const ContactTerm& term) const
    {
        const double depth = depth_of(term);
        return force[i] != 0.0 ? std::fabs(depth) : depth; // it may also reduce its force
    }

    TOILE_HD PreparedTerm prepare(const ContactTerm& term) const
    {
        return {term, rules.mobilities_of(term.pair)};
    }

    /// True if a vertex has moved.
    TOILE_HD bool operator()(int i, const PreparedTerm& prepared) const
    {
        const ContactTerm& term = prepared.term;
        const double depth = depth_of(term);
        if (depth <= 0.0 && force[i] == 0.0)
            return false;
        double mobility = 0.0; // displacement of the pair's cloth point per force on it [m/N]
        for (int k = 0; k < 4; ++k)
            mobility += term.pair.weight[k] * prepared.weights[k];
        const double reach = depth + mobility * force[i];
        if (mobility == 0.0)
            return false;
        const double change = force_at_rest(term.spring, reach, mobility) - force[i];
        if (change == 0.0)
            return false;
        force[i] += change;
        return add_move(term.pair, prepared.weights, change * term.pair.normal, x);
    }

private:
    /// Force of the spring at ContactSpring::depth_at_rest(); a shifted one, which presses before contact,
    /// brings the point to the surface at most.
    TOILE_HD static double force_at_rest(const ContactSpring& spring, double reach, double mobility)
    {
        const double depth = spring.depth_at_rest(reach, mobility);
        const double force = spring.force(depth), most = (reach - depth) / mobility;
        return spring.shift == 0.0 || force < most ? force : most > 0.0 ? most : 0.0;
    }
    TOILE_HD double depth_of(const ContactTerm& term) const { return -term.gap(x) - term.give; }
};

/// Projection of a term along its normal, out of the surface.
struct ProjectNormal {
    ProjectionRules rules;
    double max_depth; ///< maximum depth that is left to a resting pair [m]
    View<Vec3> x;     ///< [vertices] [m]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {x}; }
    TOILE_HD ProjectNormal over(const SharedFields<1>& local) const { return {rules, max_depth, local[0]}; }

    static constexpr bool kPropagates = true;
    TOILE_HD double depth(int, const ContactTerm& term) const { return depth_of(term, left_to(term)); }

    TOILE_HD PreparedTerm prepare(const ContactTerm& term) const
    {
        PreparedTerm prepared{term, rules.displacement_weights_of(term.pair), rules.clearance_of(term.pair)};
        prepared.left = left_to(term);
        return prepared;
    }

    TOILE_HD bool operator()(int, const PreparedTerm& prepared) const
    {
        const double depth = depth_of(prepared.term, prepared.left);
        const ContactPair& pair = prepared.term.pair;
        return depth > 0.0 &&
               add_move(pair, prepared.weights, std::fmin(depth, prepared.clearance) * pair.normal, x);
    }

private:
    TOILE_HD double left_to(const ContactTerm& term) const { return std::fmin(max_depth, term.rest_depth()); }
    TOILE_HD double depth_of(const ContactTerm& term, double left) const
    {
        return -term.gap(x) - term.give - left;
    }
};

/// Raises the normal velocity of cloth inside a surface to that of the surface.
struct StopAtSurface {
    ProjectionRules rules;
    View<const Vec3> x; ///< [vertices] [m]
    View<Vec3> v;       ///< [vertices] [m/s]

    static constexpr int kFields = 1;
    TOILE_HD SharedFields<1> fields() const { return {v}; }
    TOILE_HD StopAtSurface over(const SharedFields<1>& local) const { return {rules, x, local[0]}; }

    static constexpr bool kPropagates = false; // it changes no depth
    TOILE_HD double depth(int, const ContactTerm& term) const
    {
        const double depth = -term.gap(x);
        return depth > 0.0 && rules.clearance_of(term.pair) < kThinnest ? 0.0 : depth;
    }

    TOILE_HD PreparedTerm prepare(const ContactTerm& term) const
    {
        return {term, rules.displacement_weights_of(term.pair), 0.0, rules.surface_velocity(term.pair)};
    }

    TOILE_HD bool operator()(int, const PreparedTerm& prepared) const
    {
        const ContactPair& pair = prepared.term.pair;
        const double approach = pair.normal.dot(prepared.surface_velocity - pair.cloth_point(v));
        return approach > 0.0 && add_move(pair, prepared.weights, approach * pair.normal, v);
    }
};

/// Undoes slip up to the friction limit and projects out of the surface at once: pairs that share a vertex
/// share its depth. Coulomb's law, with the depth in place of the normal impulse [Macklin et al. 2014, eq.
/// 24]. Velocities obey the same law separately: a method of many substeps ends faster than it has moved.
struct ProjectFriction {
    ProjectionRules rules;
    View<Vec3> x, v; ///< [vertices] [m], [m/s]

    static constexpr int kFields = 2;
    TOILE_HD SharedFields<2> fields() const { return {x, v}; }
    TOILE_HD ProjectFriction over(const SharedFields<2>& local) const { return {rules, local[0], local[1]}; }

    static constexpr bool kPropagates = true;
    TOILE_HD double depth(int, const ContactTerm& term) const { return -term.gap(x); }

    TOILE_HD PreparedTerm prepare(const ContactTerm& term) const
    {
        const ContactPair& pair = term.pair;
        return {term, rules.displacement_weights_of(pair), rules.clearance_of(pair),
                rules.surface_velocity(pair)};
    }

    TOILE_HD bool operator()(int, const PreparedTerm& prepared) const
    {
        const ContactTerm& term = prepared.term;
        const double depth = -term.gap(x);
        if (depth <= 0.0)
            return false;
        const ContactPair& pair = term.pair;
        add_move(pair, prepared.weights, at_most(-term.slip(x), term.friction * depth), x);
        const double out = std::fmin(std::fmax(depth - term.give, 0.0), prepared.clearance);
        const bool moved = add_move(pair, prepared.weights, out * pair.normal, x);

        const Vec3 lag = prepared.surface_velocity - pair.cloth_point(v);
        const double approach = pair.normal.dot(lag);
        if (approach > 0.0 && prepared.clearance >= kThinnest)
            add_move(pair, prepared.weights,
                     approach * pair.normal + at_most(lag - approach * pair.normal, term.friction * approach),
                     v);
        return moved;
    }

private:
    TOILE_HD static Vec3 at_most(const Vec3& move, double limit)
    {
        const double length = move.norm();
        return length > limit ? Vec3(limit / length * move) : move;
    }
};

} // namespace toile::collision
