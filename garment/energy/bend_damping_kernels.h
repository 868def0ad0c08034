#pragma once

#include <array>

#include <Eigen/Geometry>

#include "core/compute/lanes.h"
#include "core/linear/sliced_rows.h"

namespace toile::garment {

/// Fold of an inner edge (v0, v1) between the triangles (v0, v1, a) and (v1, v0, b), with the angle theta
/// between their normals: s = 2 sin(theta / 2), signed, and its derivative.
template <typename T>
struct Fold {
    T s;                    ///< [-] theta, for small angles; 0 where a triangle has collapsed
    T cosine;               ///< ds / dtheta = cos(theta / 2)
    Vec3Of<T> v0, v1, a, b; ///< ds / dx [1/m]
};

template <typename T>
TOILE_HD Fold<T> fold_of(const Vec3Of<T>& v0, const Vec3Of<T>& v1, const Vec3Of<T>& a, const Vec3Of<T>& b)
{
    const T zero(0.0), half(0.5), one(1.0), two(2.0);
    const Vec3Of<T> e = v1 - v0, ea = a - v0, eb = b - v0;
    const Vec3Of<T> na = e.cross(ea), nb = eb.cross(e);
    const T edge = e.squaredNorm(), aa = na.squaredNorm(), bb = nb.squaredNorm();
    const T product = aa * bb;
    const auto is_valid = product > zero;
    const T safe_edge = select(is_valid, edge, one);
    const T length = square_root(safe_edge), norm = square_root(select(is_valid, product, one));
    const T cosine = na.dot(nb) / norm, sine = na.cross(nb).dot(e) / (norm * length);

    // Either form is exact where the other cancels.
    const T rise = square_root(select(cosine > zero, half * (one + cosine), one));  // cos(theta / 2)
    const T chord = square_root(select(cosine > zero, zero, two * (one - cosine))); // |s|
    Fold<T> fold;
    fold.s = select(cosine > zero, sine / rise, select(sine < zero, -chord, chord));
    fold.s = select(is_valid, fold.s, zero);
    const T square = one - half * half * fold.s * fold.s;
    fold.cosine = select(cosine > zero, rise, square_root(select(square > zero, square, zero)));
    fold.cosine = select(is_valid, fold.cosine, zero);

    const T scale = -fold.cosine * length;
    fold.a = (scale / select(is_valid, aa, one)) * na;
    fold.b = (scale / select(is_valid, bb, one)) * nb;
    const T at_a = e.dot(ea) / safe_edge, at_b = e.dot(eb) / safe_edge;
    fold.v0 = (at_a - one) * fold.a + (at_b - one) * fold.b;
    fold.v1 = -at_a * fold.a - at_b * fold.b;
    return fold;
}

/// Value of a hinge's potential and derivatives by the change of s.
template <typename T>
struct HingeResponse {
    T energy, moment, stiffness; ///< [J], [N m], [N m]
};

/// Potential of a hinge; see BendDamping. Its dry part is f(u) = u from the slip on, and
/// -u^3 / (3 slip^2) + u^2 / slip + slip / 3 below.
/// @param change   of s during the step [-]
/// @param viscous  B tau / h [N m]
/// @param dry      moment per width times the edge [N m]
/// @param slip     [-]
template <typename T>
TOILE_HD HingeResponse<T> hinge_response(const T& change, const T& viscous, const T& dry, const T& slip)
{
    const T zero(0.0), one(1.0), third(1.0 / 3.0);
    const T size = select(change < zero, -change, change);
    const T u = size / slip;
    const auto is_sliding = u > one;
    const T value = select(is_sliding, size, slip * (third + u * u * (one - third * u)));
    const T slope = select(is_sliding, one, u * (T(2.0) - u));
    const T curvature = select(is_sliding, zero, T(2.0) * (one - u) / slip);
    return {T(0.5) * viscous * change * change + dry * (value - third * slip),
            viscous * change + dry * select(change < zero, -slope, slope), viscous + dry * curvature};
}

/// Inner edge of BendDamping with its two triangles.
struct Hinge {
    std::array<int, 4> vertex;    ///< v0, v1, a, b of Fold
    std::array<double, 4> weight; ///< ds / dx of each along the normal, in the flat rest state [1/m]
    double viscous;               ///< [N m s] B tau
    double dry;                   ///< [N m]
    double slip_rate;             ///< [1/s]
};

/// State of a hinge at the start of a step.
struct HingeStart {
    double s = 0.0; ///< see Fold

