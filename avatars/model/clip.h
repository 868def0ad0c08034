#pragma once

#include <string>
#include <vector>

#include "avatars/model/skeleton.h"

namespace toile::avatars {

template <typename Value>
struct Key {
    double time = 0.0; ///< [s] ascending within a track
    Value value;
};

/// Motion of one joint. A part with an empty track keeps the joint's rest value. Before the first and after
/// the last key the end value holds; between keys interpolation is linear (rotations along great circles).
struct JointTrack {
    int joint = -1;
    std::vector<Key<Vec3>> translation;
    std::vector<Key<Eigen::Quaterniond>> rotation;
    std::vector<Key<Vec3>> scale;
};

/// A named motion of a skeleton.
struct Clip {
    std::string name;
    double duration = 0.0; ///< [s]
    std::vector<JointTrack> tracks;
};

/// Computes the joints' transforms in their parents at a clip time [s].
/// @param out  [joints]; joints without a track get their rest transform.
void sample(const Clip& clip, const Skeleton& skeleton, double time, View<JointTransform> out);

} // namespace toile::avatars
