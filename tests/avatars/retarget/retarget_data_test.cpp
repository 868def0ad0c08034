#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "avatars/load_avatar.h"
#include "avatars/retarget/add_motion.h"
#include "avatars/retarget/world_pose.h"
#include "core/base/error.h"
#include "tests/avatars/column.h"

/// Motions of the data set on its bodies.
namespace toile::test {

namespace {

using Eigen::Quaterniond;

std::filesystem::path data_file(const std::string& name)
{
    return std::filesystem::path(TOILE_DATA_DIR) / "avatars" / name;
}

bool has_data() { return std::filesystem::exists(data_file("mh_woman.glb")); }

/// A body with a motion from a file of its own.
class Moved {
public:
    Moved(const std::string& body, const std::string& motion, const std::string& map)
    {
        AvatarSettings settings;
        settings.file = data_file(body);
        avatar_ = load_avatar(settings);
        clip = add_motion(*avatar_, {data_file(motion), "", map});
    }

    Avatar& avatar() { return *avatar_; }
    const RiggedModel& model() const { return dynamic_cast<const SkinnedAvatar&>(*avatar_).model(); }
    size_t joint(const std::string& name) const
    {
        return size_t(model().skeleton.require(name, "this test"));
    }
    double duration(const std::string& name) const
    {
        return avatar_->clips()[size_t(avatar_->clip_index(name))].duration;
    }

    WorldPose at(const std::string& name, double time) const
    {
        std::vector<JointTransform> local(size_t(model().skeleton.size()));
        sample(model().clips[size_t(avatar_->clip_index(name))], model().skeleton, time, local);
        return world_pose(model().skeleton, local, model().metres_from_file);
    }
    WorldPose at(double time) const { return at(clip, time); }
    WorldPose bind() const { return rest_world_pose(model().skeleton, model().metres_from_file); }

    Vec3 bone(const WorldPose& pose, const std::string& from, const std::string& to) const
    {
        return pose.position[joint(to)] - pose.position[joint(from)];
    }

    std::string clip;

private:
    std::unique_ptr<Avatar> avatar_;
};

double angle_deg(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / EIGEN_PI;
}

Quaterniond rotation(double angle_deg, const Vec3& axis)
{
    return Quaterniond(Eigen::AngleAxisd(angle_deg * EIGEN_PI / 180.0, axis));
}

/// Rotation about the vertical of one direction to another.
Quaterniond heading_between(const Vec3& from, const Vec3& to)
{
    return Quaterniond::FromTwoVectors(Vec3(from.x(), 0.0, from.z()), Vec3(to.x(), 0.0, to.z()));
}

/// A BVH file, evaluated by its definition alone: offsets and rotations in the order of the channels.
class Bvh {
public:
    explicit Bvh(const std::filesystem::path& file)
    {
        std::ifstream in(file);
        std::vector<int> open;
        std::string word;
        while (in >> word && word != "MOTION") {
            if (word == "ROOT" || word == "JOINT" || word == "End") {
                Node node;
                in >> node.name;
                node.parent = open.empty() ? -1 : open.back();
                node.is_end = word == "End";
                nodes_.push_back(node);
            } else if (word == "{") {
                open.push_back(int(nodes_.size()) - 1);
            } else if (word == "}") {
                open.pop_back();
            } else if (word == "OFFSET") {
                in >> nodes_.back().offset.x() >> nodes_.back().offset.y() >> nodes_.back().offset.z();
            } else if (word == "CHANNELS") {
                int count = 0;
                in >> count;
                nodes_.back().channels.resize(size_t(count));
                for (std::string& channel : nodes_.back().channels)
                    in >> channel;
            }
        }
        int frames = 0;
        in >> word >> frames >> word >> word >> frame_time;
        for (double value = 0.0; in >> value;)
            values_.push_back(value);
        channel_count_ = values_.size() / size_t(frames);
    }

    /// Positions of the joints by name.
    std::map<std::string, Vec3> at(int frame) const
    {
        const double* value = values_.data() + size_t(frame) * channel_count_;
        std::vector<Eigen::Affine3d> frames;
        std::map<std::string, Vec3> position;
        for (const Node& node : nodes_) {
            Eigen::Affine3d local = Eigen::Affine3d::Identity();
            local.translate(node.offset);
            for (const std::string& channel : node.channels) {
                const Vec3 axis = Vec3::Unit(channel[0] - 'X');
                if (channel.ends_with("position"))
                    local.translate(*value++ * axis);
                else
                    local.rotate(rotation(*value++, axis));
            }
            frames.push_back(node.parent < 0 ? local : frames[size_t(node.parent)] * local);
            if (!node.is_end)
                position[node.name] = frames.back().translation();
        }
        return position;
    }