    /// Part of its friction that acts, by the heights of both triangles over those at rest, squared [-]. The
    /// fold of crushed triangles turns about by next to no motion, and the curvature of the potential counts
    /// on heights at rest.
    double share = 1.0;
};

/// @param x  [vertices] [m]
TOILE_HD inline double friction_share(const Hinge& hinge, View<const Vec3> x)
{
    const Vec3& v0 = x[hinge.vertex[0]];
    const Vec3 e = x[hinge.vertex[1]] - v0;
    double share = 1.0;
    for (int k = 2; k < 4; ++k) {
        const double squared_height = e.cross(x[hinge.vertex[k]] - v0).squaredNorm() / e.squaredNorm();
        const double now = squared_height * hinge.weight[k] * hinge.weight[k];
        share = now < share ? now : share; // a collapsed edge keeps its share
    }
    return share;
}

/// Hinges during a step, one at a time as a GPU runs them; the CPU runs eight (BendDamping).
struct HingesInStep {
    View<const Hinge> hinges;
    View<const double> dt;        ///< [1] [s] 0 before the first step: no response
    View<const HingeStart> start; ///< [hinges]
    View<const Vec3> x;           ///< [vertices] [m]

    TOILE_HD Fold<double> fold(int h) const
    {
        const std::array<int, 4> v = hinges[h].vertex;
        return fold_of<double>(x[v[0]], x[v[1]], x[v[2]], x[v[3]]);
    }
    TOILE_HD HingeResponse<double> response(int h, const Fold<double>& fold) const
    {
        if (dt[0] == 0.0)
            return {0.0, 0.0, 0.0};
        const Hinge& hinge = hinges[h];
        const double share = start[h].share;
        return hinge_response<double>(fold.s - start[h].s, share * hinge.viscous / dt[0], share * hinge.dry,
                                      hinge.slip_rate * dt[0]);
    }
};

/// Starts a hinge's step.
struct StartHinge {
    HingesInStep step;
    View<HingeStart> start; ///< [hinges] out

    TOILE_HD void operator()(int h) const
    {
        start[h] = {step.fold(h).s, friction_share(step.hinges[h], step.x)};
    }
};

/// Energy of a hinge and its forces, in single precision.
struct PullHinge {
    HingesInStep step;
    View<PaddedVec3> force; ///< [4 * hinges] out: by 4 * hinge + slot [N]
    View<double> energy;    ///< [hinges] out [J]

    TOILE_HD void operator()(int h) const
    {
        const Fold<double> fold = step.fold(h);
        const HingeResponse<double> change = step.response(h, fold);
        energy[h] = change.energy;
        force[4 * h] = padded(change.moment * fold.v0);
        force[4 * h + 1] = padded(change.moment * fold.v1);
        force[4 * h + 2] = padded(change.moment * fold.a);
        force[4 * h + 3] = padded(change.moment * fold.b);
    }
};

/// Sums the forces of hinges at vertex v, by a team of threads.
struct GatherHinges {
    View<const int> first;        ///< [vertices + 1]
    View<const int> slots;        ///< 4 * hinge + slot, ascending per vertex
    View<const PaddedVec3> force; ///< [4 * hinges] [N]
    View<Vec3> gradient;          ///< [vertices] added to [N]

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_in_range) const
    {
        PaddedVec3 sum(0.0F);
        for (int k = first[v] + team.thread; k < first[v + 1]; k += Team::width())
            sum += force[slots[k]];
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        if (team.thread == 0 && is_in_range)
            gradient[v] += unpadded(sum);
    }
};

/// Second derivative of a hinge's potential by s, with s as a function of the angle.
struct StiffenHinge {
    HingesInStep step;
    View<float> stiffness; ///< [hinges] out [N m]

    TOILE_HD void operator()(int h) const
    {
        const Fold<double> fold = step.fold(h);
        stiffness[h] = float(step.response(h, fold).stiffness * fold.cosine * fold.cosine);
    }
};

/// Adds the stiffness of hinges to the two entries of a pair of their vertices.
struct AddHingeStiffness {
    View<const int> first;                    ///< [pairs + 1] into items
    View<const RowEntry> items;               ///< hinge and product of the two vertices' weights [1/m^2]
    View<const std::array<int, 2>> positions; ///< [pairs] of the entries
    View<const float> stiffness;              ///< [hinges] [N m]
    View<float> scalars;                      ///< added to [N/m]

    TOILE_HD void operator()(int pair) const
    {
        float sum = 0.0F;
        for (int k = first[pair]; k < first[pair + 1]; ++k)
            sum += stiffness[items[k].column] * items[k].value;
        scalars[positions[pair][0]] += sum;
        scalars[positions[pair][1]] += sum;
    }
};

} // namespace toile::garment
