#include "scenes/drape/drape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/check/find_crossings.h"
#include "core/base/error.h"
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
    /// @param keys  of a garment file; empty: the pattern by itself
    DrapeResult drape_tube(const std::string& pattern, const std::string& keys = "")
    {
        std::filesystem::path file = write("tube.json", pattern);
        if (!keys.empty())
            file = write("tube.garment.json",
                         R"({"toile_garment": 1, "patterns": [{"file": "tube.json"}], )" + keys + "}");
        return drape_files({{"tube", file}});
    }

    /// @param patterns  by name
    DrapeResult drape_tubes(const std::vector<std::pair<std::string, std::string>>& patterns)
    {
        std::vector<std::pair<std::string, std::filesystem::path>> files;
        files.reserve(patterns.size());
        for (const auto& [name, pattern] : patterns)
            files.emplace_back(name, write(name + ".json", pattern));
        return drape_files(files);
    }

    std::filesystem::path write(const std::string& name, const std::string& text) const
    {
        std::ofstream(folder_.path() / name) << text;
        return folder_.path() / name;
    }

    DrapeResult drape_files(const std::vector<std::pair<std::string, std::filesystem::path>>& files)
    {
        DrapeSettings settings;
        for (const auto& [name, file] : files)
            settings.garments.push_back({file, name, "jersey"});
        settings.body.name = "body";
        settings.body.shape = scene::Capsule{0.1, 0.4};
        settings.edge = 0.03;
        settings.folder = folder_.path();
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
    EXPECT_EQ(result.garments[0].pieces, 1);
    EXPECT_EQ(result.garments[0].border_loops, 2);
    EXPECT_EQ(result.garments[0].euler_characteristic, 0);
    ASSERT_EQ(result.garments[0].seams.size(), 2u);
    for (const DrapeSeam& seam : result.garments[0].seams)
        EXPECT_LT(seam.gap, SeamClosing::kMaxGap) << seam.name;
    EXPECT_LT(result.max_strain, 0.05);
    EXPECT_LE(result.rest_speed.value(), 0.02);

    // It surrounds the body, and crosses nothing.
    const TriangleMesh mesh = result.garments[0].surface.mesh.triangulated();
    EXPECT_TRUE(collision::find_crossings(mesh.triangles, mesh.positions).empty());
    for (const Vec3& x : mesh.positions) {
        EXPECT_GT(std::hypot(x.x(), x.z()), 0.1);
        EXPECT_LT(std::hypot(x.x(), x.z()), 0.16);
    }
    // Panels are groups, each on its side of the body.
    ASSERT_EQ(result.garments[0].surface.mesh.groups.size(), 2u);
    EXPECT_EQ(result.garments[0].surface.mesh.groups[0], (ObjGroup{0, "back"}));
    EXPECT_EQ(result.garments[0].surface.mesh.groups[1], (ObjGroup{int(mesh.triangles.size() / 2), "front"}));
    double front = 0.0, back = 0.0; // sums of z [m]
    for (int t = 0; t < int(mesh.triangles.size()); ++t)
        for (const int v : mesh.triangles[size_t(t)])
            (t < result.garments[0].surface.mesh.groups[1].first_polygon ? back : front) +=
                mesh.positions[size_t(v)].z();
    EXPECT_GT(front / double(mesh.triangles.size()), 0.05);
    EXPECT_LT(back / double(mesh.triangles.size()), -0.05);
    // Both panels keep their texture coordinates along the seams.
    EXPECT_GT(result.garments[0].surface.mesh.texture_coordinates.size(),
              result.garments[0].surface.mesh.positions.size() + 8u);
}

/// Distance of vertices from the axis of the body [m], mean of those in each of 12 sectors about it.
std::array<double, 12> sector_radii(View<const Vec3> x)
{
    std::array<double, 12> sums{}, counts{};
    for (const Vec3& p : x) {
        const double turn = std::atan2(p.x(), p.z()) / (2.0 * std::numbers::pi) + 0.5;
        const size_t sector = std::min(size_t(12.0 * turn), size_t(11));
        sums[sector] += std::hypot(p.x(), p.z());
        counts[sector] += 1.0;
    }
    for (size_t s = 0; s < sums.size(); ++s)
        sums[s] /= counts[s];
    return sums;
}

