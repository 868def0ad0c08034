#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "tests/apps/program.h"

namespace toile {
namespace {

/// A cache of the small scene's sheet: the start positions, changed by `change(frame, positions)`.
template <typename Change>
void write_cache(const TemporaryFolder& folder, int frames, const Change& change)
{
    folder.write("drop.json", small_scene(1));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    const std::vector<Vec3> start = read_cache(folder.path() / "sheet.pc2").frame(0);
    CacheLayout layout;
    layout.vertex_count = int(start.size());
    layout.frame_count = frames;
    const auto writer = make_cache_writer(folder.path() / "changed.pc2", layout);
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<Vec3> positions = start;
        change(frame, positions);
        writer->write(frame, positions);
    }
    writer->finish();
}

nlohmann::json certificate(const TemporaryFolder& folder, int exit_code)
{
    const Finished run = run_toile(
        {"check", "changed.pc2", "--scene", "drop.json", "-o", "check.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, exit_code) << run.errors;
    return nlohmann::json::parse(bytes_of(folder.path() / "check.json"));
}

TEST(Check, CertifiesClothAtRestAboveABall)
{
    const TemporaryFolder folder;
    write_cache(folder, 3, [](int, std::vector<Vec3>&) {});
    const auto found = certificate(folder, 0);
    EXPECT_EQ(found["frames"], 3);
    EXPECT_EQ(found["max_penetration_m"], 0.0);
    EXPECT_NEAR(found["max_strain"], 0.0, 1e-5);
    EXPECT_EQ(found["non_finite"], 0);
    EXPECT_TRUE(found["first_bad_frame"].is_null());
}

TEST(Check, MeasuresDepthInsideTheBall)
{
    // Lowered by 0.08 m to y = 0.17: the middle lies 0.03 m inside the ball of radius 0.2.
    const TemporaryFolder folder;
    write_cache(folder, 3, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() -= frame == 2 ? 0.08 : 0.0;
    });
    const auto found = certificate(folder, 1);
    EXPECT_NEAR(found["max_penetration_m"], 0.03, 1e-6);
    EXPECT_EQ(found["max_penetration_frame"], 2);
    EXPECT_EQ(found["first_bad_frame"], 2);
}

TEST(Check, MeasuresStrain)
{
    const TemporaryFolder folder;
    write_cache(folder, 2, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.z() *= frame == 1 ? 1.25 : 1.0;
    });
    const auto found = certificate(folder, 1);
    EXPECT_NEAR(found["max_strain"], 0.25, 1e-5);
    EXPECT_EQ(found["first_bad_frame"], 1);
}

TEST(Check, CountsNumbersThatAreNotFinite)
{
    const TemporaryFolder folder;
    write_cache(folder, 4, [](int frame, std::vector<Vec3>& x) {
        if (frame >= 2)
            x[5].x() = std::nan("");
    });
    const auto found = certificate(folder, 1);
    EXPECT_EQ(found["non_finite"], 2);
    EXPECT_EQ(found["first_bad_frame"], 2);
}

} // namespace
} // namespace toile
