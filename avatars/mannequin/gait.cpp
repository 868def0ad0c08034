#include "avatars/mannequin/gait.h"

#include <array>
#include <cmath>
#include <numbers>

#include "avatars/mannequin/rig.h"

namespace toile::avatars {

namespace {

constexpr double kPi = std::numbers::pi;

/// Keys per walk cycle. Joints rotate less than 15 degrees between keys.
constexpr int kKeysPerCycle = 40;

/// Angle of the hanging arm from the vertical while walking [degrees]; the arm is clear of the hips.
constexpr double kWalkingArmAngle = 18.0;

/// Height over which both feet share the floor in double support [m]; a smaller value makes the pelvis jerk.
constexpr double kFootBlend = 0.004;

/// A periodic angle [degrees] at ten equal steps of the cycle, which begins when the left heel lands.
using CycleTable = std::array<double, 10>;

constexpr CycleTable kHipFlexion{22, 20, 13, 3, -8, -16, -13, 4, 20, 25};
constexpr CycleTable kKneeFlexion{4, 12, 10, 5, 4, 20, 42, 60, 54, 20};
constexpr CycleTable kAnkleFlexion{0, -6, -2, 3, 11, 6, -12, -2, 6, 4};

/// Periodic cubic through the table (Catmull-Rom), phase in cycles.
double sample_cycle(const CycleTable& table, double phase)
{
    const double sample = (phase - std::floor(phase)) * table.size();
    const int i = int(sample) % int(table.size());
    const double t = sample - std::floor(sample);
    const auto at = [&](int k) { return table[(i + k + int(table.size())) % int(table.size())]; };
    const double slope1 = 0.5 * (at(1) - at(-1)), slope2 = 0.5 * (at(2) - at(0));
    return (1 + 2 * t) * (1 - t) * (1 - t) * at(0) + t * (1 - t) * (1 - t) * slope1 +
           t * t * (3 - 2 * t) * at(1) + t * t * (t - 1) * slope2;
}

Eigen::Quaterniond rotation(double degrees, const Vec3& axis)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kPi / 180.0, axis));
}

/// Joint rotations in their parents at one phase of the walk.
class WalkPose {
public:
    WalkPose(const Skeleton& skeleton, double arm_angle_deg, double phase)
        : skeleton_(skeleton), local_(skeleton.rest_pose())
    {
        const double angle = 2.0 * kPi * phase;
        const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

        // Rotate the pelvis with the leading leg and lower it on the swinging side; the chest
        // counter-rotates.
        const Eigen::Quaterniond pelvis =
            rotation(-6.0 * std::cos(angle), Y) * rotation(4.0 * std::sin(angle), Z);
        const Eigen::Quaterniond chest = rotation(5.0 * std::cos(angle), Y) * rotation(1.5, X);
        local_[kPelvis].rotation = pelvis;
        local_[kSpine].rotation = (pelvis.conjugate() * chest).slerp(0.5, Eigen::Quaterniond::Identity());
        local_[kChest].rotation = (pelvis * local_[kSpine].rotation).conjugate() * chest;
        local_[kHead].rotation = chest.conjugate();

        for (const bool left : {true, false}) {
            const double side = left ? 1.0 : -1.0;
            const double side_phase = left ? phase : phase + 0.5;

            // Legs hang from the pelvis in the world's sagittal plane, rotated inwards to a narrow track.
            const int thigh = left ? kThighL : kThighR;
            local_[thigh].rotation = pelvis.conjugate() *
                                     rotation(-sample_cycle(kHipFlexion, side_phase), X) *
                                     rotation(-2.5 * side, Z);
            local_[thigh + 1].rotation = rotation(sample_cycle(kKneeFlexion, side_phase), X);
            local_[thigh + 2].rotation = rotation(-sample_cycle(kAnkleFlexion, side_phase), X);

            // Arms swing against the legs.
            const int arm = left ? kUpperArmL : kUpperArmR;
            const double swing = -std::cos(2.0 * kPi * side_phase);
            local_[arm].rotation = chest.conjugate() * rotation(-(16.0 * swing - 3.0), X) *
                                   rotation((kWalkingArmAngle - arm_angle_deg) * side, Z);
            local_[arm + 1].rotation = rotation(-(12.0 + 8.0 * swing), X);
        }
    }

