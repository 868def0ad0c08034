#include "apps/toile/fit/fit_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "avatars/landmarks/measure_body.h"
#include "avatars/load_avatar.h"
#include "tests/apps/fit/tubes.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace app;

namespace {

using Json = nlohmann::json;

/// The built-in body.
TriangleMesh mannequin()
{
    const std::unique_ptr<avatars::Avatar> avatar = avatars::load_avatar({});
    TriangleMesh mesh{std::vector<Vec3>(size_t(avatar->vertex_count())), avatar->triangles()};
    avatar->pose({}, avatars::identity_affine(), mesh.positions);
    return mesh;
}

/// Tube of cotton around the hips of the mannequin, from 0.4 m below to 0.1 m above.
FittedGarment skirt(double hips)
{
    FittedGarment garment;
    garment.name = "skirt";
    garment.mesh = tube(0.25);
    for (Vec3& x : garment.mesh.positions)
        x.y() = hips - 0.4 + 0.5 * x.y();
    garment.rest = flat(garment.mesh);
    garment.fabrics = {garment::fabric_preset("cotton", "test")};
    garment.fabric_of_triangle.assign(garment.mesh.triangles.size(), 0);
    return garment;
}

double level_of(const TriangleMesh& body, const std::string& key)
{
    for (const avatars::Girth& girth :
         avatars::measure_girths(avatars::find_upright_body(body, {}, "mannequin")))
        if (girth.key == key)
            return girth.plane.point.y();
    return 0.0;
}

class Fit : public FileTest {
protected:
    const TriangleMesh body_ = mannequin();
    const FittedGarment skirt_ = skirt(level_of(body_, "hips"));
};

TEST_F(Fit, OfASkirtHasTheHipsAndNeitherWaistNorThighs)
{
    const GarmentFit fit = fit_of(skirt_, body_, "mannequin");
    EXPECT_EQ(fit.not_measured, "");
    EXPECT_NEAR(fit.front.z(), 1.0, 1e-12);
    const Json json = Json::parse(to_json({fit})).at("garments").at(0);
    EXPECT_EQ(json["name"], "skirt");
    std::map<std::string, double> measured;
    for (const avatars::Measurement& m :
         avatars::measure_body(avatars::find_upright_body(body_, {}, "mannequin")))
        measured[m.key] = m.value;
    int covered = 0;
    for (const Json& girth : json["girths"]) {
        const bool is_pair = girth.contains("side");
        EXPECT_NEAR(girth["body_m"], measured.at(girth["key"]), is_pair ? 0.005 : 1e-12) << girth;
        if (girth["key"] != "hips") {
            EXPECT_FALSE(girth.contains("ease_m")) << girth;
            EXPECT_EQ(girth["not_covered"], girth["key"] == "leg_circ"
                                                ? "the garment goes around other parts of the body too"
                                                : "no cloth goes around it");
            continue;
        }
        ++covered;
        EXPECT_NEAR(girth["garment_m"], circumference() * 0.25, 1e-9);
        EXPECT_NEAR(girth["ease_m"], circumference() * 0.25 - measured["hips"], 1e-9);
        EXPECT_NEAR(girth["ease_ratio"], circumference() * 0.25 / measured["hips"] - 1.0, 1e-9);
    }
    EXPECT_EQ(covered, 1);
    EXPECT_EQ(json["girths"].size(), 8u) << "bust, underbust, waist, hips, thighs, wrists";
}

TEST_F(Fit, IsWrittenAsFilesThatAreAnnounced)
{
    const FitFiles files(temporary_.path() / "out", {"skirt"});
    const GarmentFit fit = fit_of(skirt_, body_, "mannequin");
    testing::internal::CaptureStdout();
    files.write({fit}, body_, RunLog(true));
    testing::internal::GetCapturedStdout();
    std::vector<std::filesystem::path> written, announced = files.all();
    for (const auto& entry : std::filesystem::directory_iterator(temporary_.path() / "out"))
        written.push_back(entry.path());
    std::sort(written.begin(), written.end());
    std::sort(announced.begin(), announced.end());
    EXPECT_EQ(written, announced);

    // The table has a row for each vertex, the map its colour.
    std::istringstream table(bytes_of(file("out/skirt_fit.csv")));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "vertex,tension_N_m,strain,gap_m");
    int rows = 0;
    while (std::getline(table, line))
        EXPECT_EQ(line.substr(0, line.find(',')), std::to_string(rows++));
    EXPECT_EQ(rows, skirt_.mesh.vertex_count());

    std::istringstream obj(bytes_of(file("out/skirt_gap.obj")));
    const VertexMap& gap = fit.maps.at(2);
    ASSERT_EQ(gap.name, "gap");
    for (int v = 0; v < skirt_.mesh.vertex_count(); ++v) {
        std::string keyword;
        Vec3 x, colour;
        obj >> keyword >> x[0] >> x[1] >> x[2] >> colour[0] >> colour[1] >> colour[2];
        ASSERT_EQ(keyword, "v");
        EXPECT_LT((x - skirt_.mesh.positions[size_t(v)]).norm(), 1e-8);
        EXPECT_LT((colour - gap.scale.colour(gap.values[size_t(v)])).norm(), 2e-4);
    }
    const ObjMesh read = read_obj(file("out/skirt_gap.obj"));
    EXPECT_EQ(read.polygons.size(), skirt_.mesh.triangles.size()) << "colours are no obstacle for readers";
}

/// Maps need no landmarks.
TEST_F(Fit, OnABodyThatCannotBeMeasuredSaysSo)
{
    const GarmentFit fit = fit_of(skirt_, tube(0.15), "column.obj");
    EXPECT_TRUE(fit.girths.empty());
    EXPECT_NE(fit.not_measured.find("column.obj: two legs can't be found"), std::string::npos)
        << fit.not_measured;
    EXPECT_EQ(fit.maps.size(), 3u);
    const Json json = Json::parse(to_json({fit})).at("garments").at(0);
    EXPECT_EQ(json["not_measured"], fit.not_measured);
    EXPECT_EQ(json["maps"][0]["name"], "tension");
    EXPECT_EQ(json["maps"][2]["colour_range"], Json({0.0, kWidestGap}));
}

} // namespace
} // namespace toile::test
