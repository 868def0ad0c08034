#include "avatars/model/clip.h"

#include <algorithm>

namespace toile::avatars {

namespace {

double linear(double a, double b, double fraction) { return (1.0 - fraction) * a + fraction * b; }

Vec3 linear(const Vec3& a, const Vec3& b, double fraction) { return (1.0 - fraction) * a + fraction * b; }

Eigen::Quaterniond linear(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double fraction)
{
    return a.slerp(fraction, b);
}

/// Cubic on a span of `duration` [s] with end values a, b and end derivatives out_a, in_b; u from 0 to 1.
template <typename Value>
Value hermite(const Value& a, const Value& out_a, const Value& in_b, const Value& b, double duration,
              double u)
{
    const double u2 = u * u, u3 = u2 * u;
    return (2.0 * u3 - 3.0 * u2 + 1.0) * a + duration * (u3 - 2.0 * u2 + u) * out_a +
           (3.0 * u2 - 2.0 * u3) * b + duration * (u3 - u2) * in_b;
}

Eigen::Quaterniond hermite(const Eigen::Quaterniond& a, const Eigen::Quaterniond& out_a,
                           const Eigen::Quaterniond& in_b, const Eigen::Quaterniond& b, double duration,
                           double u)
{
    const Eigen::Vector4d sum =
        hermite<Eigen::Vector4d>(a.coeffs(), out_a.coeffs(), in_b.coeffs(), b.coeffs(), duration, u);
    return Eigen::Quaterniond(sum).normalized();
}

template <typename Value>
Value value_at(const Track<Value>& track, double time, const Value& rest)
{
    const std::vector<Key<Value>>& keys = track.keys;
    if (keys.empty())
        return rest;
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const Key<Value>& key) { return t < key.time; });
    if (after == keys.begin())
        return keys.front().value;
    if (after == keys.end())
        return keys.back().value;
    const auto before = after - 1;
    const double duration = after->time - before->time;
    const double u = (time - before->time) / duration;
    switch (track.interpolation) {
    case Interpolation::Step:
        return before->value;
    case Interpolation::CubicSpline: {
        const auto tangents = track.tangents.begin() + (before - keys.begin());
        return hermite(before->value, tangents[0].out, tangents[1].in, after->value, duration, u);
    }
    case Interpolation::Linear:
        break;
    }
    return linear(before->value, after->value, u);
}

} // namespace

void sample(const Clip& clip, const Skeleton& skeleton, double time, View<JointTransform> out)
{
    for (int j = 0; j < skeleton.size(); ++j)
        out[j] = skeleton.joints()[j].rest;
    for (const JointTrack& track : clip.tracks) {
        const JointTransform& rest = skeleton.joints()[track.joint].rest;
        out[track.joint] = {value_at(track.translation, time, rest.translation),
                            value_at(track.rotation, time, rest.rotation),
                            value_at(track.scale, time, rest.scale)};
    }
}

void sample_shapes(const Clip& clip, View<const double> rest, double time, View<double> out)
{
    for (int s = 0; s < rest.size(); ++s)
        out[s] = rest[s];
    for (const ShapeTrack& track : clip.shape_tracks)
        out[track.shape] = value_at(track.weight, time, rest[track.shape]);
}

} // namespace toile::avatars
