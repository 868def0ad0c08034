#include <gtest/gtest.h>

#include "garment/pattern/edge_curve.h"
#include "garment/pattern/seam_measure.h"
#include "garment/pattern/seam_side.h"
#include "garment/pattern/sewn_sides.h"
#include "scenes/format/document.h"
#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/garment_format/pattern_files.h"
#include "tests/support/temporary_folder.h"

/// The 15 panel JSONs of the data folder against what was measured on them by other means (FORMATS.md 3).
namespace toile::test {

using namespace garment;
using garment_format::parse_pattern;
using garment_format::read_pattern;

namespace {

double total_area(const Pattern& pattern)
{
    double area = 0.0;
    for (const Panel& panel : pattern.panels)
        area += std::abs(signed_area(panel));
    return area;
}

double largest_ratio(const Pattern& pattern)
{
    double ratio = 1.0;
    for (const Seam& seam : pattern.seams)
        ratio = std::max(ratio, measure_seam(pattern, seam).ratio());
    return ratio;
}

double mean_gap(const Pattern& pattern)
{
    double sum = 0.0;
    for (const Seam& seam : pattern.seams)
        sum += measure_seam(pattern, seam).gap;
    return sum / double(pattern.seams.size());
}

Vec3 middle_of(const Panel& panel)
{
    Vec2 sum = Vec2::Zero();
    for (const Vec2& corner : panel.corners)
        sum += corner;
    const Vec2 mean = sum / double(panel.corners.size());
    return panel.placement * Vec3(mean.x(), mean.y(), 0.0);
}

const Panel& panel_of(const Pattern& pattern, const std::string& name)
{
    return *std::find_if(pattern.panels.begin(), pattern.panels.end(),
                         [&](const Panel& panel) { return panel.name == name; });
}

TEST(PatternData, HasTheAreasOfTheTable)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = read_pattern(pattern_file(fact.file));
        EXPECT_GE(pattern.panels.size(), 2u) << fact.file;
        EXPECT_GE(pattern.seams.size(), 4u) << fact.file;
        if (fact.area > 0.0) {
            EXPECT_NEAR(total_area(pattern), fact.area, 0.005) << fact.file;
        }
    }
}

TEST(PatternData, HasTheSeamRatiosOfTheTable)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts())
        if (fact.ratio > 0.0) {
            EXPECT_NEAR(largest_ratio(read_pattern(pattern_file(fact.file))), fact.ratio, 0.005) << fact.file;
        }
}

/// The bodice of the fitted dress is eased by 1.08 into the sides; its skirt is not counted.
TEST(PatternData, EasesTheFittedBodice)
{
    TOILE_NEED_PATTERNS();
    const Pattern pattern =
        read_pattern(pattern_file("garmentcode/dress_circle_mean_all_specification.json"));
    EXPECT_NEAR(largest_ratio(pattern), 1.08, 0.005);
}

/// Darts: stitches between edges of one panel that share the tip.
TEST(PatternData, HasTheDartsOfTheTable)
{
    TOILE_NEED_PATTERNS();
    const std::vector<std::pair<std::string, int>> darts{
        {"dress_circle_mean_all", 8}, {"dress_gathered_mean_all", 8}, {"pencil_skirt_mean_all", 4},
        {"dress_pencil", 4},          {"pants_mean_all", 4},          {"tee_mean_all", 0}};
    for (const auto& [name, count] : darts) {
        const Pattern pattern = read_pattern(pattern_file("garmentcode/" + name + "_specification.json"));
        int found = 0;
        for (const Seam& seam : pattern.seams) {
            const EdgePart& a = seam.a[0];
            const EdgePart& b = seam.b[0];
            const auto& edges = pattern.panels[size_t(a.panel)].edges;
            if (a.panel == b.panel && (edges[size_t(a.edge)].end == edges[size_t(b.edge)].start ||
                                       edges[size_t(a.edge)].start == edges[size_t(b.edge)].end)) {
                ++found;
                // The tip is joined to itself.
                const SeamSide side_a(pattern, seam.a);
                const SeamSide side_b(pattern, seam.b);
                EXPECT_LT(std::min((side_a.at(0.0) - side_b.at(0.0)).norm(),
                                   (side_a.at(1.0) - side_b.at(1.0)).norm()),
                          1e-12)
                    << name << " " << seam.name;
            }
        }
        EXPECT_EQ(found, count) << name;
    }
}

