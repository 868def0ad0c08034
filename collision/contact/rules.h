#pragma once

/// Rules that turn pairs into terms of the contact energy, and queries of terms during a step. The same
/// bodies on CPU and GPU.

#include "collision/contact/cloth_contact_kernels.h"
#include "collision/contact/term.h"

namespace toile::collision {

/// Cosine of the angle between the normals of two planes [-] from which on they squeeze the cloth between
/// them: 90 degrees. Cloth slides out of wider wedges.
inline constexpr double kOpposing = 0.0;

/// Distance beyond the gap to keep, relative to it [-], up to which cloth counts as supported by a collider.
inline constexpr double kSupportDistance = 0.25;

/// Gap of a term, relative to the gap to keep [-], up to which it counts as pressing in
/// ContactQuery::has_slid.
inline constexpr double kPressing = 0.5;

/// Gap that a guard keeps, relative to that of the cloth [-].
inline constexpr double kGuardGap = 0.25;

/// Depths over which a term's spring reaches its full stiffness, and from which on it hardens, relative to
/// the gap to keep [-].
inline constexpr double kRampPerGap = 0.6, kHardPerGap = 0.7;

/// Gap below which a pair that may not cross gets a larger force, relative to the gap to keep [-].
inline constexpr double kMinGap = 0.2;

/// Shortfall that is left [-]: of pairs that may not cross relative to their minimum gap, of vertices on
/// shapes relative to the gap to keep.
inline constexpr double kShort = 0.4, kSunk = 0.08;

/// Half of the clearance between two planes of a vertex [m], negative if body parts overlap.
/// @param x  [vertices] positions at which the planes were found [m]
TOILE_HD inline double half_clearance(const ContactPair& a, const ContactPair& b, View<const Vec3> x)
{
    return 0.5 * (a.gap(x) + b.gap(x));
}

TOILE_HD inline bool are_opposing(const ContactPair& a, const ContactPair& b)
{
    return a.normal.dot(b.normal) <= kOpposing;
}

/// Part of a term's slip that is stored for friction.
enum class RememberedSlip {
    kSoFar,   ///< the slip at x
    kByStart, ///< the slip at t0: for pairs found again within the step, which also begin at t0
    kNothing
};

/// Rules and tables that turn the pairs of a step into terms.
struct ContactRules {
    View<const int> cloth_of;             ///< [vertices]
    View<const double> gap;               ///< [cloths] see ContactCloth [m]
    View<const double> vertex_gap;        ///< [vertices] [m]; empty where all have that of their cloth
    View<const double> collider_friction; ///< [cloths x colliders] [-]
    View<const double> cloth_friction;    ///< [cloths x cloths] [-]
    PairThickness thickness;              ///< empty without contact of cloth with cloth
    View<const Vec3> x;                   ///< [vertices] at t0 [m]
    View<const double> diagonal;          ///< [vertices] see StepStart [N/m]
    View<const unsigned char> fixed;      ///< [vertices]
    double stiffness = 0.0;               ///< see Contact::Settings [-]
    double max_recovery = 0.0;            ///< [m] per step, of cloth that is moved out
    double max_motion = 0.0;              ///< [m] per step, of a surface that advects cloth

    /// Gap that the pair should keep [m].
    TOILE_HD double gap_of(const ContactPair& pair) const
    {
        if (!pair.is_between_cloths())
            return (pair.is_guard() ? kGuardGap : 1.0) * collider_gap_of(pair);
        return thickness.of(pair.vertex, pair.kind == ContactKind::kClothEdgeEdge);
    }

    /// Gap between the point of the cloth and the collider [m].
    TOILE_HD double collider_gap_of(const ContactPair& pair) const
    {
        if (vertex_gap.empty())
            return gap[cloth_of[pair.vertex[0]]];
        double at_point = 0.0;
        for (int k = 0; k < pair.count(); ++k)
            at_point += pair.weight[k] * vertex_gap[pair.vertex[k]];
        return at_point;
    }

    /// Coulomb coefficient [-].
    TOILE_HD double friction_of(const ContactPair& pair) const
    {
        const int cloth = cloth_of[pair.vertex[0]], cloths = gap.size();
        return pair.is_between_cloths()
                   ? cloth_friction[cloth * cloths + cloth_of[pair.vertex[3]]]
                   : collider_friction[cloth * (collider_friction.size() / cloths) + pair.collider];
    }

    /// Stiffness of the pair, its share of that of the cloth at its vertices [N/m]; between cloths, of that
    /// of the softer side.
    TOILE_HD double stiffness_of(const ContactPair& pair) const
    {
        double ahead = 0.0, behind = 0.0;
        for (int k = 0; k < pair.count(); ++k) {
            const double contribution = pair.weight[k] * diagonal[pair.vertex[k]];
            (contribution > 0.0 ? ahead : behind) += std::abs(contribution);
        }
        return stiffness * pair.share * (pair.is_between_cloths() && behind < ahead ? behind : ahead);
    }

    /// True if the surface has moved rather than jumped.
    TOILE_HD bool is_advected(const Vec3& motion) const { return motion.norm() <= max_motion; }

    /// Cloth point of the pair at t0, advected with the collider unless that jumped [m].
    TOILE_HD Vec3 at_start(const ContactPair& pair) const
    {
        const Vec3 start = pair.cloth_point(x);
        return is_advected(pair.motion) ? Vec3(start + pair.motion) : start;
    }

