#include "avatars/retarget/retarget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "avatars/retarget/clip_times.h"
#include "avatars/retarget/foot_soles.h"
#include "avatars/retarget/reference_pose.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

using Eigen::Quaterniond;

/// Pose of the body at a key.
struct BodyKey {
    double time = 0.0;                 ///< [s] of the source
    std::vector<Quaterniond> rotation; ///< [body joints] G D_s G^T; identity without source
    Vec3 travel = Vec3::Zero();        ///< of the root, in the body's axes [m]
};

class Retargeting {
public:
    Retargeting(const RiggedModel& body, const BodyJoints& limbs, const SkeletalMotion& motion,
                const Clip& clip, const JointMap& source_of, const WorldPose& reference)
        : body_(body), limbs_(limbs), motion_(motion), clip_(clip), source_of_(source_of),
          bind_(rest_world_pose(body.skeleton, body.metres_from_file)), rest_(reference),
          reference_(reference_pose(body.skeleton, bind_, limbs, rest_, source_of, motion.source)),
          root_(root_joint())
    {
    }

    Clip result()
    {
        read_keys();
        face_front();
        Clip clip{clip_.name, keys_.back().time - keys_.front().time, empty_tracks()};
        std::vector<Vec3> root_path;
        for (const BodyKey& key : keys_) {
            add_rotations(key, clip);
            root_path.push_back(bind_root() + key.travel);
        }
        if (root_ >= 0) {
            stand_on_floor(clip, root_path);
            add_root_path(root_path, clip);
        }
        return clip;
    }

private:
    bool is_driven(int joint) const { return source_of_[size_t(joint)] >= 0; }
    int parent_of(int joint) const { return body_.skeleton.joints()[size_t(joint)].parent; }
    Vec3 bind_root() const { return root_ < 0 ? Vec3(Vec3::Zero()) : bind_.position[size_t(root_)]; }

    /// The driven joint above all others; -1 if there is none, as of a motion of the arms alone.
    int root_joint() const
    {
        int root = -1;
        std::vector<char> below(size_t(body_.skeleton.size()), 0);
        for (int j = 0; j < body_.skeleton.size(); ++j) {
            const bool is_below = parent_of(j) >= 0 && below[size_t(parent_of(j))];
            if (is_driven(j) && !is_below) {
                if (root >= 0)
                    return -1;
                root = j;
            }
            below[size_t(j)] = is_below || is_driven(j);
        }
        return root;
    }

    /// Samples the source.
    void read_keys()
    {
        std::vector<double> times = key_times(clip_);
        if (begins_in_reference_pose(times))
            times.erase(times.begin());
        for (const double time : refined(times))
            keys_.push_back(key_at(time));
    }

    BodyKey key_at(double time) const
    {
        std::vector<JointTransform> local(size_t(motion_.skeleton.size()));
        sample(clip_, motion_.skeleton, time, local);
        const WorldPose pose = world_pose(motion_.skeleton, local, identity_affine());
        const Quaterniond& G = reference_.body_from_motion;
        BodyKey key{time, std::vector<Quaterniond>(source_of_.size(), Quaterniond::Identity())};
        for (size_t j = 0; j < source_of_.size(); ++j)
            if (const int s = source_of_[j]; s >= 0)
                key.rotation[j] =
                    G * pose.rotation[size_t(s)] * rest_.rotation[size_t(s)].conjugate() * G.conjugate();
        if (root_ >= 0)
            key.travel = reference_.metres_per_unit * (G * pose.position[size_t(source_of_[size_t(root_)])]);
        return key;
    }

    /// True for a first key in the reference pose, from which the motion jumps: many files of motion capture
    /// have one.
    bool begins_in_reference_pose(const std::vector<double>& times) const
    {
        if (times.size() < 3)
            return false;
        constexpr double kStill = 0.15; // [rad]
        constexpr double kJump = 15.0;  // [rad/s] which no joint reaches from rest
        const BodyKey first = key_at(times[0]), second = key_at(times[1]);
        double from_reference = 0.0, jump = 0.0;
        for (size_t j = 0; j < source_of_.size(); ++j) {
            from_reference =
                std::max(from_reference, first.rotation[j].angularDistance(Quaterniond::Identity()));
            jump = std::max(jump, first.rotation[j].angularDistance(second.rotation[j]));
        }
        return from_reference < kStill && jump > kJump * (times[1] - times[0]) && jump > kStill;
    }

