#include "scenes/drape/drape.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "collision/check/find_crossings.h"
#include "core/mesh/topology.h"
#include "garment/energy/fold/dihedral_angle.h"
#include "scenes/drape/seam_closing.h"
#include "tests/scenes/drape/tube_pattern.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

class DrapeTest : public ::testing::Test {
protected:
    DrapeResult drape_tube(const std::string& pattern)
    {
        return drape_file(folder_.write("tube.json", pattern));
    }

    DrapeResult drape_file(const std::filesystem::path& file)
    {
        DrapeSettings settings;
        settings.garment = file;
        settings.body.name = "body";
        settings.body.shape = scene::Capsule{0.1, 0.4};
        settings.fabric = "jersey";
        settings.edge = 0.03;
        settings.folder = folder_.path();
        settings.name = "tube";
        settings.max_motion = max_motion_;
        settings.progress = [&](const DrapeProgress& now) {
            moments_.push_back(now);
            if (now.stage == last_stage_ && now.time > 0.1)
                settings.time_limit = 0.0;
        };
        WorldOptions options;
        options.goes_on = [this] { return moments_.empty() || moments_.back().stage != cancelled_stage_; };
        return drape(settings, options);
    }

    TemporaryFolder folder_;
    double max_motion_ = 20.0;    ///< [s]
    std::string last_stage_;      ///< in which the time limit passes, after 0.1 s; empty: none
    std::string cancelled_stage_; ///< that the caller cancels; empty: none
    std::vector<DrapeProgress> moments_;
};

TEST_F(DrapeTest, SewsATubeAroundABodyAndHoldsIt)
{
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    EXPECT_EQ(result.pieces, 1);
    EXPECT_EQ(result.border_loops, 2);
    EXPECT_EQ(result.euler_characteristic, 0);
    ASSERT_EQ(result.seams.size(), 2u);
    for (const DrapeSeam& seam : result.seams)
        EXPECT_LT(seam.gap, SeamClosing::kMaxGap) << seam.name;
    EXPECT_LT(result.max_strain, 0.05);
    EXPECT_LE(result.rest_speed, 0.02);

    // It surrounds the body, and crosses nothing.
    const TriangleMesh mesh = result.surface.mesh.triangulated();
    EXPECT_TRUE(collision::find_crossings(mesh.triangles, mesh.positions).empty());
    for (const Vec3& x : mesh.positions) {
        EXPECT_GT(std::hypot(x.x(), x.z()), 0.1);
        EXPECT_LT(std::hypot(x.x(), x.z()), 0.16);
    }
    // Panels are groups, each on its side of the body.
    ASSERT_EQ(result.surface.mesh.groups.size(), 2u);
    EXPECT_EQ(result.surface.mesh.groups[0], (ObjGroup{0, "back"}));
    EXPECT_EQ(result.surface.mesh.groups[1], (ObjGroup{int(mesh.triangles.size() / 2), "front"}));
    double front = 0.0, back = 0.0; // sums of z [m]
    for (int t = 0; t < int(mesh.triangles.size()); ++t)
        for (const int v : mesh.triangles[size_t(t)])
            (t < result.surface.mesh.groups[1].first_polygon ? back : front) += mesh.positions[size_t(v)].z();
    EXPECT_GT(front / double(mesh.triangles.size()), 0.05);
    EXPECT_LT(back / double(mesh.triangles.size()), -0.05);
    // Both panels keep their texture coordinates along the seams.
    EXPECT_GT(result.surface.mesh.texture_coordinates.size(), result.surface.mesh.positions.size() + 8u);
}

/// Angle of a surface's fold, mean over its edges [rad].
double mean_angle(const GarmentSurface& surface, const scene::Fold& fold)
{
    const TriangleMesh mesh = surface.mesh.triangulated();
    const Topology topology = build_topology(mesh.triangles, int(mesh.positions.size()), "tube");
    double sum = 0.0;
    for (size_t i = 0; i + 1 < fold.vertices.size(); ++i) {
        const auto edge = std::find_if(topology.edges.begin(), topology.edges.end(), [&](const Edge& e) {
            return std::minmax(e.vertex[0], e.vertex[1]) ==
                   std::minmax(fold.vertices[i], fold.vertices[i + 1]);
        });
        const auto at = [&](int v) -> const Vec3& { return mesh.positions[size_t(v)]; };
        sum += garment::dihedral_angle(
            {at(edge->vertex[0]), at(edge->vertex[1]), at(edge->opposite[0]), at(edge->opposite[1])});
    }
    return sum / double(fold.vertices.size() - 1);
}