    /// True if none of the pair's vertices can move.
    TOILE_HD bool is_fixed(const ContactPair& pair) const
    {
        bool is_fixed = true;
        for (int k = 0; k < pair.count(); ++k)
            is_fixed = is_fixed && fixed[pair.vertex[k]] != 0;
        return is_fixed;
    }

    /// @param now  [vertices] [m]
    TOILE_HD Vec3 slip_of(const ContactTerm& term, RememberedSlip slip, View<const Vec3> now) const
    {
        if (slip == RememberedSlip::kNothing || term.normal_force == 0.0 || term.friction == 0.0)
            return Vec3(0.0, 0.0, 0.0);
        return slip == RememberedSlip::kSoFar ? term.slip(now) : Vec3(at_start(term.pair) - term.anchor);
    }

    /// Term of a pair, before a warm start.
    /// @param clearance  half the clearance between this plane and an opposing one [m]
    TOILE_HD ContactTerm term_of(const ContactPair& pair, double clearance, const PinchedTerm& pinched) const
    {
        ContactTerm term;
        term.pair = pair;
        term.friction = pinched.friction * friction_of(pair);

        // Cloth that starts inside leaves at the recovery speed, not at once. Between two parts it moves to
        // the middle, where neither can push it through the other, and each grips it with the force at one
        // gap's depth.
        const double keep = gap_of(pair);
        term.spring = {stiffness_of(pair), kRampPerGap * keep, kHardPerGap * keep};
        // Cloth never starts across cloth, whatever a plane says that was found since.
        const Vec3 start = at_start(pair);
        double gap_at_start = pair.normal.dot(start - pair.point);
        if (pair.is_between_cloths())
            gap_at_start = std::max(0.0, gap_at_start);
        const double recovered = gap_at_start + pinched.recovery * max_recovery;
        term.offset = recovered < keep ? recovered : keep;
        if (pair.kind >= ContactKind::kGuard)
            term.min_gap = std::max(0.0, std::min(kMinGap * keep, term.offset));
        else if (pair.kind == ContactKind::kVertexShape && clearance >= 0.0)
            term.min_gap = std::min(kMinGap * keep, gap_at_start < 0.0 ? gap_at_start : term.offset);
        if (clearance < 0.0 && clearance + keep < term.offset) {
            term.offset = clearance + keep;
            term.give = keep;
        }
        term.anchor = start;
        return term;
    }
};

/// Sums over terms: friction limits [N], their changes, and the numbers of those that lack some of their
/// minimum gap: pairs that may not cross, and vertices on a shape.
struct TermSums {
    double total = 0.0, change = 0.0;
    int short_count = 0, sunk_count = 0;
    TOILE_HD TermSums& operator+=(const TermSums& other)
    {
        total += other.total;
        change += other.change;
        short_count += other.short_count;
        sunk_count += other.sunk_count;
        return *this;
    }
};

/// Updates how hard a term presses at x, and what it lacks. Returns the friction limit by that, for the sum
/// over terms.
struct UpdateForce {
    View<ContactTerm> terms;
    View<const Vec3> x; ///< [vertices] [m]
    TOILE_HD TermSums operator()(int i) const
    {
        ContactTerm& term = terms[i];
        term.pressing = term.pressing_force(x);
        TermSums sums{term.friction * term.pressing,
                      term.friction * std::abs(term.pressing - term.normal_force)};
        if (!term.has_min_gap())
            return sums;
        const double shortfall = term.min_gap - term.pair.gap(x);
        term.multiplier.shortfall = shortfall;
        if (term.pair.kind >= ContactKind::kGuard)
            sums.short_count = shortfall > kShort * term.min_gap ? 1 : 0;
        else
            sums.sunk_count = kHardPerGap * shortfall > kSunk * term.spring.hard ? 1 : 0;
        return sums;
    }
};

/// Bounds friction by the updated force from now on.
struct AdoptForce {
    View<ContactTerm> terms;
    TOILE_HD void operator()(int i) const { terms[i].normal_force = terms[i].pressing; }
};

/// Updates the multiplier of a term.
struct UpdateMultiplier {
    View<ContactTerm> terms;
    bool is_near; ///< see ContactMultiplier
    TOILE_HD void operator()(int i) const { terms[i].update_multiplier(is_near); }
};

/// Queries of terms at x during a step.
struct ContactQuery {
    View<const ContactTerm> terms;
    View<const Vec3> x; ///< [vertices] [m]

    TOILE_HD bool is_supported(int i, const ContactRules& rules) const
    {
        const ContactPair& pair = terms[i].pair;
        return !pair.is_between_cloths() && terms[i].gap(x) <= kSupportDistance * rules.gap_of(pair);
    }

    /// True for a pressing pair with a collider if one of its vertices is farther than `trust` [m] from where
    /// the pair was found.
    /// @param found_at  [vertices] [m]
    TOILE_HD bool has_slid(int i, const ContactRules& rules, View<const Vec3> found_at, double trust) const
    {
        const ContactPair& pair = terms[i].pair;
        if (pair.kind >= ContactKind::kGuard || terms[i].gap(x) > kPressing * rules.gap_of(pair))
            return false;
        bool has_slid = false;
        for (int k = 0; k < pair.count(); ++k)
            has_slid = has_slid || (x[pair.vertex[k]] - found_at[pair.vertex[k]]).norm() > trust;
        return has_slid;
    }

    /// Depth at which a step would leave the term [m]; negative if it is clear.
    TOILE_HD double depth(int i) const { return -terms[i].gap(x) - terms[i].give; }
};

} // namespace toile::collision
