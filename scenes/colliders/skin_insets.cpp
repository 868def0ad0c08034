#include "scenes/colliders/skin_insets.h"

#include <algorithm>
#include <cmath>

namespace toile::scenes {

namespace {

/// Room [m] between surfaces of skin: for two layers of thick cloth with their gaps.
constexpr double kClearance = 0.012;

/// Maps directions at the vertices of a pose to mesh space. [vertices]
std::vector<Vec3> to_mesh_space(const avatars::SkinView& skin, View<const avatars::Affine> bones,
                                const std::vector<Vec3>& directions)
{
    std::vector<Vec3> mapped(directions.size());
    for (int v = 0; v < int(directions.size()); ++v) {
        Mat3 world_from_mesh = Mat3::Zero();
        for (int k = skin.first[v]; k < skin.first[v + 1]; ++k)
            world_from_mesh += skin.influences[k].weight * bones[skin.influences[k].bone].leftCols<3>();
        const Vec3 direction = world_from_mesh.inverse() * directions[v];
        mapped[v] = direction.allFinite() ? direction : Vec3::Zero();
    }
    return mapped;
}

/// Forgets samples that are long past, or far ahead of a clip that was wound back.
template <typename Samples>
void forget_far(Samples& samples, int sample)
{
    constexpr int kKept = 4 * SkinInsets::kReach + 2;
    std::erase_if(samples, [&](const auto& entry) { return std::abs(entry.first - sample) > kKept; });
}

} // namespace

/// Bones and vertices of a pose.
struct SkinInsets::Posed {
    std::vector<avatars::Affine> bones;
    std::vector<Vec3> x; ///< [vertices] without insets [m]

    Posed(const avatars::MovingAvatar& avatar, const avatars::PoseAt& at)
        : bones(size_t(avatar.avatar().bone_count())), x(size_t(avatar.avatar().vertex_count()))
    {
        avatar.pose_bones(at, bones);
        avatar.avatar().skin_vertices(bones, x);
    }
};

SkinInsets::SkinInsets(const avatars::MovingAvatar& avatar, const std::vector<Triangle>& triangles)
    : SkinInsets(avatar, triangles, Posed(avatar, {}))
{
}

SkinInsets::SkinInsets(const avatars::MovingAvatar& avatar, const std::vector<Triangle>& triangles,
                       const Posed& bind)
    : separation_(triangles, bind.x, kClearance),
      inward_(to_mesh_space(avatar.avatar().skin(), bind.bones, separation_.inward()))
{
}

std::vector<double> SkinInsets::at(const avatars::MovingAvatar& avatar, double t)
{
    const double position = std::max(t, 0.0) * kRate;
    const int sample = int(position);
    const double beyond = position - sample;
    forget_far(needed_, sample);
    forget_far(smooth_, sample);

    Insets insets = smooth(avatar, sample);
    if (beyond > 0.0) {
        const Insets& next = smooth(avatar, sample + 1);
        for (size_t v = 0; v < insets.size(); ++v)
            insets[v] += beyond * (next[v] - insets[v]);
    }
    return insets;
}

const SkinInsets::Insets& SkinInsets::smooth(const avatars::MovingAvatar& avatar, int sample)
{
    const auto known = smooth_.find(sample);
    if (known != smooth_.end())
        return known->second;
    Insets mean(inward_.size(), 0.0);
    for (int around = sample - kReach; around <= sample + kReach; ++around) {
        Insets largest(inward_.size(), 0.0);
        for (int k = around - kReach; k <= around + kReach; ++k) {
            const Insets& insets = needed(avatar, std::max(k, 0));
            for (size_t v = 0; v < largest.size(); ++v)
                largest[v] = std::max(largest[v], insets[v]);
        }
        for (size_t v = 0; v < mean.size(); ++v)
            mean[v] += largest[v] / (2 * kReach + 1);
    }
    return smooth_[sample] = std::move(mean);
}

const SkinInsets::Insets& SkinInsets::needed(const avatars::MovingAvatar& avatar, int sample)
{
    const auto known = needed_.find(sample);
    if (known != needed_.end())
        return known->second.insets;
    const avatars::PoseAt pose = avatar.shape_at(sample / kRate);
    const auto same = std::find_if(needed_.begin(), needed_.end(),
                                   [&](const auto& entry) { return entry.second.pose == pose; });
    Insets insets = same != needed_.end() ? same->second.insets : separated(avatar, pose);
    return (needed_[sample] = {pose, std::move(insets)}).insets;
}

SkinInsets::Insets SkinInsets::separated(const avatars::MovingAvatar& avatar, const avatars::PoseAt& pose)
{
    const Posed posed(avatar, pose);
    avatars::SkinView skin = avatar.avatar().skin();
    skin.inward = inward_;
    std::vector<Vec3> inward(inward_.size());
    for (int v = 0; v < int(inward.size()); ++v)
        inward[v] = skin.posed_inward(v, posed.bones);
    return separation_.insets(posed.x, inward);
}

} // namespace toile::scenes
