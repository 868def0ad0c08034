#include "scenes/colliders/skin_insets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include "avatars/load_avatar.h"
#include "collision/check/find_crossings.h"
#include "export/cache_writer.h"
#include "scenes/colliders/scene_body.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Pairs of triangles of a body that cross, but those of hands, feet and head: they are thinner than what
/// would have to give way.
/// @param surface  of a body with the faces of `body`, which has bones
int crossings(const SceneBody& body, const TriangleMesh& surface)
{
    int count = 0;
    for (const collision::Crossing& crossing :
         collision::find_crossings(surface.triangles, surface.positions)) {
        const std::string bone = body.bone_of(crossing.a);
        const auto is_of = [&](const char* part) { return bone.find(part) != std::string::npos; };
        if (!is_of("Hand") && !is_of("Head") && !is_of("Toe") && !is_of("Foot") && !is_of("Jaw"))
            ++count;
    }
    return count;
}

int crossings(const SceneBody& body) { return crossings(body, body.surface()); }

scene::Avatar walking(const std::string& file, scene::SelfContact self_contact)
{
    scene::Avatar settings;
    settings.name = "body";
    settings.shape = std::filesystem::path(TOILE_DATA_DIR) / "avatars" / file;
    settings.clip = "walk";
    settings.self_contact = self_contact;
    return settings;
}

class SkinInsetsOn : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override
    {
        if (!std::filesystem::exists(std::filesystem::path(TOILE_DATA_DIR) / "avatars" / GetParam()))
            GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no avatars/" << GetParam();
    }
};

TEST_P(SkinInsetsOn, UncrossSkinOfAWalk)
{
    SceneBody kept(walking(GetParam(), scene::SelfContact::Keep));
    SceneBody separated(walking(GetParam(), scene::SelfContact::Separate));
    int before = 0, after = 0;
    for (const double t : {1.3, 1.7, 2.11, 2.6, 3.3}) {
        kept.advance_to(t);
        separated.advance_to(t);
        before += crossings(kept);
        after += crossings(separated);
        double largest = 0.0;
        for (int v = 0; v < kept.surface().vertex_count(); ++v)
            largest = std::max(
                largest,
                (kept.surface().positions[size_t(v)] - separated.surface().positions[size_t(v)]).norm());
        EXPECT_LE(largest, collision::SkinSeparation::kMaxInset + 1e-9);
    }
    EXPECT_GT(before, 100);
    EXPECT_LE(after, before / 20); // some cross in the bind pose
}

/// The same walk without its bones: from a cache that begins with the bind pose.
TEST_P(SkinInsetsOn, UncrossSkinOfACache)
{
    constexpr int kSamples = 16;
    scene::Avatar standing = walking(GetParam(), scene::SelfContact::Keep);
    standing.clip.clear();
    SceneBody walker(walking(GetParam(), scene::SelfContact::Keep));
    const TemporaryFolder folder;
    exports::CacheLayout layout = exports::cache_layout(walker.surface(), kSamples);
    layout.fps = SkinInsets::kRate;
    const auto writer = exports::make_cache_writer(folder.path() / "walk.abc", layout);
    writer->write(0, SceneBody(standing).surface().positions);
    for (int k = 1; k < kSamples; ++k) {
        walker.advance_to(1.5 + k / layout.fps);
        writer->write(k, walker.surface().positions);
    }
    writer->finish();

    scene::Avatar cached;
    cached.name = "body";
    cached.shape = folder.path() / "walk.abc";
    SceneBody separated(cached);
    cached.self_contact = scene::SelfContact::Keep;
    SceneBody kept(cached);
    SceneBody rigged(walking(GetParam(), scene::SelfContact::Separate));
    int with_bones = 0;
    int before = 0, after = 0;
    for (const int k : {5, 8, 11}) {
        rigged.advance_to(1.5 + k / layout.fps);
        with_bones += crossings(rigged);
        kept.advance_to(k / layout.fps);
        separated.advance_to(k / layout.fps);
        before += crossings(walker, kept.surface());
        after += crossings(walker, separated.surface());
    }
    std::cout << before << " crossings, " << after << " after separation, " << with_bones << " with bones\n";
    EXPECT_GT(before, 50);
    EXPECT_LE(after, before / 20);
}

TEST_P(SkinInsetsOn, AreSmoothInTime)
{
    SceneBody kept(walking(GetParam(), scene::SelfContact::Keep));
    SceneBody separated(walking(GetParam(), scene::SelfContact::Separate));
    std::vector<Vec3> before;
    double fastest = 0.0;
    constexpr double kStep = 0.004;
    for (double t = 1.5; t < 1.7; t += kStep) {
        kept.advance_to(t);
        separated.advance_to(t);
        std::vector<Vec3> moved;
        for (size_t v = 0; v < kept.surface().positions.size(); ++v) {
            moved.push_back(separated.surface().positions[v] - kept.surface().positions[v]);
            if (!before.empty())
                fastest = std::max(fastest, std::abs(moved[v].norm() - before[v].norm()) / kStep);
        }
        before = std::move(moved);
    }
    // All of an inset in three samples.
    EXPECT_LE(fastest, collision::SkinSeparation::kMaxInset * SkinInsets::kRate / 3.0);
}

INSTANTIATE_TEST_SUITE_P(Bodies, SkinInsetsOn, ::testing::Values("mh_woman.glb", "gc_mean_all.glb"),
                         [](const auto& body) { return std::string(body.param).substr(0, 7); });

TEST(SkinInsets, DependOnTimeAlone)
{
    scene::Avatar settings = walking("mh_woman.glb", scene::SelfContact::Separate);
    if (!std::filesystem::exists(std::get<std::filesystem::path>(settings.shape)))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no avatars/mh_woman.glb";
    SceneBody stepped(settings), jumped(settings);
    for (const double t : {1.0, 1.3, 1.55, 1.9, 1.6})
        stepped.advance_to(t);
    jumped.advance_to(1.6);
    EXPECT_EQ(stepped.surface().positions, jumped.surface().positions);
}

} // namespace

} // namespace toile::test
