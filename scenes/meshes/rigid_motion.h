#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "scenes/format/scene.h"

namespace toile::scenes {

/// R = Rz Ry Rx: rotation about the fixed X axis first, then Y, then Z.
Mat3 rotation_of(const Vec3& rotate_deg);

/// Keyframes of a rigid motion about a pivot, constant outside. Between them, positions and angles follow
/// monotone cubics [Fritsch & Butland 1984]: speed has no jumps at inner keyframes, nothing overshoots, and
/// two keyframes alone make a uniform motion.
class RigidMotion {
public:
    RigidMotion() = default;
    /// @param keyframes  ascending in time
    RigidMotion(std::vector<scene::Keyframe> keyframes, const Vec3& pivot);

    bool is_static() const { return keyframes_.size() < 2; }

    /// Transform at time t [s] from the start placement to the world.
    Eigen::Isometry3d at(double t) const;

private:
    std::vector<scene::Keyframe> keyframes_;
    std::vector<scene::Keyframe> rates_; ///< [keyframes] translate [m/s] and rotate_deg [1/s] at a keyframe
    Vec3 pivot_ = Vec3::Zero();
};

} // namespace toile::scenes
