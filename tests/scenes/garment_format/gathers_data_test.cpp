#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "garment/pattern/mesh/gathers.h"
#include "garment/pattern/seam_measure.h"
#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/garment_format/pattern_files.h"

/// Gathers of the panel JSONs of the data folder.
namespace toile::test {

using namespace garment;

namespace {

/// Lengths of an edge at rest, in each of its triangles.
using Lengths = std::map<std::array<int, 2>, std::vector<double>>;

Lengths lengths_of(const PatternMesh& mesh, const std::vector<FlatTriangle>& rest)
{
    Lengths lengths;
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const int a = mesh.triangles[size_t(t)][int(k)], b = mesh.triangles[size_t(t)][int(k + 1) % 3];
            const FlatTriangle& shape = rest[size_t(t)];
            lengths[{std::min(a, b), std::max(a, b)}].push_back((shape[(k + 1) % 3] - shape[k]).norm());
        }
    return lengths;
}

/// Edges of outlines from one stitch of a seam to the next. [pairs] lengths on both sides
std::vector<std::array<double, 2>> sewn_lengths(const std::vector<std::array<int, 2>>& stitches,
                                                const Lengths& lengths)
{
    const auto outline_length = [&](int a, int b) {
        const auto edge = lengths.find({std::min(a, b), std::max(a, b)});
        return edge != lengths.end() && edge->second.size() == 1 ? edge->second[0] : 0.0;
    };
    std::vector<std::array<double, 2>> pairs;
    for (size_t i = 0; i + 1 < stitches.size(); ++i) {
        const std::array pair{outline_length(stitches[i][0], stitches[i + 1][0]),
                              outline_length(stitches[i][1], stitches[i + 1][1])};
        if (pair[0] > 0.0 && pair[1] > 0.0)
            pairs.push_back(pair);
    }
    return pairs;
}

struct Gathered {
    int gathered_seams = 0;
    double sewn_gap = 0.0;       ///< [m] largest difference of edges that are sewn together
    double least_area = 1e9;     ///< [-] smallest signed area over that of the pattern
    int disagreeing = 0;         ///< inner edges that differ at rest in their triangles
    double sewn_length = 0.0;    ///< [m] of the gathered seams at rest
    double shorter_length = 0.0; ///< [m] of their shorter sides, as the pattern has them
};

Gathered gather(const Pattern& pattern, double edge)
{
    PatternMeshSettings settings;
    settings.edge = edge;
    const PatternMesh mesh = mesh_pattern(pattern, settings);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    const Lengths lengths = lengths_of(mesh, rest);

    Gathered result;
    for (size_t s = 0; s < pattern.seams.size(); ++s) {
        const SeamMeasure measure = measure_seam(pattern, pattern.seams[s]);
        if (measure.ratio() < 1.0 + kEvenSides)
            continue;
        ++result.gathered_seams;
        result.shorter_length += std::min(measure.length_a, measure.length_b);
        for (const auto& [a, b] : sewn_lengths(mesh.stitches[s], lengths)) {
            result.sewn_gap = std::max(result.sewn_gap, std::abs(a - b));
            result.sewn_length += a;
        }
    }
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& corner = mesh.triangles[size_t(t)];
        const auto uv = [&](int k) { return mesh.uv[size_t(corner[k])]; };
        result.least_area =
            std::min(result.least_area, signed_area(rest[size_t(t)]) / signed_area({uv(0), uv(1), uv(2)}));
    }
    for (const auto& [ends, both] : lengths)
        result.disagreeing += std::abs(both.front() - both.back()) > 1e-9 ? 1 : 0;
    return result;
}

Pattern pattern_of(const std::string& file) { return garment_format::read_pattern(pattern_file(file)); }

} // namespace

TEST(GathersData, JoinSidesOfEqualLength)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts())
        for (const double edge : {0.02, 0.01}) {
            SCOPED_TRACE(fact.file + " at " + std::to_string(edge));
            const Gathered gathered = gather(pattern_of(fact.file), edge);
            EXPECT_TRUE(gathered.gathered_seams > 0 || fact.ratio == 0.0);
            EXPECT_LT(gathered.sewn_gap, 1e-9);
            EXPECT_GT(gathered.least_area, 0.95 / std::max(fact.ratio, 1.6));
            EXPECT_EQ(gathered.disagreeing, 0);
            // Chords are up to 1 % shorter than the curves.
            EXPECT_NEAR(gathered.sewn_length, gathered.shorter_length, 0.01 * gathered.shorter_length);
        }
}

TEST(GathersData, StretchTheShorterSidesIfAsked)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        SCOPED_TRACE(fact.file);
        Pattern pattern = pattern_of(fact.file);
        for (Seam& seam : pattern.seams)
            seam.gather = Gather::Long;
        const Gathered gathered = gather(pattern, 0.01);
        EXPECT_LT(gathered.sewn_gap, 1e-9);
        EXPECT_GT(gathered.least_area, 0.95);
        EXPECT_EQ(gathered.disagreeing, 0);
    }
}

} // namespace toile::test