/// Both tubes are as narrow as the body: the second has to lie on the first everywhere.
TEST_F(DrapeTest, SewsASecondTubeOverTheFirst)
{
    const DrapeResult result =
        drape_tubes({{"inner", tube(0.33, "strapless_top")}, {"outer", tube(0.33, "strapless_top", 0.145)}});
    EXPECT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    ASSERT_EQ(result.garments.size(), 2u);
    TriangleMesh both = result.garments[0].surface.mesh.triangulated();
    const TriangleMesh outer = result.garments[1].surface.mesh.triangulated();
    const std::array<double, 12> radii = sector_radii(both.positions),
                                 outer_radii = sector_radii(outer.positions);
    for (size_t sector = 0; sector < radii.size(); ++sector)
        EXPECT_GT(outer_radii[sector], radii[sector] + 0.0002) << sector;

    const int first = int(both.positions.size());
    both.positions.insert(both.positions.end(), outer.positions.begin(), outer.positions.end());
    for (const Triangle& t : outer.triangles)
        both.triangles.push_back(t + Triangle::Constant(first));
    EXPECT_TRUE(collision::find_crossings(both.triangles, both.positions).empty());

    // The scene holds both, each by its own label.
    ASSERT_EQ(result.scene.cloths.size(), 2u);
    EXPECT_EQ(result.scene.cloths[0].name, "inner");
    EXPECT_EQ(result.scene.cloths[1].name, "outer");
    ASSERT_EQ(result.scene.attachments.size(), 2u);
    EXPECT_EQ(result.scene.attachments[0].cloth, "inner");
    EXPECT_EQ(result.scene.attachments[1].cloth, "outer");
    EXPECT_EQ(moments_.front().stage, "inner, sew");
    EXPECT_EQ(moments_.back().stage, "outer, drape");
}

/// The time limit passes in the second garment, whose state is kept beside that of the first.
TEST_F(DrapeTest, KeepsBothTubesAtItsTimeLimit)
{
    last_stage_ = "outer, settle";
    const DrapeResult result =
        drape_tubes({{"inner", tube(0.36, "strapless_top")}, {"outer", tube(0.42, "strapless_top", 0.16)}});
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest);
    EXPECT_NE(result.message.find("in stage outer, settle, after "), std::string::npos) << result.message;
    ASSERT_EQ(result.garments.size(), 2u);
    EXPECT_EQ(result.garments[0].stages.back().name, "drape");
    EXPECT_EQ(result.garments[1].stages.back().name, "settle");
    for (const DrapedGarment& garment : result.garments)
        EXPECT_EQ(garment.stages.back().vertices, int(garment.surface.mesh.positions.size())) << garment.name;
}

/// Length of the lower edge of a draped tube [m].
double hem_length(const DrapeResult& result)
{
    const ObjMesh& mesh = result.garments[0].surface.mesh;
    double length = 0.0;
    for (size_t t = 0; t < mesh.polygons.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const size_t next = (k + 1) % 3;
            const auto is_low = [&](size_t corner) {
                return mesh.texture_coordinates[size_t(mesh.polygon_uvs[t][corner])].y() < -0.0999;
            };
            if (is_low(k) && is_low(next))
                length += (mesh.positions[size_t(mesh.polygons[t][k])] -
                           mesh.positions[size_t(mesh.polygons[t][next])])
                              .norm();
        }
    return length;
}

