#pragma once

#include <vector>

#include "collision/check/penetration.h"

namespace toile::collision {

/// A cloth in two frames.
struct ClothFrames {
    ClothFrames(const ClothSamples& samples, View<const Vec3> x0, View<const Vec3> x1)
        : samples(samples), x0(x0), x1(x1), from(samples.at(x0)), to(samples.at(x1))
    {
    }

    const ClothSamples& samples;
    View<const Vec3> x0, x1;    ///< [vertices] [m]
    std::vector<Vec3> from, to; ///< [samples] [m]
};

/// Sample of cloth that went through a body between two frames.
struct Passage {
    int sample = -1;
    Vec3 point = Vec3::Zero(); ///< middle of its way through the body, in the first frame [m]
    bool is_pinched = false;   ///< where it entered or left the body (PenetrationMeter::is_pinched)
};

/// Samples that went through a body between two frames and are free again, which no single frame shows. The
/// straight path of a sample relative to the body enters it and leaves it on the opposite side (or changes
/// the side of an open one), and the cloth around goes along: seen from the middle of the path, it lay behind
/// in the first frame, and in no direction has it stayed where it was. Cloth that slides around a thin body
/// stays in some direction. Borders may go around a body and are left out.
///
///         x0                          x1
///      ----o----      ( body )     ----o----
///         behind  <-----  ----->  ahead
///
/// Parts of a body that move relative to the one nearest to a sample are not seen by it. Two layers of one
/// cloth that pass together are not seen.
/// @param body  at the first frame
/// @param y1    [vertices of the body] at the second [m]
std::vector<Passage> find_passages(const ClothFrames& cloth, const PenetrationMeter& body,
                                   View<const Vec3> y1);

/// Likewise through a shape.
/// @param pose0, pose1  world_from_shape
std::vector<Passage> find_passages(const ClothFrames& cloth, const Shape& shape,
                                   const Eigen::Isometry3d& pose0, const Eigen::Isometry3d& pose1);

} // namespace toile::collision
