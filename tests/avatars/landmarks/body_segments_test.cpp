#include <gtest/gtest.h>

#include <fstream>
#include <iostream>

#include <set>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include "tests/avatars/landmarks/bodies.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace avatars;

namespace {

constexpr const char* kNames[] = {"torso", "neck", "left arm", "right arm", "left leg", "right leg"};

const std::vector<std::string>& bodies()
{
    static const std::vector<std::string> kBodies{"mannequin",
                                                  "avatars/mh_woman.glb",
                                                  "avatars/mh_man.glb",
                                                  "avatars/gc_mean_all.glb",
                                                  "avatars/arnaud.fbx",
                                                  "avatars/cesium_man.gltf",
                                                  "bodies/gc_mean_all.obj",
                                                  "bodies/smpl_f_template.obj"};
    return kBodies;
}

const AxisSegment& of(const BodyArrangement& body, BodyPart part) { return body.segments[size_t(part)]; }

/// Largest distance of a segment's skin from its axis between its ends [m].
double girth_radius(const AxisSegment& segment)
{
    double radius = 0.0;
    for (const Vec3& x : segment.skin) {
        const double t = segment.axis().dot(x - segment.start);
        if (t > 0.1 * segment.length() && t < 0.6 * segment.length())
            radius = std::max(radius, (x - segment.start - t * segment.axis()).norm());
    }
    return radius;
}

Vec3 mirrored(const Vec3& x, const BodyLandmarks& body)
{
    return x - 2.0 * body.left().dot(x - body.crotch) * body.left();
}

} // namespace

TEST(BodySegments, LimbsLieOnTheirSidesOfSymmetricalBodies)
{
    for (const std::string& name : bodies()) {
        if (name != "mannequin" && !has_data())
            GTEST_SKIP() << "no " << TOILE_DATA_DIR;
        const BodyArrangement body = find_segments(*load_body(name), {}, identity_affine());
        const BodyLandmarks& marks = body.landmarks;
        // cesium_man's bind pose faces +X, all others +Z; left is to the left of that.
        const Vec3 front = name == "avatars/cesium_man.gltf" ? Vec3::UnitX() : Vec3::UnitZ();
        EXPECT_GT(marks.front.dot(front), 0.999) << name;
        EXPECT_GT(marks.left().dot(Vec3::UnitY().cross(front)), 0.999) << name;
        for (const auto& [left, right] : {std::pair(BodyPart::LeftArm, BodyPart::RightArm),
                                          std::pair(BodyPart::LeftLeg, BodyPart::RightLeg)}) {
            EXPECT_GT(marks.left().dot(of(body, left).start - of(body, right).start), 0.05) << name;
            EXPECT_LT((mirrored(of(body, left).start, marks) - of(body, right).start).norm(), 0.04) << name;
            EXPECT_LT((mirrored(of(body, left).end, marks) - of(body, right).end).norm(), 0.04) << name;
        }
        for (size_t s = 0; s < body.segments.size(); ++s) {
            const AxisSegment& segment = body.segments[s];
            EXPECT_NEAR(segment.front.norm(), 1.0, 1e-9) << name << ", " << kNames[s];
            EXPECT_NEAR(segment.front.dot(segment.axis()), 0.0, 1e-9) << name << ", " << kNames[s];
            EXPECT_GT(segment.front.dot(marks.front), 0.8) << name << ", " << kNames[s];
            EXPECT_GT(segment.skin.size(), 20u) << name << ", " << kNames[s];
        }
        // Thighs are thicker than arms, the trunk is thicker than both.
        const double arm = girth_radius(of(body, BodyPart::LeftArm)),
                     leg = girth_radius(of(body, BodyPart::LeftLeg));
        EXPECT_LT(arm, 0.14) << name << ", with its elbow, which is bent";
        EXPECT_GT(arm, 0.02) << name;
        EXPECT_LT(leg, 0.15) << name;
        EXPECT_GT(girth_radius(of(body, BodyPart::Torso)), leg) << name;
    }
}

TEST(BodySegments, SkeletonAndSlicesAgree)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    // The body that both ways are wanted for first, and those whose joints lie elsewhere in the limbs.
    for (const auto& [name, within] :
         {std::pair("avatars/gc_mean_all.glb", 0.03), std::pair("avatars/mh_woman.glb", 0.03),
          std::pair("avatars/mh_man.glb", 0.035), std::pair("avatars/cesium_man.gltf", 0.035),
          std::pair("mannequin", 0.06), std::pair("avatars/arnaud.fbx", 0.06)}) {
        const BodyArrangement by_bones = find_segments(*load_body(name), {}, identity_affine());
        const BodyArrangement by_slices = find_segments_by_slices(*load_body(name), {}, identity_affine());
        for (size_t s = 0; s < by_bones.segments.size(); ++s) {
            EXPECT_LT((by_bones.segments[s].start - by_slices.segments[s].start).norm(), within)
                << name << ", " << kNames[s];
            EXPECT_LT((by_bones.segments[s].end - by_slices.segments[s].end).norm(), within)
                << name << ", " << kNames[s];
        }
    }
}

