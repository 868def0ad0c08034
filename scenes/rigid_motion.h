#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "scenes/format/scene.h"

namespace toile {

/// R = Rz Ry Rx: turned about the fixed X axis first, then Y, then Z.
Mat3 rotation_of(const Vec3& rotate_deg);

/// Keyframes of a rigid motion about a pivot, interpolated linearly and held outside.
class RigidMotion {
public:
    RigidMotion() = default;
    /// @param keyframes  ascending in time
    RigidMotion(std::vector<scene::Keyframe> keyframes, const Vec3& pivot);

    bool is_static() const { return keyframes_.size() < 2; }

    /// World placement at time t [s] of something placed in its start position.
    Eigen::Isometry3d at(double t) const;

private:
    std::vector<scene::Keyframe> keyframes_;
    Vec3 pivot_ = Vec3::Zero();
};

} // namespace toile