    double frame_time = 0.0; ///< [s]

private:
    struct Node {
        std::string name;
        int parent = -1;
        bool is_end = false;
        Vec3 offset = Vec3::Zero();
        std::vector<std::string> channels;
    };
    std::vector<Node> nodes_;
    std::vector<double> values_;
    size_t channel_count_ = 0;
};

struct LimbBone {
    std::string from, to;         ///< on the body
    std::string bvh_from, bvh_to; ///< in cmu_131_02.bvh; cmu_01_01.bvh has the body's names
};

std::vector<LimbBone> limb_bones()
{
    std::vector<LimbBone> bones;
    for (const std::string s : {"Left", "Right"}) {
        bones.push_back({s + "Arm", s + "ForeArm", s + "Shoulder", s + "Elbow"});
        bones.push_back({s + "ForeArm", s + "Hand", s + "Elbow", s + "Wrist"});
        bones.push_back({s + "UpLeg", s + "Leg", s + "Hip", s + "Knee"});
        bones.push_back({s + "Leg", s + "Foot", s + "Knee", s + "Ankle"});
    }
    return bones;
}

} // namespace

/// The clip "dance" of mh_woman.glb was made from 55_01: sampled at 30 Hz without the first sample (four
/// frames of 120 Hz), after a blend of 1 s and a ramp of time of 1 s, which plays 0.5 s. Time 0 of the
/// retargeted clip is frame 1. So from 2 s on, time t there is t - 1 + 0.5 - 1 + 3 / 120 here.
///
/// Two things in it are not of the motion: its heading begins from frame 4 instead of 1, a constant rotation
/// about the vertical; and its arms were opened by 8 degrees about the axis in front of the chest (Spine1).
TEST(RetargetData, AgreesWithTheDanceOfTheBody)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    const Moved woman("mh_woman.glb", "55_01_cmu.fbx", "cmu");
    const std::vector<std::pair<std::string, std::string>> bones{{"Hips", "LeftUpLeg"},
                                                                 {"Hips", "RightUpLeg"},
                                                                 {"Hips", "LowerBack"},
                                                                 {"LowerBack", "Spine"},
                                                                 {"Spine", "Spine1"},
                                                                 {"Spine1", "Neck"},
                                                                 {"Neck", "Neck1"},
                                                                 {"Neck1", "Head"},
                                                                 {"Spine1", "LeftShoulder"},
                                                                 {"LeftUpLeg", "LeftLeg"},
                                                                 {"LeftLeg", "LeftFoot"},
                                                                 {"LeftFoot", "LeftToeBase"},
                                                                 {"RightUpLeg", "RightLeg"},
                                                                 {"RightLeg", "RightFoot"},
                                                                 {"RightFoot", "RightToeBase"},
                                                                 {"LeftArm", "LeftForeArm"},
                                                                 {"LeftForeArm", "LeftHand"},
                                                                 {"LeftHand", "LeftFingerBase"},
                                                                 {"RightArm", "RightForeArm"},
                                                                 {"RightForeArm", "RightHand"},
                                                                 {"RightHand", "RightFingerBase"}};
    const auto here = [](double t) { return t - 1.5 + 3.0 / 120.0; };
    const auto hips = woman.joint("Hips");
    const auto forward = [&](const WorldPose& pose) { return Vec3(pose.rotation[hips] * Vec3::UnitZ()); };
    const Quaterniond heading =
        heading_between(forward(woman.at(here(2.0))), forward(woman.at("dance", 2.0)));
    EXPECT_LT(heading.angularDistance(Quaterniond::Identity()) * 180.0 / EIGEN_PI, 3.0);