TEST(PatternData, StartsWithTheSeamGapsOfTheTable)
{
    TOILE_NEED_PATTERNS();
    const Pattern skirt = read_pattern(pattern_file("garment_pattern_generator/skirt_8_panels.json"));
    EXPECT_NEAR(mean_gap(skirt), 0.106, 0.0005);

    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = read_pattern(pattern_file(fact.file));
        for (const Seam& seam : pattern.seams)
            EXPECT_LT(measure_seam(pattern, seam).gap, 0.555) << fact.file << " " << seam.name;
    }
}

/// A label makes the file one of GarmentCode, whose rotations compose in the other order.
TEST(PatternData, ComposesRotationsAsTheWriterDid)
{
    TOILE_NEED_PATTERNS();
    const std::filesystem::path file = pattern_file("garment_pattern_generator/skirt_8_panels.json");
    std::string text = bytes_of(file);
    const size_t at = text.find("\"vertices\"");
    ASSERT_NE(at, std::string::npos);
    text.insert(at, "\"label\": \"leg\", ");
    EXPECT_NEAR(mean_gap(parse_pattern(text, file)), 0.180, 0.001);
}

/// The normal of every loop points away from the garment's middle.
TEST(PatternData, FacesAwayFromTheBody)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = read_pattern(pattern_file(fact.file));
        Vec3 middle = Vec3::Zero();
        for (const Panel& panel : pattern.panels)
            middle += middle_of(panel) / double(pattern.panels.size());
        for (const Panel& panel : pattern.panels) {
            const Vec3 normal = (signed_area(panel) > 0.0 ? 1.0 : -1.0) * panel.placement.linear().col(2);
            EXPECT_GT(normal.dot(middle_of(panel) - middle), 0.0) << fact.file << " " << panel.name;
        }
    }
}

TEST(PatternData, IsSewnToSurfacesOfTwoSidesWithoutSwappedEnds)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = read_pattern(pattern_file(fact.file));
        const SewnSides sides = sewn_sides(pattern);
        EXPECT_TRUE(sides.one_sided.empty()) << fact.file;
        EXPECT_EQ(std::count(sides.turned.begin(), sides.turned.end(), true), 0) << fact.file;
        for (const Seam& seam : pattern.seams)
            EXPECT_FALSE(measure_seam(pattern, seam).crossed) << fact.file << " " << seam.name;
    }
}

/// Every swap makes the surface one-sided, by that seam; those of 3 cm and more are seen in the placed pose
/// too.
TEST(PatternData, TellsWhenEndsAreSwapped)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        Pattern pattern = read_pattern(pattern_file(fact.file));
        for (size_t s = 0; s < pattern.seams.size(); ++s) {
            std::swap(pattern.seams[s].b[0].from, pattern.seams[s].b[0].to);
            const SeamMeasure measure = measure_seam(pattern, pattern.seams[s]);
            if (std::min(measure.length_a, measure.length_b) >= 0.03) {
                EXPECT_TRUE(measure.crossed) << fact.file << " " << pattern.seams[s].name;
            }
            const SewnSides sides = sewn_sides(pattern);
            EXPECT_EQ(sides.one_sided, std::vector<int>{int(s)}) << fact.file << " " << pattern.seams[s].name;
            std::swap(pattern.seams[s].b[0].from, pattern.seams[s].b[0].to);
        }
    }
}

/// Straight lines of tee.json, in units of 1/300 m.
TEST(PatternData, ScalesByUnitsInMeter)
{
    TOILE_NEED_PATTERNS();
    const Pattern tee = read_pattern(pattern_file("garment_pattern_generator/tee.json"));
    double height = 0.0;
    for (const Panel& panel : tee.panels)
        for (const Vec2& corner : panel.corners)
            height = std::max(height, (corner - panel.corners[0]).norm());
    EXPECT_GT(height, 0.4);
    EXPECT_LT(height, 1.0);
    EXPECT_NEAR(total_area(tee), 0.578, 0.001);
}

TEST(PatternData, KeepsLabels)
{
    TOILE_NEED_PATTERNS();
    const Pattern tee = read_pattern(pattern_file("garmentcode/tee_mean_all_specification.json"));
    EXPECT_EQ(panel_of(tee, "left_ftorso").label, "body");
    EXPECT_EQ(panel_of(tee, "left_sleeve_f").label, "arm");
    int collars = 0;
    for (const PanelEdge& edge : panel_of(tee, "left_ftorso").edges)
        collars += edge.label == "left_collar" ? 1 : 0;
    EXPECT_EQ(collars, 1);
}

} // namespace
} // namespace toile::test
