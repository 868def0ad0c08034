#include "avatars/mannequin/mannequin_shape.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace toile::avatars {

namespace {

/// Half width over which the two halves blend at the mirror plane [m].
constexpr double kMirrorBlend = 0.010;

/// Blend widths of the fillets between parts [m].
constexpr double kNeckFillet = 0.045;
constexpr double kHeadFillet = 0.025;
constexpr double kCollarFillet = 0.070;
constexpr double kBustFillet = 0.050;
constexpr double kSeatFillet = 0.060;
constexpr double kLegFillet = 0.045;
constexpr double kArmFillet = 0.050;
constexpr double kFootFillet = 0.030;
constexpr double kSoleRounding = 0.012;

const Vec3 kShoulder(0.161, 1.387, -0.014);
const Vec3 kHip(0.092, 0.910, 0.000);
const Vec3 kAnkleCenter(0.118, 0.075, -0.012);

/// Mirrors p to the left side, rounding the crease in the middle.
Vec3 mirrored(const Vec3& p)
{
    return {std::sqrt(p.x() * p.x() + kMirrorBlend * kMirrorBlend), p.y(), p.z()};
}

Loft make_torso()
{
    return {{},
            {{0.845, 0, 0.000, 0.118, 0.078, 0.088},
             {0.900, 0, 0.000, 0.152, 0.090, 0.097},
             {0.950, 0, 0.000, 0.156, 0.095, 0.096},
             {1.000, 0, 0.000, 0.148, 0.091, 0.087},
             {1.050, 0, 0.000, 0.131, 0.084, 0.078},
             {1.100, 0, 0.000, 0.118, 0.079, 0.074},
             {1.150, 0, 0.000, 0.117, 0.081, 0.078},
             {1.200, 0, 0.000, 0.123, 0.087, 0.086},
             {1.270, 0, 0.000, 0.135, 0.095, 0.098},
             {1.340, 0, -0.004, 0.140, 0.086, 0.100},
             {1.390, 0, -0.013, 0.122, 0.064, 0.084},
             {1.425, 0, -0.020, 0.088, 0.050, 0.064},
             {1.455, 0, -0.022, 0.052, 0.040, 0.048}},
            0.055,
            0.030};
}

Loft make_neck()
{
    const Vec3 bottom(0.0, 1.420, -0.026), top(0.0, 1.580, 0.012);
    const Vec3 S = (top - bottom).normalized();
    return {{bottom, S, Vec3::UnitX(), Vec3::UnitX().cross(S)},
            {{0.000, 0, 0, 0.054, 0.050, 0.054},
             {0.060, 0, 0, 0.044, 0.043, 0.046},
             {0.110, 0, 0, 0.042, 0.042, 0.044},
             {0.160, 0, 0, 0.044, 0.044, 0.046}},
            0.030,
            0.030};
}

Loft make_head()
{
    return {{},
            {{1.545, 0, 0.050, 0.035, 0.034, 0.046},
             {1.570, 0, 0.036, 0.049, 0.056, 0.064},
             {1.610, 0, 0.022, 0.062, 0.075, 0.084},
             {1.650, 0, 0.012, 0.068, 0.083, 0.094},
             {1.680, 0, 0.006, 0.068, 0.081, 0.094}},
            0.026,
            0.070};
}

Loft make_arm(double arm_angle_deg)
{
    const double angle = arm_angle_deg * std::numbers::pi / 180.0;
    const Vec3 S(std::sin(angle), -std::cos(angle), 0.0);
    const Vec3 U(std::cos(angle), std::sin(angle), 0.0);
    return {{kShoulder, S, U, Vec3::UnitZ()},
            {{0.000, 0, 0.000, 0.041, 0.042, 0.043},
             {0.060, 0, 0.000, 0.042, 0.043, 0.044},
             {0.130, 0, -0.002, 0.037, 0.040, 0.040},
             {0.210, 0, -0.004, 0.033, 0.036, 0.036},
             {kElbow, 0, -0.004, 0.030, 0.033, 0.032},
             {0.340, 0, 0.002, 0.031, 0.034, 0.033},
             {0.420, 0, 0.011, 0.027, 0.029, 0.029},
             {0.500, 0, 0.020, 0.021, 0.023, 0.023},
             {kWrist, 0, 0.024, 0.019, 0.021, 0.021},
             {0.570, -0.001, 0.030, 0.020, 0.031, 0.027},
             {0.610, -0.004, 0.036, 0.021, 0.036, 0.031},
             {0.650, -0.009, 0.041, 0.019, 0.032, 0.030},
             {0.695, -0.017, 0.047, 0.016, 0.024, 0.024}},
            0.045,
            0.030};
}

Loft make_leg()
{
    const Vec3 S = (kAnkleCenter - kHip).normalized();
    const Vec3 U = (Vec3::UnitX() - S.x() * S).normalized();
    return {{kHip, S, U, U.cross(S)},
            {{0.020, -0.004, 0.000, 0.077, 0.077, 0.078},
             {0.100, -0.001, 0.000, 0.079, 0.080, 0.082},
             {0.190, 0.004, 0.002, 0.073, 0.076, 0.074},
             {0.290, 0.002, 0.004, 0.060, 0.065, 0.061},
             {0.370, 0.000, 0.006, 0.049, 0.053, 0.050},
             {kKnee, 0.000, 0.006, 0.045, 0.049, 0.045},
             {0.470, 0.001, 0.000, 0.044, 0.044, 0.048},
             {0.540, 0.003, -0.008, 0.048, 0.043, 0.056},
             {0.600, 0.002, -0.010, 0.044, 0.041, 0.053},
             {0.680, 0.000, -0.008, 0.035, 0.034, 0.042},
             {0.750, 0.000, -0.004, 0.027, 0.030, 0.033},
             {0.810, 0.000, -0.002, 0.026, 0.031, 0.031}},
            0.130,
            0.045};
}

/// Foot from the ankle to the toes, rotated outwards a little. V is up. Sections reach below the floor, which
/// cuts the sole flat.
Loft make_foot()
{
    const double turn_out = 7.0 * std::numbers::pi / 180.0;
    const Vec3 S(std::sin(turn_out), 0.0, std::cos(turn_out));
    return {{{kAnkleCenter.x(), 0.0, kAnkleCenter.z()}, S, S.cross(-Vec3::UnitY()), Vec3::UnitY()},
            {{-0.025, 0, 0.022, 0.029, 0.042, 0.040},
             {0.020, 0, 0.022, 0.031, 0.054, 0.040},
             {0.060, 0, 0.020, 0.036, 0.046, 0.036},
             {0.100, 0, 0.016, 0.042, 0.032, 0.030},
             {0.135, 0, 0.012, 0.042, 0.022, 0.026},
             {0.160, 0, 0.010, 0.037, 0.017, 0.022}},
            0.032,
            0.036};
}

} // namespace

