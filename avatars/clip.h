#pragma once

#include <string>
#include <vector>

#include "avatars/skeleton.h"

namespace toile {

template <typename Value>
struct Key {
    double time = 0.0; ///< [s] ascending within a track
    Value value;
};

/// The motion of one joint. An empty track leaves that part at the joint's rest; before the first and after
/// the last key the end value holds; in between keys are joined linearly (rotations along great circles).
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

/// The joints' transforms in their parents at a clip time [s].
/// @param out  [joints]; joints without a track get their rest transform.
void sample(const Clip& clip, const Skeleton& skeleton, double time, View<JointTransform> out);

} // namespace toile
