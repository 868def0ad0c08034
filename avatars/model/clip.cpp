#include "avatars/model/clip.h"

#include <algorithm>

namespace toile::avatars {

namespace {

Vec3 interpolate(const Vec3& a, const Vec3& b, double fraction)
{
    return (1.0 - fraction) * a + fraction * b;
}

Eigen::Quaterniond interpolate(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double fraction)
{
    return a.slerp(fraction, b);
}

template <typename Value>
Value sample_track(const std::vector<Key<Value>>& keys, double time, const Value& rest)
{
    if (keys.empty())
        return rest;
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const Key<Value>& key) { return t < key.time; });
    if (after == keys.begin())
        return keys.front().value;
    if (after == keys.end())
        return keys.back().value;
    const auto before = after - 1;
    return interpolate(before->value, after->value, (time - before->time) / (after->time - before->time));
}

} // namespace

void sample(const Clip& clip, const Skeleton& skeleton, double time, View<JointTransform> out)
{
    for (int j = 0; j < skeleton.size(); ++j)
        out[j] = skeleton.joints()[j].rest;
    for (const JointTrack& track : clip.tracks) {
        const JointTransform& rest = skeleton.joints()[track.joint].rest;
        out[track.joint] = {sample_track(track.translation, time, rest.translation),
                            sample_track(track.rotation, time, rest.rotation),
                            sample_track(track.scale, time, rest.scale)};
    }
}

} // namespace toile::avatars
