#include <gtest/gtest.h>

#include <random>

#include "avatars/import/gltf_import.h"
#include "core/base/error.h"
#include "tests/avatars/column.h"

namespace toile::test {

using namespace avatars;

namespace {

/// Textbook linear blend skinning: 4x4 matrices, parents by recursion, no shared code.
class TextbookSkinning {
public:
    TextbookSkinning(const RiggedModel& model, const Clip& clip, double time)
        : model_(model), clip_(clip), time_(time)
    {
    }

    Vec3 vertex(int v) const
    {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        const SkinnedMesh& mesh = model_.mesh;
        for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k) {
            const Bone& bone = mesh.bones[mesh.influences[k].bone];
            Eigen::Matrix4d offset = Eigen::Matrix4d::Identity();
            offset.topRows<3>() = bone.joint_from_mesh;
            sum += mesh.influences[k].weight *
                   (global(bone.joint) * offset * mesh.rest.positions[v].homogeneous());
        }
        return sum.head<3>() / sum.w();
    }

private:
    template <typename Value, typename Mix>
    static Value value_at(const Track<Value>& track, double time, const Value& rest, Mix mix)
    {
        const std::vector<Key<Value>>& keys = track.keys;
        if (keys.empty())
            return rest;
        for (size_t i = 0; i + 1 < keys.size(); ++i)
            if (time >= keys[i].time && time <= keys[i + 1].time)
                return mix(keys[i].value, keys[i + 1].value,
                           (time - keys[i].time) / (keys[i + 1].time - keys[i].time));
        return time < keys.front().time ? keys.front().value : keys.back().value;
    }

    Eigen::Matrix4d global(int joint) const
    {
        const Joint& j = model_.skeleton.joints()[joint];
        JointTransform local = j.rest;
        const auto line = [](const Vec3& a, const Vec3& b, double t) -> Vec3 { return a + t * (b - a); };
        const auto arc = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double t) {
            // Rotation by t times the angle of the relative rotation.
            const Eigen::AngleAxisd whole(a.inverse() * b);
            return Eigen::Quaterniond(a * Eigen::AngleAxisd(t * whole.angle(), whole.axis()));
        };
        for (const JointTrack& track : clip_.tracks)
            if (track.joint == joint) {
                local.translation = value_at(track.translation, time_, local.translation, line);
                local.rotation = value_at(track.rotation, time_, local.rotation, arc);
                local.scale = value_at(track.scale, time_, local.scale, line);
            }
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        transform.translate(local.translation).rotate(local.rotation).scale(local.scale);
        return j.parent < 0 ? transform.matrix() : Eigen::Matrix4d(global(j.parent) * transform.matrix());
    }

    const RiggedModel& model_;
    const Clip& clip_;
    double time_;
};

void expect_like_textbook(RiggedModel model, int vertex_step)
{
    const RiggedModel copy = model;
    SkinnedAvatar avatar("test", std::move(model));
    for (size_t c = 0; c < copy.clips.size(); ++c)
        for (const double fraction : {0.0, 0.13, 0.5, 0.97}) {
            const double time = fraction * copy.clips[c].duration;
            const std::vector<Vec3> x = posed(avatar, {int(c), time});
            const TextbookSkinning oracle(copy, copy.clips[c], time);
            for (int v = 0; v < avatar.vertex_count(); v += vertex_step)
                ASSERT_LT((x[v] - oracle.vertex(v)).norm(), 1e-12)
                    << "vertex " << v << " at " << time << " s";
        }
}

/// Min and max over vertices of the sum of weights.
std::pair<double, double> weight_sums(const SkinnedMesh& mesh)
{
    std::pair<double, double> range{1e300, -1e300};
    for (int v = 0; v < mesh.rest.vertex_count(); ++v) {
        double sum = 0.0;
        for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k)
            sum += mesh.influences[k].weight;
        range = {std::min(range.first, sum), std::max(range.second, sum)};
    }
    return range;
}

} // namespace

TEST(Skinning, AgreesWithTheTextbookOnTheColumn) { expect_like_textbook(import_gltf(column_file()), 1); }

