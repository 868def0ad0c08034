#include "avatars/mannequin/rig.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mesh/topology.h"

namespace toile::avatars {

namespace {

using Weights = std::array<double, kMannequinJointCount>;

/// Passes that average each vertex's weights with their mean over its neighbours. Each widens a joint by
/// about one edge.
constexpr int kDiffusionPasses = 4;

constexpr int kMaxBones = 4;

/// Weights below this are noise of the diffusion and are dropped [-].
constexpr double kMinWeight = 0.01;

/// 0 below low, 1 above high, smooth between; low may be larger than high.
double ramp(double value, double low, double high)
{
    const double u = std::clamp((value - low) / (high - low), 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

/// Transfers a fraction of one joint's weight to another.
void transfer_weight(Weights& weights, int from, int to, double fraction)
{
    weights[to] += fraction * weights[from];
    weights[from] *= 1.0 - fraction;
}

Weights weights_at(const MannequinShape& shape, const Vec3& p)
{
    Weights weights{};
    weights[kPelvis] = 1.0;
    const bool left = p.x() >= 0.0;
    const Vec3 q(std::abs(p.x()), p.y(), p.z());

    // Blend weights up the trunk.
    transfer_weight(weights, kPelvis, kSpine, ramp(p.y(), 0.98, 1.09));
    transfer_weight(weights, kSpine, kChest, ramp(p.y(), 1.11, 1.23));
    transfer_weight(weights, kChest, kNeck, ramp(p.y(), 1.44, 1.50));
    transfer_weight(weights, kNeck, kHead, ramp(p.y(), 1.53, 1.57));

    // Blend weights down the leg: from the groin up to the hip bone outside, half each in the middle.
    const int thigh = left ? kThighL : kThighR;
    const double groin = p.y() - 0.25 * (q.x() - 0.09);
    transfer_weight(weights, kPelvis, thigh, ramp(groin, 0.97, 0.80) * ramp(q.x(), -0.01, 0.03));
    const double s_leg = shape.leg().along(q);
    transfer_weight(weights, thigh, thigh + 1, ramp(s_leg, kKnee - 0.05, kKnee + 0.05));
    transfer_weight(weights, thigh + 1, thigh + 2, ramp(s_leg, kAnkle - 0.045, kAnkle + 0.005));

    // Blend weights down the arm.
    const int upper_arm = left ? kUpperArmL : kUpperArmR;
    const double arm = ramp(shape.trunk_distance(p) - shape.arm_distance(p), -0.035, 0.035);
    for (const int trunk :
         {kPelvis, kSpine, kChest, kNeck, kHead, kThighL, kShinL, kFootL, kThighR, kShinR, kFootR})
        transfer_weight(weights, trunk, upper_arm, arm);
    const double s_arm = shape.arm().along(q);
    transfer_weight(weights, upper_arm, upper_arm + 1, ramp(s_arm, kElbow - 0.035, kElbow + 0.035));
    transfer_weight(weights, upper_arm + 1, upper_arm + 2, ramp(s_arm, kWrist - 0.02, kWrist + 0.025));
    return weights;
}

void diffuse(std::vector<Weights>& weights, const std::vector<Edge>& edges)
{
    std::vector<Weights> sum;
    std::vector<int> neighbours(weights.size(), 0);
    for (const Edge& edge : edges)
        for (const int v : edge.vertex)
            ++neighbours[v];
    for (int pass = 0; pass < kDiffusionPasses; ++pass) {
        sum.assign(weights.size(), Weights{});
        for (const Edge& edge : edges)
            for (int j = 0; j < kMannequinJointCount; ++j) {
                sum[edge.vertex[0]][j] += weights[edge.vertex[1]][j];
                sum[edge.vertex[1]][j] += weights[edge.vertex[0]][j];
            }
        for (size_t v = 0; v < weights.size(); ++v)
            for (int j = 0; j < kMannequinJointCount; ++j)
                weights[v][j] = 0.5 * weights[v][j] + 0.5 * sum[v][j] / neighbours[v];
    }
}

/// Influences of the heaviest bones of one vertex.
std::vector<Influence> heaviest(const Weights& weights)
{
    std::vector<Influence> parts;
    for (int j = 0; j < kMannequinJointCount; ++j)
        if (weights[j] >= kMinWeight)
            parts.push_back({j, weights[j]});
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    if (int(parts.size()) > kMaxBones)
        parts.resize(kMaxBones);
    return parts;
}

Vec3 mirror(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

} // namespace

Skeleton make_mannequin_skeleton(const MannequinShape& shape)
{
    struct Row {
        const char* name;
        int parent;
        Vec3 position; ///< [m]
    };
    const Vec3 shoulder = shape.shoulder(), elbow = shape.arm().center(kElbow),
               wrist = shape.arm().center(kWrist);
    const Vec3 hip = shape.hip(), knee = shape.leg().center(kKnee), ankle = shape.leg().center(kAnkle);
    const std::array<Row, kMannequinJointCount> rows{{
        {"pelvis", -1, {0.0, 0.930, 0.0}},
        {"spine", kPelvis, {0.0, 1.040, -0.010}},
        {"chest", kSpine, {0.0, 1.170, -0.015}},
        {"neck", kChest, {0.0, 1.455, -0.018}},
        {"head", kNeck, {0.0, 1.550, 0.005}},
        {"upper_arm_l", kChest, shoulder},
        {"lower_arm_l", kUpperArmL, elbow},
        {"hand_l", kLowerArmL, wrist},
        {"upper_arm_r", kChest, mirror(shoulder)},
        {"lower_arm_r", kUpperArmR, mirror(elbow)},
        {"hand_r", kLowerArmR, mirror(wrist)},
        {"thigh_l", kPelvis, hip},
        {"shin_l", kThighL, knee},
        {"foot_l", kShinL, ankle},
        {"thigh_r", kPelvis, mirror(hip)},
        {"shin_r", kThighR, mirror(knee)},
        {"foot_r", kShinR, mirror(ankle)},
    }};

    Skeleton skeleton;
    for (const Row& row : rows) {
        Joint joint{row.name, row.parent, {}};
        joint.rest.translation =
            row.parent < 0 ? row.position : Vec3(row.position - rows[row.parent].position);
        skeleton.add(std::move(joint));
    }
    return skeleton;
}

SkinnedMesh bind_mannequin(const MannequinShape& shape, const Skeleton& skeleton, TriangleMesh mesh)
{
    std::vector<Weights> weights;
    for (const Vec3& p : mesh.positions)
        weights.push_back(weights_at(shape, p));
    diffuse(weights, build_topology(mesh.triangles, mesh.vertex_count(), "mannequin").edges);

    SkinnedMesh skin;
    std::vector<Affine> frames(skeleton.size());
    const std::vector<JointTransform> rest = skeleton.rest_pose();
    joint_frames(skeleton, rest, frames);
    for (int j = 0; j < skeleton.size(); ++j)
        skin.bones.push_back({j, inverse(frames[j])});
    for (const Weights& row : weights) {
        const std::vector<Influence> parts = heaviest(row);
        skin.influences.insert(skin.influences.end(), parts.begin(), parts.end());
        skin.first.push_back(int(skin.influences.size()));
    }
    skin.space_of_vertex.assign(mesh.positions.size(), 0);
    skin.rest = std::move(mesh);
    normalise_weights(skin, "mannequin");
    return skin;
}

} // namespace toile::avatars
