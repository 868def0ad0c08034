#include "apps/toile/drape/drape_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace toile::test {

using namespace app;

namespace {

/// Two triangles, front at z = 1 and back at z = -1.
std::vector<scenes::DrapedGarment> two_panels()
{
    ObjMesh mesh;
    for (const double z : {1.0, -1.0}) {
        begin_group(mesh, z > 0.0 ? "front" : "back", int(mesh.polygons.size()));
        const int first = int(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {Vec3(0, 0, z), Vec3(1, 0, z), Vec3(0, 1, z)});
        mesh.polygons.push_back({first, first + 1, first + 2});
    }
    std::vector<scenes::DrapedGarment> garments(1);
    garments[0].surface.mesh = mesh;
    return garments;
}

/// The certificate of one frame.
Certificate certificate_of(const FrameFindings& found)
{
    Certificate certificate;
    certificate.frames_expected = 1;
    certificate.add(found);
    return certificate;
}

TEST(DrapeVerdict, IsDrapedIfTheCertificateHolds)
{
    FrameFindings found;
    found.strain = 0.02;
    found.strain_point = Vec3(0, 0, -1);
    const DrapeVerdict verdict = verdict_of(certificate_of(found), two_panels());
    EXPECT_TRUE(verdict.is_draped());
    EXPECT_EQ(verdict.message, "");
}

TEST(DrapeVerdict, NamesConditionPlaceAndPanelOfStrain)
{
    FrameFindings found;
    found.overstretch = {0.3, 0.11, Vec3(0.1, 0.2, -1)};
    const DrapeVerdict verdict = verdict_of(certificate_of(found), two_panels());
    EXPECT_EQ(verdict.word, "solver");
    for (const char* part : {"strain 30 %", "near (0.100, 0.200, -1.000) m", "in panel \"back\""})
        EXPECT_NE(verdict.message.find(part), std::string::npos) << verdict.message;
}

/// Crossings come before depth, and depth before strain.
TEST(DrapeVerdict, NamesThePanelOfTheFirstCondition)
{
    FrameFindings found;
    found.overstretch = {0.3, 0.11, Vec3(0, 0, -1)};
    found.penetration = 0.004;
    found.penetration_point = Vec3(0, 0, 1);
    std::string message = verdict_of(certificate_of(found), two_panels()).message;
    EXPECT_LT(message.find("4 mm deep in an avatar near (0.000, 0.000, 1.000) m"), message.find("strain"));
    EXPECT_NE(message.find("in panel \"front\""), std::string::npos) << message;

    found.cloth_cloth_crossings = 2;
    found.crossing = FrameFindings::CrossingSite{0, {"skirt", 1, ""}, {"skirt", 0, ""}, Vec3(0, 0, -0.5)};
    message = verdict_of(certificate_of(found), two_panels()).message;
    EXPECT_LT(message.find("2 crossings"), message.find("4 mm deep"));
    EXPECT_NE(message.find("in panel \"back\""), std::string::npos) << message;
}

TEST(DrapeReport, HasNoGapForSeamsThatWereNotSewn)
{
    // Two squares; the seam joins a side of 1 m to one of 1 m, and another half of a side to a whole one.
    garment::Pattern pattern;
    for (const char* name : {"front", "back"}) {
        garment::Panel panel;
        panel.name = name;
        panel.corners = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
        for (int e = 0; e < 4; ++e) {
            garment::PanelEdge edge;
            edge.start = e;
            edge.end = (e + 1) % 4;
            panel.edges.push_back(edge);
        }
        pattern.panels.push_back(panel);
    }
    pattern.seams.resize(2);
    pattern.seams[0].name = "first";
    pattern.seams[0].a = {{0, 1, 0.0, 1.0}};
    pattern.seams[0].b = {{1, 3, 0.0, 1.0}};
    pattern.seams[1].name = "second";
    pattern.seams[1].a = {{0, 3, 0.0, 0.5}};
    pattern.seams[1].b = {{1, 1, 0.0, 1.0}};

    DrapeReport report;
    report.verdict = {"tangled", "why"};
    report.result.garments.resize(1);
    report.result.garments[0].seams = {{"first", 0.001}};
    const auto json = nlohmann::json::parse(to_json(report, {pattern}));
    EXPECT_EQ(json["class"], "tangled");
    EXPECT_EQ(json["message"], "why");
    EXPECT_EQ(json["seams"][0]["gap_before_weld_m"], 0.001);
    EXPECT_NEAR(json["seams"][0]["ratio"], 1.0, 1e-12);
    EXPECT_TRUE(json["seams"][1]["gap_before_weld_m"].is_null());
    EXPECT_NEAR(json["seams"][1]["ratio"], 2.0, 1e-12);
    EXPECT_FALSE(json.contains("strain")) << "there is no mesh";
}

TEST(DrapeReport, ListsSeveralGarments)
{
    DrapeReport report;
    report.verdict = {"not at rest", "skirt: why"};
    report.result.garments.resize(2);
    report.result.garments[0].name = "skirt";
    report.result.garments[0].stages = {{"sew", 1.5, 2, 30, 4}};
    report.result.garments[1].name = "tee";
    report.result.garments[1].stages = {{"mesh", 0.25, 0, 40, 0}};
    report.result.garments[1].closures = {{"closures[0]", 0.0005}};
    const auto json = nlohmann::json::parse(to_json(report, std::vector<garment::Pattern>(2)));
    ASSERT_EQ(json["garments"].size(), 2u);
    EXPECT_EQ(json["garments"][0]["name"], "skirt");
    EXPECT_EQ(json["garments"][0]["stages"][0]["frames"], 2);
    EXPECT_EQ(json["garments"][1]["stages"][0]["seconds"], 0.25);
    EXPECT_FALSE(json.contains("stages"));
    EXPECT_TRUE(json["garments"][0]["closures"].empty());
    EXPECT_EQ(json["garments"][1]["closures"][0]["name"], "closures[0]");
    EXPECT_EQ(json["garments"][1]["closures"][0]["gap_m"], 0.0005);
    const std::string summary = summary_of(report);
    EXPECT_TRUE(summary.starts_with("not at rest after 1.8 s:\nskirt: ")) << summary;
    EXPECT_NE(summary.find("\ntee: "), std::string::npos) << summary;
}

/// The panel of a defect is named with its garment where there are several.
TEST(DrapeVerdict, NamesTheGarment)
{
    std::vector<scenes::DrapedGarment> garments = two_panels();
    garments.push_back(garments[0]);
    garments[0].name = "skirt";
    garments[1].name = "tee";
    for (Vec3& x : garments[1].surface.mesh.positions)
        x.y() += 1.0;
    FrameFindings found;
    found.overstretch = {0.3, 0.11, Vec3(0, 1.3, -1)};
    const std::string message = verdict_of(certificate_of(found), garments).message;
    EXPECT_NE(message.find("in panel \"back\" of tee"), std::string::npos) << message;
}

} // namespace
} // namespace toile::test
