#pragma once

#include <string>
#include <vector>

#include "avatars/model/skeleton.h"

namespace toile::avatars {

/// Course of a value between two keys.        [glTF 2.0, appendix C]
enum class Interpolation {
    Step,        ///< the value of the key before
    Linear,      ///< rotations along the shorter great circle
    CubicSpline, ///< Hermite, through values and tangents; rotations by components, then normalised
};

template <typename Value>
struct Key {
    double time = 0.0; ///< [s] ascending within a track
    Value value;
};

/// Derivatives at a key, of the curve that ends and of the one that begins there [1/s].
template <typename Value>
struct Tangents {
    Value in, out;
};

/// A value over time. Before the first and after the last key the end value holds.
template <typename Value>
struct Track {
    std::vector<Key<Value>> keys;
    std::vector<Tangents<Value>> tangents{}; ///< [keys] of a CubicSpline; else empty
    Interpolation interpolation = Interpolation::Linear;
};

/// Motion of one joint. A part with an empty track keeps the joint's rest value.
struct JointTrack {
    int joint = -1;
    Track<Vec3> translation{};
    Track<Eigen::Quaterniond> rotation{};
    Track<Vec3> scale{};
};

/// Weight of one blend shape over time.
struct ShapeTrack {
    int shape = -1;
    Track<double> weight{};
};

/// A named motion of a skeleton and of the blend shapes on it.
struct Clip {
    std::string name;
    double duration = 0.0; ///< [s]
    std::vector<JointTrack> tracks{};
    std::vector<ShapeTrack> shape_tracks{};
};

/// Computes the joints' transforms in their parents at a clip time [s].
/// @param out  [joints]; joints without a track get their rest transform.
void sample(const Clip& clip, const Skeleton& skeleton, double time, View<JointTransform> out);

/// Computes the weights of the blend shapes at a clip time [s].
/// @param rest  [shapes] weights of shapes without a track
/// @param out   [shapes]
void sample_shapes(const Clip& clip, View<const double> rest, double time, View<double> out);

} // namespace toile::avatars
