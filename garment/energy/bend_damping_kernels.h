#pragma once

#include <Eigen/Geometry>

#include "core/compute/lanes.h"

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

} // namespace toile::garment
