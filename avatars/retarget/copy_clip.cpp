#include "avatars/retarget/copy_clip.h"

#include <cmath>

#include "avatars/retarget/clip_times.h"
#include "avatars/retarget/cmu_skeleton.h"
#include "avatars/retarget/joint_map.h"
#include "avatars/retarget/world_pose.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

using Eigen::Quaterniond;

/// What to write for a file whose joints have other names or axes.
std::string remedy(const SkeletalMotion& motion)
{
    return cmu_joints(motion.skeleton).missing.empty()
               ? "write \"map\": \"cmu\""
               : "write \"map\" with a JSON file that maps its joints";
}

void require_names(const SkinnedAvatar& body, const SkeletalMotion& motion, const Clip& clip)
{
    std::vector<std::string> names;
    for (const Joint& joint : body.model().skeleton.joints())
        names.push_back(joint.name);
    size_t found = 0;
    std::string unknown, nearest;
    for (const JointTrack& track : clip.tracks) {
        const std::string& name = motion.skeleton.joints()[size_t(track.joint)].name;
        if (body.model().skeleton.find(name) >= 0)
            ++found;
        else if (nearest.empty()) {
            nearest = nearest_word(name, names);
            if (unknown.empty() || !nearest.empty())
                unknown = name;
        }
    }
    if (2 * found >= clip.tracks.size())
        return;
    throw InvalidInput(motion.source + ": clip '" + clip.name + "' moves " +
                       std::to_string(clip.tracks.size()) + " joints, of which " + body.source() + " has " +
                       std::to_string(found) + "; no '" + unknown + "'" +
                       (nearest.empty() ? "" : ", the nearest is '" + nearest + "'") + "; " + remedy(motion));
}

class ClipCopy {
public:
    ClipCopy(const SkinnedAvatar& body, const SkeletalMotion& motion, const Clip& clip)
        : body_(body), skeleton_(body.model().skeleton), motion_(motion), clip_(clip),
          source_of_(map_by_names(skeleton_, motion))
    {
        require_same_axes();
        length_ratio_ = length_ratio();
    }

    Clip result() const
    {
        Clip clip{clip_.name, clip_.duration};
        std::vector<const JointTrack*> track_of(size_t(motion_.skeleton.size()), nullptr);
        for (const JointTrack& track : clip_.tracks)
            track_of[size_t(track.joint)] = &track;
        for (int j = 0; j < skeleton_.size(); ++j) {
            const int s = source_of_[size_t(j)];
            if (s < 0)
                continue;
            if (is_top(j))
                clip.tracks.push_back(track_in_world(j));
            else if (const JointTrack* track = track_of[size_t(s)])
                clip.tracks.push_back(scaled(*track, j));
        }
        return clip;
    }

private:
    const Joint& joint(int j) const { return skeleton_.joints()[size_t(j)]; }
    const Joint& source(int j) const { return motion_.skeleton.joints()[size_t(source_of_[size_t(j)])]; }

    /// True if no joint above has the name of one of the motion.
    bool is_top(int j) const
    {
        for (int above = joint(j).parent; above >= 0; above = joint(above).parent)
            if (source_of_[size_t(above)] >= 0)
                return false;
        return true;
    }

    bool has_same_parent(int j) const
    {
        return joint(j).parent >= 0 && source(j).parent >= 0 &&
               source_of_[size_t(joint(j).parent)] == source(j).parent;
    }

    /// Bones from joints with the same parent, as offsets in the parent: of the body, and of the motion.
    std::vector<std::pair<int, std::pair<Vec3, Vec3>>> bones() const
    {
        std::vector<std::pair<int, std::pair<Vec3, Vec3>>> result;
        for (int j = 0; j < skeleton_.size(); ++j)
            if (source_of_[size_t(j)] >= 0 && has_same_parent(j))
                result.push_back({j, {joint(j).rest.translation, source(j).rest.translation}});
        return result;
    }

