#pragma once

/// How a pair becomes a term of the contact energy, and what terms are asked during a step. The same bodies
/// on CPU and GPU.

#include "collision/cloth/cloth_contact_kernels.h"
#include "collision/contact_term.h"

namespace toile {

/// cos of the angle between the normals of two planes [-] beyond which they squeeze what is between them: 90
/// degrees. More open wedges let cloth slide out.
inline constexpr double kOpposing = 0.0;

/// Distance on top of the gap, of the gap [-], up to which cloth counts as lying on a collider.
inline constexpr double kLeaning = 0.25;

/// Of the gap [-]: a term nearer than this counts as pressing where it is asked whether its cloth has slid
/// away.
inline constexpr double kPressing = 0.5;

/// Depth over which a term's spring becomes as stiff as it gets, of the gap [-].
inline constexpr double kRampPerGap = 0.3;

/// True for a plane of a single cloth vertex.
TOILE_HD inline bool is_plane(const ContactPair& pair)
{
    return !pair.is_between_cloths() && pair.vertex[1] < 0;
}

/// Half of the room between two planes of a vertex [m], negative where body parts overlap there.
/// @param x  [vertices] where the planes were found [m]
TOILE_HD inline double half_room(const ContactPair& a, const ContactPair& b, View<const Vec3> x)
{
    return 0.5 * (a.gap(x) + b.gap(x));
}

TOILE_HD inline bool are_opposing(const ContactPair& a, const ContactPair& b)
{
    return a.normal.dot(b.normal) <= kOpposing;
}

/// What of a term's slip friction remembers.
enum class RememberedSlip {
    kSoFar,   ///< that at x
    kByStart, ///< what had stuck by t0: for pairs found again within the step, which begin there too
    kNothing
};

/// What pairs of a step become terms by.
struct ContactRules {
    View<const int> cloth_of;            ///< [vertices]
    View<const double> gap;              ///< [cloths] see ContactCloth [m]
    View<const double> partner_friction; ///< [cloths x partners] [-]
    View<const double> cloth_friction;   ///< [cloths x cloths] [-]
    PairThickness thickness;             ///< of nothing where cloth does not touch cloth
    View<const Vec3> x;                  ///< [vertices] at t0 [m]
    View<const double> diagonal;         ///< [vertices] see StepStart [N/m]
    View<const unsigned char> fixed;     ///< [vertices]
    double stiffness = 0.0;              ///< see Contact::Settings [-]
    double farthest_recovery = 0.0;      ///< [m] in the step, of cloth that is brought out
    double farthest_motion = 0.0;        ///< [m] in the step, of a surface that takes cloth along

    /// Distance that the pair is to keep [m].
    TOILE_HD double gap_of(const ContactPair& pair) const
    {
        if (!pair.is_between_cloths())
            return gap[cloth_of[pair.vertex[0]]];
        return thickness.of(pair.vertex, pair.kind == ContactKind::kClothEdgeEdge);
    }

    /// Coulomb coefficient [-].
    TOILE_HD double friction_of(const ContactPair& pair) const
    {
        const int cloth = cloth_of[pair.vertex[0]], cloths = gap.size();
        return pair.is_between_cloths()
                   ? cloth_friction[cloth * cloths + cloth_of[pair.vertex[3]]]
                   : partner_friction[cloth * (partner_friction.size() / cloths) + pair.collider];
    }

    /// As stiff as the cloth is there [N/m]; between cloths as the softer of the two sides.
    TOILE_HD double stiffness_of(const ContactPair& pair) const
    {
        double ahead = 0.0, behind = 0.0;
        for (int k = 0; k < pair.count(); ++k) {
            const double share = pair.weight[k] * diagonal[pair.vertex[k]];
            (share > 0.0 ? ahead : behind) += std::abs(share);
        }
        return stiffness * (pair.is_between_cloths() && behind < ahead ? behind : ahead);
    }