    double trunk_and_legs = 0.0, arms_as_they_are = 0.0, arms_closed = 0.0;
    int samples = 0;
    for (double t = 2.0; t < woman.duration("dance"); t += 0.1, ++samples) {
        const WorldPose own = woman.at("dance", t), pose = woman.at(here(t));
        const Quaterniond chest = own.rotation[woman.joint("Spine1")];
        for (const auto& [from, to] : bones) {
            const Vec3 expected = woman.bone(own, from, to);
            const Vec3 found = heading * woman.bone(pose, from, to);
            const bool is_arm =
                from.find("Arm") != std::string::npos || from.find("Hand") != std::string::npos;
            if (!is_arm) {
                trunk_and_legs = std::max(trunk_and_legs, angle_deg(expected, found));
                continue;
            }
            const double opening = from.starts_with("Left") ? 8.0 : -8.0;
            const Vec3 closed = chest * (rotation(-opening, Vec3::UnitZ()) * (chest.conjugate() * expected));
            arms_as_they_are = std::max(arms_as_they_are, angle_deg(expected, found));
            arms_closed = std::max(arms_closed, angle_deg(closed, found));
        }
    }
    EXPECT_GT(samples, 140);
    EXPECT_LT(trunk_and_legs, 0.5);
    EXPECT_LT(arms_closed, 0.5);
    EXPECT_GT(arms_as_they_are, 7.0); // the opening is there
    EXPECT_LT(arms_as_they_are, 8.01);
    RecordProperty("trunk_and_legs_deg", std::to_string(trunk_and_legs));
    RecordProperty("arms_closed_deg", std::to_string(arms_closed));
    RecordProperty("arms_as_they_are_deg", std::to_string(arms_as_they_are));
}

/// Bodies follow BVH files of both naming schemes: the directions of their arms and legs, and the travel of
/// the hips scaled by the lengths of the legs.
TEST(RetargetData, FollowsBvhFilesOfBothSchemes)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    for (const bool is_second : {false, true}) {
        const std::string file = is_second ? "cmu_131_02.bvh" : "cmu_01_01.bvh";
        const Bvh bvh(data_file(file));
        const int first = is_second ? 0 : 1; // after the T-pose
        for (const std::string body : {"mh_man.glb", "gc_mean_all.glb"}) {
            const Moved man(body, file, "cmu");
            const auto bone_at = [&](const std::map<std::string, Vec3>& frame, const LimbBone& bone) {
                return Vec3(is_second ? frame.at(bone.bvh_to) - frame.at(bone.bvh_from)
                                      : frame.at(bone.to) - frame.at(bone.from));
            };
            // The heading is that of the first pose, told by a thigh.
            const WorldPose start = man.at(0.0);
            const std::map<std::string, Vec3> source_start = bvh.at(first);
            const LimbBone thigh = limb_bones()[2];
            const Quaterniond heading =
                heading_between(bone_at(source_start, thigh), man.bone(start, thigh.from, thigh.to));

            double legs = 0.0, source_legs = 0.0;
            for (const LimbBone& bone : limb_bones())
                if (bone.from.find("Leg") != std::string::npos) {
                    legs += man.bone(start, bone.from, bone.to).norm();
                    source_legs += bone_at(source_start, bone).norm();
                }
            double worst = 0.0, farthest = 0.0;
            for (int frame = first; frame < 1200; frame += 37) {
                const WorldPose pose = man.at((frame - first) * bvh.frame_time);
                const std::map<std::string, Vec3> source = bvh.at(frame);
                for (const LimbBone& bone : limb_bones())
                    worst = std::max(worst, angle_deg(man.bone(pose, bone.from, bone.to),
                                                      heading * bone_at(source, bone)));
                const auto hips = man.joint("Hips");
                const Vec3 travel = pose.position[hips] - start.position[hips];
                const Vec3 expected =
                    legs / source_legs * (heading * (source.at("Hips") - source_start.at("Hips")));
                farthest = std::max(farthest, (travel - expected).norm());
            }
            EXPECT_LT(worst, 0.1) << file << " on " << body;      // [degrees]
            EXPECT_LT(farthest, 0.003) << file << " on " << body; // [m]
        }
    }
}

/// While a foot stands, its sole is level.
TEST(RetargetData, StandsOnFlatSoles)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    for (const char* file : {"07_01_cmu.fbx", "cmu_01_01.bvh", "cmu_131_02.bvh"}) {
        const Moved woman("mh_woman.glb", file, "cmu");
        const WorldPose bind = woman.bind();
        double tilt = 0.0;
        int standing = 0;
        for (double t = 0.0; t < woman.duration(woman.clip); t += 0.05) {
            const WorldPose pose = woman.at(t);
            for (const std::string side : {"Left", "Right"}) {
                const auto ankle = woman.joint(side + "Foot"), ball = woman.joint(side + "ToeBase");
                if (std::max(pose.position[ankle].y() - bind.position[ankle].y(),
                             pose.position[ball].y() - bind.position[ball].y()) > 0.04)
                    continue;
                ++standing;
                tilt += angle_deg(pose.rotation[ankle] * (bind.rotation[ankle].conjugate() * Vec3::UnitY()),
                                  Vec3::UnitY());
            }
        }
        EXPECT_GT(standing, 10) << file;
        EXPECT_LT(tilt / standing, 10.0) << file; // degrees; 20 if the legs of BVH files stayed spread
    }
}