    /// Compares the directions of bones in their parents, which no pose changes.
    void require_same_axes() const
    {
        constexpr double kCosine = 0.7; // [-] of 45 degrees: bodies differ by less, conventions by 90
        size_t compared = 0, other = 0;
        int first = -1;
        for (const auto& [j, offsets] : bones()) {
            const double lengths = offsets.first.norm() * offsets.second.norm();
            if (!(lengths > 0.0))
                continue;
            ++compared;
            if (offsets.first.dot(offsets.second) < kCosine * lengths) {
                ++other;
                first = first < 0 ? j : first;
            }
        }
        if (2 * other > compared)
            throw InvalidInput(motion_.source + ": its bones have other axes than those of " +
                               body_.source() + ", such as '" + joint(first).name + "' in '" +
                               joint(joint(first).parent).name + "'; " + remedy(motion_));
    }

    /// Length of the body's bones over those of the motion's. [-]
    double length_ratio() const
    {
        double of_body = 0.0, of_motion = 0.0;
        for (const auto& [j, offsets] : bones()) {
            of_body += offsets.first.norm();
            of_motion += offsets.second.norm();
        }
        const double ratio = of_body / of_motion;
        return std::isfinite(ratio) && ratio > 0.0 ? ratio : 1.0;
    }

    JointTrack scaled(const JointTrack& track, int j) const
    {
        JointTrack result = track;
        result.joint = j;
        for (Key<Vec3>& key : result.translation.keys)
            key.value *= length_ratio_;
        for (Tangents<Vec3>& tangent : result.translation.tangents) {
            tangent.in *= length_ratio_;
            tangent.out *= length_ratio_;
        }
        const Vec3 scale = joint(j).rest.scale.cwiseQuotient(source(j).rest.scale);
        for (Key<Vec3>& key : result.scale.keys)
            key.value = key.value.cwiseProduct(scale);
        for (Tangents<Vec3>& tangent : result.scale.tangents) {
            tangent.in = tangent.in.cwiseProduct(scale);
            tangent.out = tangent.out.cwiseProduct(scale);
        }
        return result;
    }

    /// Track of a top joint: its motion in the world, in its parent, which stands still.
    JointTrack track_in_world(int j) const
    {
        const WorldPose rest = rest_world_pose(skeleton_, identity_affine());
        const int parent = joint(j).parent;
        std::vector<Affine> frames(size_t(skeleton_.size()));
        const std::vector<JointTransform> rest_pose = skeleton_.rest_pose();
        joint_frames(skeleton_, rest_pose, frames);
        const Affine parent_from_world = parent < 0 ? identity_affine() : inverse(frames[size_t(parent)]);
        const Quaterniond parent_rotation =
            parent < 0 ? Quaterniond::Identity() : rest.rotation[size_t(parent)];

        const double ratio = world_ratio();
        JointTrack track{j};
        std::vector<JointTransform> local(size_t(motion_.skeleton.size()));
        const size_t s = size_t(source_of_[size_t(j)]);
        for (const double time : refined(key_times(clip_))) {
            sample(clip_, motion_.skeleton, time, local);
            const WorldPose pose = world_pose(motion_.skeleton, local, identity_affine());
            track.rotation.keys.push_back(
                {time, (parent_rotation.conjugate() * pose.rotation[s]).normalized()});
            track.translation.keys.push_back({time, apply(parent_from_world, ratio * pose.position[s])});
        }
        return track;
    }

    /// Lengths in the world of the body over those of the motion: the ratio of bones, with the scales above
    /// them. [-]
    double world_ratio() const
    {
        const WorldPose body = rest_world_pose(skeleton_, identity_affine());
        const WorldPose motion = rest_world_pose(motion_.skeleton, identity_affine());
        double of_body = 0.0, of_motion = 0.0;
        for (const auto& [j, offsets] : bones()) {
            of_body += (body.position[size_t(j)] - body.position[size_t(joint(j).parent)]).norm();
            of_motion +=
                (motion.position[size_t(source_of_[size_t(j)])] - motion.position[size_t(source(j).parent)])
                    .norm();
        }
        const double ratio = of_body / of_motion;
        return std::isfinite(ratio) && ratio > 0.0 ? ratio : 1.0;
    }

    const SkinnedAvatar& body_;
    const Skeleton& skeleton_;
    const SkeletalMotion& motion_;
    const Clip& clip_;
    std::vector<int> source_of_;
    double length_ratio_ = 1.0;
};

} // namespace

Clip copy_clip(const SkinnedAvatar& body, const SkeletalMotion& motion, const Clip& clip)
{
    require_names(body, motion, clip);
    return ClipCopy(body, motion, clip).result();
}

} // namespace toile::avatars