/// Two ridges away from the body, on a panel and along a seam.
TEST_F(DrapeTest, FoldsPanelsBeforeTheyAreSewnAndSeamsOnceTheyAre)
{
    folder_.write("tube.json", tube(0.36, "strapless_top"));
    const DrapeResult result = drape_file(folder_.write("tube.garment.json", R"({"toile_garment": 1,
        "patterns": [{"file": "tube.json"}],
        "seams": [{"a": ["front.1"], "b": ["back.3"], "fold_deg": -100}],
        "folds": [{"between": ["front.0[0.5]", "front.2[0.5]"], "angle_deg": -80}]})"));
    ASSERT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    std::vector<std::string> stages;
    for (const DrapeStage& stage : result.stages)
        stages.push_back(stage.name);
    EXPECT_EQ(stages, (std::vector<std::string>{"mesh", "fold", "sew", "press", "settle", "drape"}));

    const std::vector<scene::Fold>& folds = result.surface.folds;
    ASSERT_GT(folds.size(), 4u);
    EXPECT_EQ(result.scene.cloths[0].folds.size(), folds.size());
    EXPECT_NEAR(mean_angle(result.surface, folds[0]) * 180.0 / EIGEN_PI, -80.0, 10.0);
    double seam = 0.0;
    for (size_t f = 1; f < folds.size(); ++f)
        seam += mean_angle(result.surface, folds[f]) / double(folds.size() - 1);
    EXPECT_NEAR(seam * 180.0 / EIGEN_PI, -100.0, 10.0);
}

TEST_F(DrapeTest, HasNoStageForFoldsWhereThereAreNone)
{
    last_stage_ = "sew";
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"));
    EXPECT_EQ(moments_.front().stage, "sew");
    EXPECT_TRUE(result.surface.folds.empty());
}

TEST_F(DrapeTest, EndsAtItsTimeLimitWithTheLastState)
{
    last_stage_ = "settle";
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest);
    EXPECT_NE(result.message.find("in stage settle, after "), std::string::npos) << result.message;
    EXPECT_EQ(result.stages.back().name, "settle");
    EXPECT_GE(result.stages.back().frames, 4);
    EXPECT_GE(result.stages.back().steps, result.stages.back().frames);
    EXPECT_EQ(result.stages.back().vertices, int(result.surface.mesh.positions.size()));
    EXPECT_EQ(result.surface.mesh.groups.size(), 2u);
    EXPECT_EQ(result.seams.size(), 2u);
    // The tube surrounds the body by then; placed, its panels were 4 cm away from it.
    for (const Vec3& x : result.surface.mesh.positions)
        EXPECT_LT(std::hypot(x.x(), x.z()), 0.135);

    // Before its first sample a stage loads. Only stages of a known duration tell one.
    ASSERT_FALSE(moments_.empty());
    EXPECT_EQ(moments_.front().stage, "sew");
    EXPECT_EQ(moments_.front().time, 0.0);
    for (const DrapeProgress& now : moments_) {
        EXPECT_EQ(now.duration > 0.0, now.time > 0.0 && now.stage != "sew") << now.stage;
        EXPECT_LE(now.stage == "sew" ? 0.0 : now.time, now.duration + 1e-9);
    }
}

TEST_F(DrapeTest, IsCancelledByItsCaller)
{
    cancelled_stage_ = "press";
    EXPECT_THROW(drape_tube(tube(0.36, "strapless_top")), Cancelled);
    EXPECT_EQ(moments_.back().stage, "press");
}

TEST_F(DrapeTest, SaysThatALooseTubeSlidOff)
{
    const DrapeResult result = drape_tube(tube(0.40, "top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::SlidOff) << result.message;
    ASSERT_EQ(result.slides.size(), 1u);
    EXPECT_EQ(result.slides[0].label, "top");
    EXPECT_GT(result.slides[0].slid, kMaxSlide);
}

TEST_F(DrapeTest, DrapesAPanelWithoutSeams)
{
    std::string pattern = tube(0.36, "");
    const size_t stitches = pattern.find("\"stitches\": ["), end = pattern.find("]]}", stitches);
    pattern.replace(stitches, end + 2 - stitches, "\"stitches\": []");
    max_motion_ = 0.2;
    const DrapeResult result = drape_tube(pattern);
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest) << result.message; // the panels fall beside the body
    EXPECT_EQ(result.pieces, 2);
    EXPECT_TRUE(result.seams.empty());
}

TEST_F(DrapeTest, NamesASeamThatCannotClose)
{
    // Two panels of 16 cm around 63.
    const DrapeResult result = drape_tube(tube(0.16, "strapless_top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::Tangled);
    EXPECT_NE(result.message.find("stays open by"), std::string::npos) << result.message;
    EXPECT_FALSE(result.surface.mesh.lines.empty());
}

TEST_F(DrapeTest, SaysThatPanelsStartInTheBody)
{
    const DrapeResult result = drape_tube(tube(0.36, "", 0.0)); // the front panel in its middle
    EXPECT_EQ(result.outcome, DrapeOutcome::Placement);
    EXPECT_NE(result.message.find("can't be sewn from where they are placed"), std::string::npos)
        << result.message;
    EXPECT_FALSE(result.surface.mesh.positions.empty());
}

} // namespace

} // namespace toile::test