/// The body comes with lists of the vertices of each limb, made by others.
TEST(BodySegments, SkinOfLimbsIsThatOfThePublishedSegmentation)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    std::ifstream file(std::filesystem::path(TOILE_DATA_DIR) / "bodies/gc_body_segmentation.json");
    const nlohmann::json published = nlohmann::json::parse(file);
    for (const char* name : {"bodies/gc_mean_all.obj", "avatars/gc_mean_all.glb"}) {
        const std::unique_ptr<Avatar> body = load_body("bodies/gc_mean_all.obj");
        const std::vector<Vec3> x = bind_pose(*body).positions;
        const BodyArrangement found = find_segments(*load_body(name), {}, identity_affine());
        for (const auto& [part, key] :
             {std::pair(BodyPart::LeftArm, "left_arm"), std::pair(BodyPart::RightArm, "right_arm"),
              std::pair(BodyPart::LeftLeg, "left_leg"), std::pair(BodyPart::RightLeg, "right_leg")}) {
            size_t common = 0;
            for (const int v : published[key])
                for (const Vec3& skin : of(found, part).skin)
                    if ((skin - x[size_t(v)]).norm() < 1e-5) {
                        ++common;
                        break;
                    }
            const double of_theirs = double(common) / double(published[key].size());
            const double of_ours = double(common) / double(of(found, part).skin.size());
            std::cout << name << ", " << key << ": " << of_theirs << " of theirs, " << of_ours
                      << " of ours\n";
            EXPECT_GT(of_theirs, 0.85) << name << ", " << key;
            EXPECT_GT(of_ours, 0.85) << name << ", " << key;
        }
    }
}

TEST(BodySegments, BodyThatFacesAnotherWayTurnsItsSegments)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const BodyArrangement straight =
        find_segments(*load_body("bodies/smpl_f_template.obj"), {}, identity_affine());
    for (const double angle : {0.5 * M_PI, M_PI, -0.5 * M_PI}) {
        Affine turn = Affine::Zero();
        turn.leftCols<3>() = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
        turn.col(3) = Vec3(0.3, 1.2, -4.0);
        const BodyArrangement turned = find_segments(*load_body("bodies/smpl_f_template.obj"), {}, turn);
        for (size_t s = 0; s < turned.segments.size(); ++s) {
            EXPECT_LT((turned.segments[s].start - apply(turn, straight.segments[s].start)).norm(), 0.01)
                << kNames[s];
            EXPECT_LT((turned.segments[s].end - apply(turn, straight.segments[s].end)).norm(), 0.01)
                << kNames[s];
            EXPECT_GT(turned.segments[s].front.dot(turn.leftCols<3>() * straight.segments[s].front), 0.99);
        }
    }
}

TEST(BodySegments, BonesTellLimbsInAnyPose)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const std::unique_ptr<Avatar> body = load_body("avatars/gc_mean_all.glb");
    const int dance = body->clip_index("dance");
    const BodyArrangement bind = find_segments(*body, {}, identity_affine());
    for (const double time : {4.0, 8.0, 12.0}) {
        const BodyArrangement posed = find_segments(*body, {dance, time}, identity_affine());
        for (size_t s = 0; s < posed.segments.size(); ++s) {
            // Arms and legs bend: the axis gets shorter, never longer.
            const double ratio = posed.segments[s].length() / bind.segments[s].length();
            EXPECT_LT(ratio, 1.1) << kNames[s] << " at " << time;
            EXPECT_GT(ratio, 0.3) << kNames[s] << " at " << time;
        }
        EXPECT_EQ(of(posed, BodyPart::LeftArm).skin.size(), of(bind, BodyPart::LeftArm).skin.size());
    }
}

TEST(BodySegments, NinetyDegreesAreLeftOfAHangingArmAndAboveAStretchedOne)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const BodyArrangement body =
        find_segments(*load_body("bodies/smpl_f_template.obj"), {}, identity_affine());
    EXPECT_GT(of(body, BodyPart::Torso).left().x(), 0.99);
    EXPECT_GT(of(body, BodyPart::LeftArm).left().y(), 0.99);
    EXPECT_LT(of(body, BodyPart::RightArm).left().y(), -0.99);
}

