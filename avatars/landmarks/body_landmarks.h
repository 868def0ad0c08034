#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Side of the body, as its owner says it.
enum Side { kLeft, kRight };

/// Joints and hollows of a standing or moving body that garments are placed and measured by [m].
struct BodyLandmarks {
    struct Arm {
        Vec3 shoulder = Vec3::Zero(); ///< centre of the shoulder joint
        Vec3 wrist = Vec3::Zero();    ///< centre of the wrist
    };
    struct Leg {
        Vec3 top = Vec3::Zero();   ///< centre of the thigh at the level of the crotch
        Vec3 ankle = Vec3::Zero(); ///< centre of the ankle
    };

    Vec3 up = Vec3::UnitY();       ///< of the trunk, unit
    Vec3 front = Vec3::UnitZ();    ///< that the trunk faces, unit and normal to up
    Vec3 neck_top = Vec3::Zero();  ///< centre of the neck below the head
    Vec3 neck_base = Vec3::Zero(); ///< centre of the neck at the collarbones
    Vec3 crotch = Vec3::Zero();    ///< on the skin
    std::array<Arm, 2> arm;        ///< by Side
    std::array<Leg, 2> leg;        ///< by Side

    Vec3 left() const { return up.cross(front); }
};

/// Landmarks given by name, in place of those found: "front" (a direction), "neck_top", "neck_base",
/// "crotch", "left_shoulder", "left_wrist", "left_leg_top", "left_ankle" and the same of the right.
using GivenLandmarks = std::map<std::string, Vec3>;

/// All landmarks by their names.
GivenLandmarks by_name(const BodyLandmarks& landmarks);

/// Reads a JSON object of landmarks, each [x, y, z] in metres in the body's bind pose.
/// @throws InvalidInput naming the file and the key that is unknown, with the nearest that exists, or no
/// three
///         finite numbers
GivenLandmarks read_landmarks(const std::filesystem::path& file);

/// True if nothing has to be found: all points are given. Front is +Z then, unless it is given too.
bool are_complete(const GivenLandmarks& given);

/// Replaces the landmarks that are given.
void replace(BodyLandmarks& landmarks, const GivenLandmarks& given);

} // namespace toile::avatars
