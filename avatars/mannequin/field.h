#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::avatars {

/// Approximate signed distance of two shapes joined with a fillet, negative inside.
///
///   min(a, b) - (k/4) h^2,  h = max(1 - |a - b| / k, 0)        [Quilez, "smooth minimum", quadratic]
///
/// If the distances differ by more than k [m] it is the plain minimum, so distant parts do not swell.
double smooth_union(double a, double b, double k);

/// Intersection of two solids, with the edge between them rounded over k [m].
inline double smooth_intersection(double a, double b, double k) { return -smooth_union(-a, -b, k); }

/// One cross-section of a Loft: an ellipse with separate half depths in front and behind.
struct Section {
    double s;      ///< position along the axis [m]
    double u, v;   ///< centre of the ellipse [m]
    double side;   ///< half width along +-U [m]
    double front;  ///< half depth along +V [m]
    double behind; ///< half depth along -V [m]
};

/// A body part: ellipses along a straight axis, joined by cubic Hermite curves, closed by half ellipsoids.
class Loft {
public:
    struct Frame {
        Vec3 origin = Vec3::Zero();
        Vec3 S = Vec3::UnitY(); ///< along the axis, unit
        Vec3 U = Vec3::UnitX(); ///< sideways, unit, normal to S
        Vec3 V = Vec3::UnitZ(); ///< S x U or its opposite
    };

    /// @param sections         ascending in s, at least two
    /// @param cap_low, cap_high  lengths of the end caps beyond the first and last section [m]
    Loft(Frame frame, std::vector<Section> sections, double cap_low, double cap_high);

    /// Signed distance to first order: exact on the surface; its error grows with the curvature away from it
    /// [m].
    double distance(const Vec3& p) const;

    /// Position of p along the axis [m].
    double along(const Vec3& p) const { return (p - frame_.origin).dot(frame_.S); }

    /// Point of the centre line at s.
    Vec3 center(double s) const;

private:
    Section section_at(double s) const;

    Frame frame_;
    std::vector<Section> sections_;
    double cap_low_, cap_high_;
};

/// An ellipsoid with axes along x, y and z; distance as for Loft.
struct Ellipsoid {
    Vec3 center;
    Vec3 radii; ///< [m]

    double distance(const Vec3& p) const;
};

/// A ball rolling from a to b while its radius changes; the distance is exact if the radii are equal.
struct RoundCone {
    Vec3 a, b;
    double radius_a, radius_b; ///< [m]

    double distance(const Vec3& p) const;
};

} // namespace toile::avatars