TEST_F(DrapeTest, GathersAHemByAnElasticAndWritesIt)
{
    const DrapeResult loose = drape_tube(tube(0.36, "strapless_top")),
                      tight = drape_tube(tube(0.36, "strapless_top"), R"("elastics":
                          [{"edges": ["front.0", "back.0"], "ratio": 0.8, "stiffness": 20}])");
    EXPECT_EQ(tight.outcome, DrapeOutcome::Draped) << tight.message;
    EXPECT_NEAR(hem_length(loose), 0.72, 0.01);
    // The elastic has 0.576 m at rest and the body under it 0.628 m.
    EXPECT_LT(hem_length(tight), 0.67);
    EXPECT_GT(hem_length(tight), 0.61);

    EXPECT_TRUE(loose.scene.cloths[0].elastics.empty());
    ASSERT_EQ(tight.scene.cloths[0].elastics.size(), 2u);
    for (const scene::Elastic& elastic : tight.scene.cloths[0].elastics) {
        EXPECT_EQ(elastic.ratio, 0.8);
        EXPECT_EQ(elastic.stiffness, 20.0);
        EXPECT_EQ(elastic.vertices.size(), 13u) << "0.36 m in parts of 3 cm";
    }
}

/// The hem is drawn together in front of the body, where nothing is between both points.
TEST_F(DrapeTest, ClosesButtonsAndWritesThem)
{
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"), R"("closures": [
        {"a": "front.0[0.25]", "b": "front.0[0.75]"},
        {"a": "front[-0.06,-0.05]", "b": "front[0.06,-0.05]", "close_at": 1.2}])");
    ASSERT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    ASSERT_EQ(result.garments[0].closures.size(), 2u);
    for (const DrapeClosure& closure : result.garments[0].closures)
        EXPECT_LT(closure.gap, 0.002) << closure.name;
    EXPECT_EQ(result.garments[0].closures[1].name, "closures[1]");

    // What holds them is in the scene, closed from its start.
    const std::vector<scene::Tack>& tacks = result.scene.cloths[0].tacks;
    ASSERT_EQ(tacks.size(), 2u);
    const std::vector<Vec3>& x = result.garments[0].surface.mesh.positions;
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(tacks[i].close_at, 0.0);
        EXPECT_NEAR((x[size_t(tacks[i].a)] - x[size_t(tacks[i].b)]).norm(),
                    result.garments[0].closures[i].gap, 1e-12);
    }
    // The drape went on until the second had closed: settling takes a second at most.
    EXPECT_GT(result.garments[0].stages.back().frames, 0.2 * 30);
}

/// The body stands between the sides.
TEST_F(DrapeTest, SaysThatAClosureStaysOpen)
{
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"), R"("closures": [
        {"a": "front[-0.17,0]", "b": "front[0.17,0]", "close_at": 0.1}])");
    EXPECT_EQ(result.outcome, DrapeOutcome::Tangled);
    EXPECT_NE(result.message.find("the closure closures[0] stays open by "), std::string::npos)
        << result.message;
    ASSERT_EQ(result.garments[0].closures.size(), 1u);
    EXPECT_GT(result.garments[0].closures[0].gap, 0.1);
}

/// A loose tube, which slides off where nothing holds it.
TEST_F(DrapeTest, HoldsWhatIsAttachedAndWritesIt)
{
    const DrapeResult result = drape_tube(tube(0.40, ""), R"("attach": [
        {"edges": ["front.2", "back.2[0.25:0.75]"]}, {"points": ["back.0[0.5]"], "release": true}])");
    ASSERT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    ASSERT_EQ(result.scene.attachments.size(), 1u) << "the other one was released";
    EXPECT_EQ(result.scene.attachments[0].to, "body");
    const auto& vertices = std::get<std::vector<int>>(result.scene.attachments[0].select.by);
    EXPECT_EQ(vertices.size(), 22u) << "14 intervals of 40 cm, and 6 of their middle half";
    double mean = 0.0;
    for (const int v : vertices)
        mean += result.garments[0].surface.mesh.positions[size_t(v)].y() / double(vertices.size());
    EXPECT_NEAR(mean, 0.1, 0.01) << "where the upper edge started";
}