TEST(Skinning, AgreesWithTheTextbookOnAScannedBody)
{
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / "avatars/mh_woman.glb";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no avatars/mh_woman.glb";
    expect_like_textbook(import_gltf(file), 97);
}

TEST(Skinning, BoneRotationMovesItsRigidPart)
{
    RiggedModel model = import_gltf(column_file());
    const std::vector<Vec3> rest = model.mesh.rest.positions;
    SkinnedAvatar avatar("column", std::move(model));
    const std::vector<Vec3> x = posed(avatar, {avatar.clip_index("bend"), 1.0});
    for (int v = 0; v < avatar.vertex_count(); ++v) {
        const Vec3& r = rest[v];
        const Vec3 rotated(-(r.y() - 0.5), 0.5 + r.x(), r.z());
        if (r.y() > 0.9)
            EXPECT_LT((x[v] - rotated).norm(), 1e-6) << "the tip's ring turns about the tip";
        else if (r.y() < 0.1)
            EXPECT_LT((x[v] - r).norm(), 1e-12) << "the base's ring stays";
        else
            EXPECT_LT((x[v] - (5.0 * r + 4.0 * rotated) / 9.0).norm(), 1e-6)
                << "the middle ring blends 5 : 4";
    }
}

TEST(Skinning, ScalesStoredWeightsToOne)
{
    const auto [min_sum, max_sum] = weight_sums(import_gltf(column_file()).mesh);
    EXPECT_NEAR(min_sum, 1.0, 1e-14);
    EXPECT_NEAR(max_sum, 1.0, 1e-14);
}

TEST(Skinning, RefusesAVertexWithoutWeight)
{
    SkinnedMesh mesh;
    mesh.rest.positions.resize(2);
    mesh.first = {0, 1, 2};
    mesh.influences = {{0, 1.0}, {0, 0.0}};
    try {
        normalise_weights(mesh, "doll.glb");
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("doll.glb: vertex 1 has no bone weight"), std::string::npos);
    }
}

TEST(WeldSeams, JoinsBorderVerticesAndAveragesTheirWeights)
{
    // Two triangles with a common edge in space but not in indices.
    SkinnedMesh mesh;
    mesh.rest.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.rest.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.space_of_vertex.assign(6, 0);
    mesh.bones.resize(2);
    for (int v = 0; v < 6; ++v) {
        mesh.influences.push_back({v < 3 ? 0 : 1, 1.0});
        mesh.first.push_back(v + 1);
    }
    weld_seams(mesh, 1e-9);
    ASSERT_EQ(mesh.rest.vertex_count(), 4);
    EXPECT_EQ(mesh.rest.triangles[1], Triangle(1, 3, 2));
    ASSERT_EQ(mesh.first[2] - mesh.first[1], 2);
    EXPECT_DOUBLE_EQ(mesh.influences[mesh.first[1]].weight, 0.5);
    EXPECT_DOUBLE_EQ(mesh.influences[mesh.first[1] + 1].weight, 0.5);
}

TEST(WeldSeams, KeepsVerticesApartWhoseEdgeWouldGetThreeTriangles)
{
    SkinnedMesh mesh;
    mesh.rest.positions = {{0, 0, 0},  {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0},
                           {0, -1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    mesh.rest.triangles = {{0, 1, 2}, {4, 3, 5}, {6, 7, 8}};
    mesh.space_of_vertex.assign(9, 0);
    mesh.bones.resize(1);
    for (int v = 0; v < 9; ++v) {
        mesh.influences.push_back({0, 1.0});
        mesh.first.push_back(v + 1);
    }
    weld_seams(mesh, 1e-9);
    EXPECT_EQ(mesh.rest.vertex_count(), 9);
}

TEST(Skeleton, NamesTheNearestJointWhenOneIsMissing)
{
    Skeleton skeleton;
    skeleton.add({"left_elbow", -1, {}});
    try {
        skeleton.require("left_elbo", "walk.fbx: clip 'walk'");
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("walk.fbx: clip 'walk': no joint 'left_elbo'"), std::string::npos) << message;
        EXPECT_NE(message.find("'left_elbow'"), std::string::npos) << message;
    }
}

} // namespace toile::test
