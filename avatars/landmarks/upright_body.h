#pragma once

#include <optional>
#include <string>

#include "avatars/landmarks/body_landmarks.h"
#include "avatars/landmarks/cross_section.h"

namespace toile::avatars {

/// Landmarks of a body in its own frame, Y up, Z in front, X to its left, from horizontal slices. Standing on
/// both legs, arms at least a hand's breadth away from the trunk: in A-pose, T-pose or between.
///
///          crown
///          (   )   neck_top: below the chin
///       ___)   (___   neck_base: where the slices widen to the shoulders
///      /  |     |  \     armpit: where slices of arm and trunk merge
///     /  /|     |\  \        .
///        /   ^   \      crotch: where slices of the legs merge
///       |   | |   |
///       |___| |___|     ankle: thinnest above the foot
struct UprightBody {
    std::string source; ///< named in errors
    TriangleMesh mesh;  ///< in the body's frame [m]
    Mat3 world_from_body = Mat3::Identity();
    Bounds box{};

    struct Arm {
        Vec3 armpit = Vec3::Zero();
        Vec3 shoulder_tip = Vec3::Zero(); ///< on the skin above the armpit
        Vec3 shoulder = Vec3::Zero();     ///< on the arm's axis, above the armpit
        Vec3 elbow = Vec3::Zero();        ///< on the arm's axis
        Vec3 wrist = Vec3::Zero();        ///< on the arm's axis, where it is thinnest
        Vec3 wrist_axis = Vec3::Zero();   ///< normal of the slice there, unit; zero: the wrist was given
        double wrist_tape = 0.0;          ///< around it [m]
    };
    struct Leg {
        Vec3 top = Vec3::Zero(); ///< centre of the slice at the crotch
        Vec3 ankle = Vec3::Zero();
    };
    Vec3 crotch = Vec3::Zero();
    Vec3 neck_base = Vec3::Zero();
    Vec3 neck_top = Vec3::Zero();
    std::array<Arm, 2> arm;
    std::array<Leg, 2> leg;

    double height() const { return box.upper.y() - box.lower.y(); }
    BodyLandmarks landmarks() const;
};

/// Slices a body. Front is where the toes point, unless it is given.
/// @param mesh   Y up [m]
/// @param given  "front" is used; points stand for those that are not searched then
/// @throws InvalidInput in one line that names the first part that could not be found
UprightBody find_upright_body(TriangleMesh mesh, const GivenLandmarks& given, const std::string& source);

/// Slice of the trunk at a level: without arms and with both thighs' common curve.
/// @throws InvalidInput where there is none
SectionLoop trunk_slice(const UprightBody& body, double y);

} // namespace toile::avatars