TEST(RetargetData, ArnaudWalksUpright)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    for (const char* file : {"arnaud_anim_walk.fbx", "arnaud_anim_crossarms.fbx"}) {
        Moved arnaud("arnaud.fbx", file, "names");
        const int clip = arnaud.avatar().clip_index(arnaud.clip);
        double lowest = 1.0, highest_low = -1.0;
        for (double t = 0.0; t < arnaud.duration(arnaud.clip); t += 0.1) {
            const WorldPose pose = arnaud.at(t);
            const auto y = [&](const char* name) { return pose.position[arnaud.joint(name)].y(); };
            EXPECT_GT(y("Head"), y("Hips") + 0.5) << file << " at " << t;
            EXPECT_GT(y("Hips"), std::max(y("LeftFoot"), y("RightFoot")) + 0.4) << file << " at " << t;
            const Vec3 trunk = arnaud.bone(pose, "Hips", "Head");
            EXPECT_LT(angle_deg(trunk, Vec3::UnitY()), 20.0) << file << " at " << t;

            const std::vector<Vec3> skin = posed(arnaud.avatar(), {clip, t});
            const Bounds box = bounds(skin);
            EXPECT_NEAR(box.upper.y() - box.lower.y(), 1.8, 0.15) << file << " at " << t;
            lowest = std::min(lowest, box.lower.y());
            highest_low = std::max(highest_low, box.lower.y());
        }
        EXPECT_GT(lowest, -0.05) << file;
        EXPECT_LT(highest_low, 0.05) << file;
    }
}

TEST(RetargetData, RefusesMotionsOfOtherSkeletons)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    const std::vector<std::array<std::string, 4>> cases{
        {"mh_woman.glb", "arnaud_anim_walk.fbx", "names", "moves 75 joints, of which "},
        {"mh_woman.glb", "cmu_131_02.bvh", "names",
         "no 'LeftHip', the nearest is 'LeftLeg'; write \"map\": \"cmu\""},
        {"mh_woman.glb", "55_01_cmu.fbx", "names", "bones have other axes"},
        {"mh_woman.glb", "arnaud_anim_walk.fbx", "cmu", "has no joint 'LowerBack' of the CMU skeletons"},
        {"mh_woman.glb", "arnaud.fbx", "names", "arnaud.fbx: has no clip"},
        {"rigged_simple.gltf", "55_01_cmu.fbx", "cmu",
         "left arm, right arm, left leg, right leg, neck, head can't"}};
    for (const auto& [body, motion, map, says] : cases) {
        std::string message = "accepted";
        try {
            Moved(body, motion, map);
        } catch (const InvalidInput& error) {
            message = error.what();
        }
        EXPECT_NE(message.find(says), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

/// Bodies of other skeletons, with fewer and more joints in the spine, stand on the floor and are as tall as
/// they were.
TEST(RetargetData, DrivesSkeletonsOfOtherNames)
{
    if (!has_data())
        GTEST_SKIP() << "SKIPPED: no " << TOILE_DATA_DIR;
    for (const char* body : {"cesium_man.gltf", "arnaud.fbx", "mh_woman.glb", "gc_mean_all.glb"})
        for (const char* file : {"07_01_cmu.fbx", "cmu_131_02.bvh"}) {
            Moved moved(body, file, "cmu");
            const int clip = moved.avatar().clip_index(moved.clip);
            const Bounds bind = bounds(posed(moved.avatar(), {}));
            const double height = bind.upper.y() - bind.lower.y();
            int samples = 0, near_floor = 0;
            for (double t = 0.0; t < moved.duration(moved.clip); t += 0.1, ++samples) {
                const Bounds box = bounds(posed(moved.avatar(), {clip, t}));
                EXPECT_GT(box.upper.y() - box.lower.y(), 0.85 * height) << body << " " << file << " at " << t;
                EXPECT_LT(box.upper.y() - box.lower.y(), 1.10 * height) << body << " " << file << " at " << t;
                EXPECT_NEAR(box.lower.y(), bind.lower.y(), 0.08) << body << " " << file << " at " << t;
                near_floor += std::abs(box.lower.y() - bind.lower.y()) < 0.04 ? 1 : 0;
            }
            EXPECT_GT(near_floor, samples / 2) << body << " " << file;
        }
}

} // namespace toile::test