    /// Height of the lowest sole point, with the pelvis at rest height [m]. A soft minimum has no kink where
    /// the weight shifts to the other foot. It lies below the true one by up to kFootBlend log 6.
    double floor_height() const
    {
        std::vector<Affine> frames(skeleton_.size());
        joint_frames(skeleton_, local_, frames);
        double lowest = 1e300;
        std::array<double, 6> heights;
        int count = 0;
        for (const int foot : {kFootL, kFootR})
            for (const Vec3& sole : kSole) {
                heights[count] = apply(frames[foot], sole).y();
                lowest = std::min(lowest, heights[count++]);
            }
        double sum = 0.0;
        for (const double height : heights)
            sum += std::exp(-(height - lowest) / kFootBlend);
        return lowest - kFootBlend * std::log(sum);
    }

    /// Distance of the ankle in front of the pelvis [m].
    double ankle_ahead(int foot) const
    {
        std::vector<Affine> frames(skeleton_.size());
        joint_frames(skeleton_, local_, frames);
        return frames[foot].col(3).z() - frames[kPelvis].col(3).z();
    }

    const JointTransform& local(int joint) const { return local_[joint]; }

private:
    /// Positions of heel, ball and toe relative to the ankle joint [m].
    static inline const std::array<Vec3, 3> kSole{Vec3(0.0, -0.075, -0.045), Vec3(0.015, -0.075, 0.110),
                                                  Vec3(0.022, -0.073, 0.192)};

    const Skeleton& skeleton_;
    std::vector<JointTransform> local_;
};

} // namespace

Clip make_walk(const Skeleton& skeleton, double arm_angle_deg, double period, int cycles, bool advance)
{
    Clip clip{advance ? "walk" : "walk_in_place", cycles * period, {}};
    for (int j = 0; j < kMannequinJointCount; ++j)
        clip.tracks.push_back({j});

    // Compute the distance per cycle: two steps, each the distance between the feet when a heel lands.
    const WalkPose landing(skeleton, arm_angle_deg, 0.0);
    const double stride = 2.0 * (landing.ankle_ahead(kFootL) - landing.ankle_ahead(kFootR));

    const Vec3 pelvis_rest = skeleton.joints()[kPelvis].rest.translation;
    for (int key = 0; key <= cycles * kKeysPerCycle; ++key) {
        const double phase = double(key % kKeysPerCycle) / kKeysPerCycle;
        const double time = key * period / kKeysPerCycle;
        const WalkPose pose(skeleton, arm_angle_deg, phase);
        const double distance = advance ? stride * key / kKeysPerCycle : 0.0;
        const double sway = 0.012 * std::sin(2.0 * kPi * phase); // over the standing leg
        clip.tracks[kPelvis].translation.keys.push_back(
            {time, pelvis_rest + Vec3(sway, -pose.floor_height(), distance)});
        for (int j = 0; j < kMannequinJointCount; ++j)
            clip.tracks[j].rotation.keys.push_back({time, pose.local(j).rotation});
    }
    return clip;
}

Clip make_turn(double duration)
{
    constexpr int kKeys = 72;
    Clip clip{"turn", duration, {{kPelvis}}};
    for (int key = 0; key <= kKeys; ++key) {
        const double u = double(key) / kKeys;
        const double gone = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        clip.tracks.front().rotation.keys.push_back({u * duration, rotation(360.0 * gone, Vec3::UnitY())});
    }
    return clip;
}

} // namespace toile::avatars