    /// Turns the whole motion so that the root faces as in the bind pose first, and begins at its place.
    void face_front()
    {
        const Vec3 start = keys_.front().travel;
        const Vec3 forward =
            root_ < 0 ? reference_.front : Vec3(keys_.front().rotation[size_t(root_)] * reference_.front);
        const Vec3 level(forward.x(), 0.0, forward.z());
        constexpr double kLying = 0.1; // [-] a body that faces up or down has no heading
        const bool has_heading = level.norm() > kLying && std::abs(reference_.front.y()) < kLying;
        const double angle =
            has_heading ? std::atan2(level.cross(reference_.front).y(), level.dot(reference_.front)) : 0.0;
        const Quaterniond Q(Eigen::AngleAxisd(angle, Vec3::UnitY()));
        for (BodyKey& key : keys_) {
            key.travel = Q * Vec3(key.travel - start);
            for (size_t j = 0; j < source_of_.size(); ++j)
                if (source_of_[j] >= 0)
                    key.rotation[j] = Q * key.rotation[j];
        }
    }

    std::vector<JointTrack> empty_tracks() const
    {
        std::vector<JointTrack> tracks;
        for (int j = 0; j < body_.skeleton.size(); ++j)
            if (is_driven(j))
                tracks.push_back({j});
        return tracks;
    }

    /// Rotations of the driven joints in their parents.
    void add_rotations(const BodyKey& key, Clip& clip) const
    {
        const double time = key.time - keys_.front().time;
        const Quaterniond root = rotation_of(body_.metres_from_file);
        std::vector<Quaterniond> world;
        auto track = clip.tracks.begin();
        for (int j = 0; j < body_.skeleton.size(); ++j) {
            const Quaterniond parent = parent_of(j) < 0 ? root : world[size_t(parent_of(j))];
            if (!is_driven(j)) {
                world.push_back(parent * body_.skeleton.joints()[size_t(j)].rest.rotation);
                continue;
            }
            world.push_back(key.rotation[size_t(j)] * reference_.reference_from_bind[size_t(j)] *
                            bind_.rotation[size_t(j)]);
            (track++)->rotation.keys.push_back({time, (parent.conjugate() * world.back()).normalized()});
        }
    }

    /// Raises or lowers the root's path until the feet touch the floor of the bind pose.
    void stand_on_floor(const Clip& clip, std::vector<Vec3>& root_path) const
    {
        const FootSoles soles(body_, limbs_);
        if (soles.empty())
            return;
        // Lowest point of the feet over the floor. A few hundred poses tell where a motion stands.
        constexpr size_t kPoses = 400;
        const size_t step = 1 + root_path.size() / kPoses;
        std::vector<double> heights;
        std::vector<JointTransform> local(size_t(body_.skeleton.size()));
        for (size_t k = 0; k < root_path.size(); k += step) {
            sample(clip, body_.skeleton, clip.tracks.front().rotation.keys[k].time, local);
            const std::vector<Affine> frames = frames_in_world(body_, local);
            const double rise = root_path[k].y() - frames[size_t(root_)](1, 3);
            heights.push_back(rise + soles.height(frames));
        }

        // A tenth of them may be lower: bodies of other proportions and captured steps sink into the floor.
        const auto rank = heights.begin() + std::ptrdiff_t(heights.size() / 10);
        std::nth_element(heights.begin(), rank, heights.end());
        for (Vec3& x : root_path)
            x.y() -= *rank;
    }

    /// Translation of the root in its parent, which stands still.
    void add_root_path(const std::vector<Vec3>& root_path, Clip& clip) const
    {
        std::vector<Affine> frames(size_t(body_.skeleton.size()));
        const std::vector<JointTransform> rest = body_.skeleton.rest_pose();
        joint_frames(body_.skeleton, rest, frames);
        const Affine world_from_parent =
            parent_of(root_) < 0 ? body_.metres_from_file
                                 : compose(body_.metres_from_file, frames[size_t(parent_of(root_))]);
        const Affine parent_from_world = inverse(world_from_parent);
        JointTrack& track = clip.tracks.front(); // the root is the first driven joint
        for (size_t k = 0; k < root_path.size(); ++k)
            track.translation.keys.push_back(
                {track.rotation.keys[k].time, apply(parent_from_world, root_path[k])});
    }

    const RiggedModel& body_;
    const BodyJoints& limbs_;
    const SkeletalMotion& motion_;
    const Clip& clip_;
    const JointMap& source_of_;
    WorldPose bind_;        ///< of the body [m]
    const WorldPose& rest_; ///< reference pose of the motion
    ReferencePose reference_;
    int root_;
    std::vector<BodyKey> keys_;
};

} // namespace

Clip retarget(const RiggedModel& body, const BodyJoints& limbs, const SkeletalMotion& motion,
              const Clip& clip, const JointMap& source_of, const WorldPose& reference)
{
    if (std::all_of(source_of.begin(), source_of.end(), [](int source) { return source < 0; }))
        throw InvalidInput(motion.source + ": no joint of the body has a source; map one at least");
    return Retargeting(body, limbs, motion, clip, source_of, reference).result();
}

} // namespace toile::avatars
