#pragma once

#include "avatars/mannequin/field.h"

namespace toile::avatars {

/// Height of the mannequin in its tables [m].
inline constexpr double kMannequinHeight = 1.75;

/// Positions of the bends along the limb axes [m]; the axes start at shoulder and hip.
inline constexpr double kElbow = 0.290;
inline constexpr double kWrist = 0.535;
inline constexpr double kKnee = 0.420;
inline constexpr double kAnkle = 0.835;

/// Shape of the mannequin at kMannequinHeight: a signed distance field blended from lofts and ellipsoids.
/// Mirrored in x; the limbs stored here are those of the left side (+X).
class MannequinShape {
public:
    explicit MannequinShape(double arm_angle_deg);

    /// Distance to the skin, negative inside; smooth across the mirror plane [m].
    double distance(const Vec3& p) const;

    /// Distances to single parts, to assign a point to a bone. p may be on either side.
    double trunk_distance(const Vec3& p) const;
    double arm_distance(const Vec3& p) const;

    const Loft& arm() const { return arm_; }
    const Loft& leg() const { return leg_; }
    Vec3 shoulder() const { return arm_.center(0.0); }
    Vec3 hip() const { return leg_.center(0.0); }

private:
    double foot_distance(const Vec3& p) const;

    Loft torso_, neck_, head_;
    Loft arm_, leg_, foot_;
    RoundCone collar_;
    Ellipsoid bust_, seat_;
};

} // namespace toile::avatars