MannequinShape::MannequinShape(double arm_angle_deg)
    : torso_(make_torso()), neck_(make_neck()), head_(make_head()), arm_(make_arm(arm_angle_deg)),
      leg_(make_leg()), foot_(make_foot()), collar_{{0.035, 1.424, -0.020}, kShoulder, 0.036, 0.040},
      bust_{{0.066, 1.262, 0.064}, {0.062, 0.068, 0.052}}, seat_{{0.076, 0.888, -0.052},
                                                                 {0.080, 0.092, 0.074}}
{
}

double MannequinShape::trunk_distance(const Vec3& p) const
{
    const Vec3 q = mirrored(p);
    double d = torso_.distance(p);
    d = smooth_union(d, collar_.distance(q), kCollarFillet);
    d = smooth_union(d, neck_.distance(p), kNeckFillet);
    d = smooth_union(d, head_.distance(p), kHeadFillet);
    d = smooth_union(d, bust_.distance(q), kBustFillet);
    return smooth_union(d, seat_.distance(q), kSeatFillet);
}

double MannequinShape::arm_distance(const Vec3& p) const { return arm_.distance(mirrored(p)); }

double MannequinShape::foot_distance(const Vec3& p) const
{
    return smooth_intersection(foot_.distance(p), -p.y(), kSoleRounding);
}

double MannequinShape::distance(const Vec3& p) const
{
    const Vec3 q = mirrored(p);
    double d = smooth_union(trunk_distance(p), leg_.distance(q), kLegFillet);
    d = smooth_union(d, foot_distance(q), kFootFillet);
    return smooth_union(d, arm_distance(p), kArmFillet);
}

} // namespace toile::avatars