    /// True where the surface has moved, not been replaced.
    TOILE_HD bool is_carried(const Vec3& motion) const { return motion.norm() <= farthest_motion; }

    /// The pair's cloth point at t0, moved along with the collider unless that jumped [m].
    TOILE_HD Vec3 at_start(const ContactPair& pair) const
    {
        const Vec3 start = pair.cloth_point(x);
        return is_carried(pair.motion) ? Vec3(start + pair.motion) : start;
    }

    /// True where none of its vertices can move.
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
        if (slip == RememberedSlip::kNothing || term.normal_force == 0.0)
            return Vec3(0.0, 0.0, 0.0);
        return slip == RememberedSlip::kSoFar ? term.slip(now) : Vec3(at_start(term.pair) - term.anchor);
    }

    /// Without what friction remembers.
    /// @param room  half the room between this plane and an opposing one [m]
    TOILE_HD ContactTerm term_of(const ContactPair& pair, double room) const
    {
        ContactTerm term;
        term.pair = pair;
        term.friction = friction_of(pair);

        // Cloth that starts inside comes out at the recovery speed, not at once; between two parts it is
        // brought to the middle, where neither can push it through the other, and gripped there by a gap's
        // worth of force.
        const double keep = gap_of(pair);
        term.spring = {stiffness_of(pair), kRampPerGap * keep};
        const Vec3 start = at_start(pair);
        const double recovered = pair.normal.dot(start - pair.point) + farthest_recovery;
        term.offset = recovered < keep ? recovered : keep;
        if (room < 0.0 && room + keep < term.offset) {
            term.offset = room + keep;
            term.give = keep;
        }
        term.anchor = start;
        return term;
    }
};

/// Friction limits of terms [N], and how much they changed, as a sum.
struct FrictionLimits {
    double total = 0.0, change = 0.0;
    TOILE_HD FrictionLimits& operator+=(const FrictionLimits& other)
    {
        total += other.total;
        change += other.change;
        return *this;
    }
};

/// Sees how hard a term presses; the term of a sum of what friction's limits would be.
struct LookAtForce {
    View<ContactTerm> terms;
    View<const Vec3> x; ///< [vertices] [m]
    TOILE_HD FrictionLimits operator()(int i) const
    {
        ContactTerm& term = terms[i];
        term.pressing = term.pressing_force(x);
        return {term.friction * term.pressing, term.friction * std::abs(term.pressing - term.normal_force)};
    }
};

/// Bounds friction by it from now on.
struct AdoptForce {
    View<ContactTerm> terms;
    TOILE_HD void operator()(int i) const { terms[i].normal_force = terms[i].pressing; }
};

/// What terms and vertices are asked at x during a step.
struct ContactLook {
    View<const ContactTerm> terms;
    View<const Vec3> x; ///< [vertices] [m]

    TOILE_HD bool is_leaning(int i, const ContactRules& rules) const
    {
        const ContactPair& pair = terms[i].pair;
        return !pair.is_between_cloths() && terms[i].gap(x) <= kLeaning * rules.gap_of(pair);
    }

    /// True for a pair that presses of which a vertex has gone farther than `trust` [m] from where it was
    /// found.
    /// @param found_at  [vertices] [m]
    TOILE_HD bool has_slid(int i, const ContactRules& rules, View<const Vec3> found_at, double trust) const
    {
        const ContactPair& pair = terms[i].pair;
        if (pair.is_between_cloths() || terms[i].gap(x) > kPressing * rules.gap_of(pair))
            return false;
        bool has_slid = false;
        for (int k = 0; k < pair.count(); ++k)
            has_slid = has_slid || (x[pair.vertex[k]] - found_at[pair.vertex[k]]).norm() > trust;
        return has_slid;
    }

    /// How deep a step would leave it [m]; negative where it is clear.
    TOILE_HD double depth(int i) const { return -terms[i].gap(x) - terms[i].give; }
};

} // namespace toile