TEST(BodySegments, WhatIsNoBodyIsRefusedInOneLine)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    for (const auto& [name, part] :
         {std::pair("colliders/spot_triangulated.obj",
                    "two legs can't be found: a slice at 10 % of the height has 4 parts"),
          std::pair("colliders/ipc_torus.obj", "two legs can't be found"),
          std::pair("garments/mh_woman_skirt.obj", "two legs can't be found"),
          std::pair("avatars/rigged_simple.gltf",
                    "left arm, right arm, left leg, right leg, neck, head can't be found")}) {
        const std::string message =
            refusal([&file = name] { find_segments(*load_body(file), {}, identity_affine()); });
        EXPECT_NE(message.find(part), std::string::npos) << name << ": " << message;
        EXPECT_NE(message.find(name), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(BodySegments, GivenLandmarksReplaceThoseFound)
{
    if (!has_data())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const Vec3 wrist(0.5, 1.1, 0.1);
    for (const char* name : {"bodies/gc_mean_all.obj", "avatars/gc_mean_all.glb"}) {
        const BodyArrangement found = find_segments(*load_body(name), {}, identity_affine());
        const BodyArrangement told =
            find_segments(*load_body(name), {}, identity_affine(), {{"left_wrist", wrist}});
        EXPECT_EQ(of(told, BodyPart::LeftArm).start, wrist);
        EXPECT_EQ(of(told, BodyPart::LeftArm).end, of(found, BodyPart::LeftArm).end);
    }
    // Told that it faces its left, the body is taken at its word: its limbs are no longer beside each other.
    EXPECT_NE(refusal([&] {
                  find_segments(*load_body("bodies/gc_mean_all.obj"), {}, identity_affine(),
                                {{"front", {1, 0, 0}}});
              }),
              "");
    const Vec3 front = Vec3(0.1, 0.0, 1.0).normalized();
    EXPECT_LT((find_segments(*load_body("bodies/gc_mean_all.obj"), {}, identity_affine(), {{"front", front}})
                   .landmarks.front -
               front)
                  .norm(),
              1e-9);
    // A body in which nothing is found, told whole.
    const GivenLandmarks all{{"neck_top", {0, 0.6, -0.3}},        {"neck_base", {0, 0.4, -0.2}},
                             {"crotch", {0, -0.4, 0.3}},          {"left_shoulder", {0.2, 0, -0.1}},
                             {"left_wrist", {0.2, -0.7, -0.1}},   {"left_leg_top", {0.2, -0.3, 0.8}},
                             {"left_ankle", {0.2, -0.7, 0.8}},    {"right_shoulder", {-0.2, 0, -0.1}},
                             {"right_wrist", {-0.2, -0.7, -0.1}}, {"right_leg_top", {-0.2, -0.3, 0.8}},
                             {"right_ankle", {-0.2, -0.7, 0.8}}};
    const BodyArrangement cow =
        find_segments(*load_body("colliders/spot_triangulated.obj"), {}, identity_affine(), all);
    EXPECT_EQ(of(cow, BodyPart::RightLeg).start, Vec3(-0.2, -0.7, 0.8));
    for (const AxisSegment& segment : cow.segments)
        EXPECT_GT(segment.skin.size(), 20u);
}

TEST(BodySegments, LandmarkFilesAreChecked)
{
    const std::filesystem::path file = process_folder() / "landmarks.json";
    const auto read = [&](const std::string& text) {
        std::ofstream(file) << text;
        return refusal([&] { read_landmarks(file); });
    };
    EXPECT_EQ(read(R"({"crotch": [0, 0.8, 0.02], "front": [0, 0, 1]})"), "");
    EXPECT_EQ(read_landmarks(file).at("crotch"), Vec3(0, 0.8, 0.02));
    EXPECT_NE(read(R"({"left_wrst": [0, 0, 0]})").find("did you mean 'left_wrist'"), std::string::npos);
    EXPECT_NE(read(R"({"crotch": [0, 0]})").find("crotch: is [0,0]; give [x, y, z] in metres"),
              std::string::npos);
    EXPECT_NE(read(R"({"crotch": [0, 1e9, 0]})").find("crotch: is"), std::string::npos);
    EXPECT_NE(read(R"({"front": [0, 1, 0]})").find("vertical"), std::string::npos);
    EXPECT_NE(read("[1, 2]").find("no JSON object"), std::string::npos);
    EXPECT_NE(read("{").find("no JSON object"), std::string::npos);
    EXPECT_NE(refusal([] { read_landmarks("nowhere.json"); }).find("can't be read"), std::string::npos);
}

} // namespace toile::test
