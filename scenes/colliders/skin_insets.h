#pragma once

#include <map>
#include <vector>

#include "avatars/model/moving_avatar.h"
#include "collision/skin/skin_separation.h"

namespace toile::scenes {

/// Insets of an avatar's skin over time (SkinSeparation): those that poses need, smooth in time.
///
/// Poses are separated at samples k / kRate. An inset at a sample is the mean over the samples around it of
/// the maximum over the samples around those, and therefore at least what the pose needs. In between it is
/// linear. It depends on time alone.
class SkinInsets {
public:
    /// @param triangles  faces of the avatar that cloth collides with
    SkinInsets(const avatars::MovingAvatar& avatar, const std::vector<Triangle>& triangles);

    /// Directions into the body in mesh space, for SkinView::inward. [vertices]
    View<const Vec3> inward() const { return inward_; }

    /// Insets at simulation time t [s]. [vertices] [m]
    /// @param avatar  of the constructor
    std::vector<double> at(const avatars::MovingAvatar& avatar, double t);

    static constexpr double kRate = 30.0; ///< [1/s]
    static constexpr int kReach = 1;      ///< samples before and after one that are around it

private:
    struct Posed;
    SkinInsets(const avatars::MovingAvatar& avatar, const std::vector<Triangle>& triangles,
               const Posed& bind);

    struct Sample {
        avatars::PoseAt pose;
        std::vector<double> insets;
    };
    using Insets = std::vector<double>;

    const Insets& needed(const avatars::MovingAvatar& avatar, int sample);
    const Insets& smooth(const avatars::MovingAvatar& avatar, int sample);
    Insets separated(const avatars::MovingAvatar& avatar, const avatars::PoseAt& pose);

    collision::SkinSeparation separation_;
    std::vector<Vec3> inward_;     ///< [vertices] in mesh space
    std::map<int, Sample> needed_; ///< by sample, of the last ones asked for
    std::map<int, Insets> smooth_; ///< likewise
};

} // namespace toile::scenes