TEST_F(DrapeTest, ReleasesWhatIsAttachedForAWhile)
{
    max_motion_ = 1.0;
    const DrapeResult result =
        drape_tube(tube(0.40, ""), R"("attach": [{"edges": ["front.2", "back.2"], "release": true}])");
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest) << "it falls once it is released";
    EXPECT_GT(result.rest_speed.value(), 0.1);
}

/// A patch of 9 cm on the front of the tube, sewn along three of its sides.
TEST_F(DrapeTest, SewsAPocketOntoAPanel)
{
    write("pocket.json", R"({"pattern": {"panels": {"pocket": {
        "vertices": [[0, 0], [0.09, 0], [0.09, 0.09], [0, 0.09]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
        "rotation": [0, 0, 0], "translation": [-0.04, -0.05, 0.16]}}, "stitches": []},
        "properties": {"units_in_meter": 1}})");
    write("tube.json", tube(0.36, "strapless_top"));
    const DrapeResult result = drape_files({{"tube", write("tube.garment.json", R"({"toile_garment": 1,
        "patterns": [{"file": "tube.json"}, {"file": "pocket.json"}],
        "panels": {"front": {"lines": {"place": {"points":
            [[-0.04, 0.04], [-0.04, -0.05], [0.05, -0.05], [0.05, 0.04]]}}}},
        "seams": [{"a": ["front.place"], "b": ["pocket.3", "pocket.0", "pocket.1"], "join": "start-start"}]})")}});
    ASSERT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    const DrapedGarment& garment = result.garments[0];
    EXPECT_EQ(garment.pieces, 1);
    EXPECT_EQ(garment.border_loops, 3);
    ASSERT_EQ(garment.seams.size(), 3u);
    for (const DrapeSeam& seam : garment.seams)
        EXPECT_LT(seam.gap, SeamClosing::kMaxGap) << seam.name;

    // The pocket lies outside of the panel, and nothing crosses.
    const TriangleMesh mesh = garment.surface.mesh.triangulated();
    EXPECT_TRUE(collision::find_crossings(mesh.triangles, mesh.positions).empty());
    double farthest = 0.0;
    for (const Vec3& x : mesh.positions)
        farthest = std::max(farthest, std::hypot(x.x(), x.z()));
    EXPECT_LT(farthest, 0.16);
    const int branching = int(surface_topology(mesh.triangles).non_manifold_edges.size());
    EXPECT_EQ(branching, 9) << "three sides of three edges";
}

TEST_F(DrapeTest, SewsSeamsInTheirOrder)
{
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"), R"("seams": [
        {"a": ["front.1"], "b": ["back.3"], "order": 2}, {"a": ["front.3"], "b": ["back.1"], "order": 1}])");
    EXPECT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    ASSERT_EQ(result.garments[0].seams.size(), 2u);
    for (const DrapeSeam& seam : result.garments[0].seams)
        EXPECT_LT(seam.gap, SeamClosing::kMaxGap) << seam.name;
}

TEST_F(DrapeTest, ShrinksATubeOntoTheBody)
{
    // 0.648 m around 0.628 m, and 0.72 m before.
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"), R"("panels":
        {"front": {"shrink": {"weft": 0.9}}, "back": {"shrink": {"weft": 0.9}}})");
    EXPECT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    EXPECT_NEAR(hem_length(result), 0.648, 0.012);
    EXPECT_LT(result.max_strain, 0.05) << "measured against the shrunk shape";
    EXPECT_FALSE(result.garments[0].surface.rest.empty());
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
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"), R"(
        "seams": [{"a": ["front.1"], "b": ["back.3"], "fold_deg": -100}],
        "folds": [{"between": ["front.0[0.5]", "front.2[0.5]"], "angle_deg": -80}])");
    ASSERT_EQ(result.outcome, DrapeOutcome::Draped) << result.message;
    std::vector<std::string> stages;
    for (const DrapeStage& stage : result.garments[0].stages)
        stages.push_back(stage.name);
    EXPECT_EQ(stages, (std::vector<std::string>{"mesh", "fold", "sew", "press", "settle", "drape"}));

    const std::vector<scene::Fold>& folds = result.garments[0].surface.folds;
    ASSERT_GT(folds.size(), 4u);
    EXPECT_EQ(result.scene.cloths[0].folds.size(), folds.size());
    EXPECT_NEAR(mean_angle(result.garments[0].surface, folds[0]) * 180.0 / EIGEN_PI, -80.0, 10.0);
    double seam = 0.0;
    for (size_t f = 1; f < folds.size(); ++f)
        seam += mean_angle(result.garments[0].surface, folds[f]) / double(folds.size() - 1);
    EXPECT_NEAR(seam * 180.0 / EIGEN_PI, -100.0, 10.0);
}

TEST_F(DrapeTest, HasNoStageForFoldsWhereThereAreNone)
{
    last_stage_ = "sew";
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"));
    EXPECT_EQ(moments_.front().stage, "sew");
    EXPECT_TRUE(result.garments[0].surface.folds.empty());
}

TEST_F(DrapeTest, EndsAtItsTimeLimitWithTheLastState)
{
    last_stage_ = "settle";
    const DrapeResult result = drape_tube(tube(0.36, "strapless_top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest);
    EXPECT_NE(result.message.find("in stage settle, after "), std::string::npos) << result.message;
    EXPECT_EQ(result.garments[0].stages.back().name, "settle");
    EXPECT_GE(result.garments[0].stages.back().frames, 4);
    EXPECT_GE(result.garments[0].stages.back().steps, result.garments[0].stages.back().frames);
    EXPECT_EQ(result.garments[0].stages.back().vertices,
              int(result.garments[0].surface.mesh.positions.size()));
    EXPECT_EQ(result.garments[0].surface.mesh.groups.size(), 2u);
    EXPECT_EQ(result.garments[0].seams.size(), 2u);
    // The tube surrounds the body by then; placed, its panels were 4 cm away from it.
    for (const Vec3& x : result.garments[0].surface.mesh.positions)
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
    ASSERT_EQ(result.garments[0].slides.size(), 1u);
    EXPECT_EQ(result.garments[0].slides[0].label, "top");
    EXPECT_GT(result.garments[0].slides[0].slid, kMaxSlide);
}

TEST_F(DrapeTest, DrapesAPanelWithoutSeams)
{
    std::string pattern = tube(0.36, "");
    const size_t stitches = pattern.find("\"stitches\": ["), end = pattern.find("]]}", stitches);
    pattern.replace(stitches, end + 2 - stitches, "\"stitches\": []");
    max_motion_ = 0.2;
    const DrapeResult result = drape_tube(pattern);
    EXPECT_EQ(result.outcome, DrapeOutcome::NotAtRest) << result.message; // the panels fall beside the body
    EXPECT_EQ(result.garments[0].pieces, 2);
    EXPECT_TRUE(result.garments[0].seams.empty());
}

TEST_F(DrapeTest, NamesASeamThatCannotClose)
{
    // Two panels of 16 cm around 63.
    const DrapeResult result = drape_tube(tube(0.16, "strapless_top"));
    EXPECT_EQ(result.outcome, DrapeOutcome::Tangled);
    EXPECT_NE(result.message.find("stays open by"), std::string::npos) << result.message;
    EXPECT_FALSE(result.garments[0].surface.mesh.lines.empty());
}

TEST_F(DrapeTest, SaysThatPanelsStartInTheBody)
{
    const DrapeResult result = drape_tube(tube(0.36, "", 0.0)); // the front panel in its middle
    EXPECT_EQ(result.outcome, DrapeOutcome::Placement);
    EXPECT_NE(result.message.find("can't be sewn from where they are placed"), std::string::npos)
        << result.message;
    EXPECT_FALSE(result.garments[0].surface.mesh.positions.empty());
}

} // namespace

} // namespace toile::test
