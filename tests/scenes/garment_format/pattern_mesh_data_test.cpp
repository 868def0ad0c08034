#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "core/mesh/topology.h"
#include "garment/pattern/mesh/mesh_quality.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "garment/pattern/sewn_sides.h"
#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/garment_format/pattern_files.h"

/// Meshes of the 15 panel JSONs of the data folder, and of the own example, as they are sewn.
namespace toile::test {

using namespace garment;
using garment_format::read_pattern;

namespace {

constexpr double kCoarse = 0.02, kFine = 0.01; // [m]

struct Openings {
    int border_loops, euler_characteristic;
};

/// Waist and hem of a skirt; waist and two hems; neck, hem and two cuffs.
Openings openings_of(const std::string& file)
{
    if (file.find("skirt") != std::string::npos)
        return {2, 0};
    return file.find("pants") != std::string::npos ? Openings{3, -1} : Openings{4, -2};
}

PatternMesh mesh_of(const Pattern& pattern, double edge)
{
    PatternMeshSettings settings;
    settings.edge = edge;
    return mesh_pattern(pattern, settings);
}

void expect_sewn(const PatternMesh& mesh, const Openings& expected)
{
    const SewnMesh sewn = sewn_mesh(mesh);
    const SewnTopology& topology = sewn.topology;
    EXPECT_EQ(topology.pieces, 1);
    EXPECT_EQ(topology.border_loops, expected.border_loops);
    EXPECT_EQ(topology.euler_characteristic, expected.euler_characteristic);
    EXPECT_TRUE(topology.is_orientable());
    EXPECT_TRUE(topology.is_manifold());
    // By other code: no edge of three triangles, and windings agree.
    EXPECT_NO_THROW(build_topology(sewn.triangles, sewn.vertex_count, "sewn"));
}

void expect_quality(const PatternMesh& mesh)
{
    const MeshQuality quality = quality_of(mesh);
    EXPECT_GT(quality.smallest_angle, 20.0 * std::numbers::pi / 180.0);
    EXPECT_GT(quality.in_range, 0.95);
    for (int p = 0; p < mesh.panel_count(); ++p)
        EXPECT_GE(quality_of_panel(mesh, p).smallest_angle, quality.smallest_angle);
}

/// Every edge of both sides of a seam has its points in pairs.
void expect_equal_sides(const Pattern& pattern, const PatternMesh& mesh)
{
    for (size_t s = 0; s < pattern.seams.size(); ++s) {
        ASSERT_GE(mesh.stitches[s].size(), 2u);
        for (const auto& [a, b] : mesh.stitches[s]) {
            const auto is_on = [&](int vertex, const std::vector<EdgePart>& side) {
                return std::any_of(side.begin(), side.end(), [&](const EdgePart& part) {
                    const auto& points = mesh.edge_vertices[size_t(part.panel)][size_t(part.edge)];
                    return std::any_of(points.begin(), points.end(),
                                       [&](const EdgeVertex& point) { return point.vertex == vertex; });
                });
            };
            EXPECT_TRUE(is_on(a, pattern.seams[s].a)) << s;
            EXPECT_TRUE(is_on(b, pattern.seams[s].b)) << s;
        }
    }
}

Pattern example()
{
    return read_pattern(std::filesystem::path(TOILE_SOURCE_DIR) / "assets/a_line_skirt.garment.json");
}

} // namespace

TEST(PatternMeshData, IsSewnToTheOpeningsOfItsGarment)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts())
        for (const double edge : {kCoarse, kFine}) {
            SCOPED_TRACE(fact.file + " at " + std::to_string(edge));
            const Pattern pattern = read_pattern(pattern_file(fact.file));
            const PatternMesh mesh = mesh_of(pattern, edge);
            expect_sewn(mesh, openings_of(fact.file));
            expect_quality(mesh);
            expect_equal_sides(pattern, mesh);
        }
}

TEST(PatternMeshData, HasTheSameBitsTwice)
{
    TOILE_NEED_PATTERNS();
    for (const PatternFact& fact : pattern_facts()) {
        const PatternMesh a = mesh_of(read_pattern(pattern_file(fact.file)), kFine);
        const PatternMesh b = mesh_of(read_pattern(pattern_file(fact.file)), kFine);
        EXPECT_EQ(a.uv, b.uv) << fact.file;
        EXPECT_EQ(a.triangles, b.triangles) << fact.file;
        EXPECT_EQ(a.stitches, b.stitches) << fact.file;
    }
}

/// Both searches for one-sided surfaces agree: by whole edges of the pattern, and by edges of its mesh.
TEST(PatternMeshData, IsOneSidedWhereThePatternIs)
{
    TOILE_NEED_PATTERNS();
    int one_sided = 0;
    for (const PatternFact& fact : pattern_facts()) {
        const Pattern pattern = read_pattern(pattern_file(fact.file));
        for (size_t s = 0; s < pattern.seams.size(); ++s) {
            Pattern flipped = pattern;
            std::vector<EdgePart>& side = flipped.seams[s].b;
            std::reverse(side.begin(), side.end());
            for (EdgePart& part : side)
                std::swap(part.from, part.to);
            const bool is_one_sided = !sewn_mesh(mesh_of(flipped, 0.05)).topology.is_orientable();
            EXPECT_EQ(is_one_sided, !sewn_sides(flipped).one_sided.empty()) << fact.file << " seam " << s;
            one_sided += is_one_sided ? 1 : 0;
        }
    }
    EXPECT_GT(one_sided, 50);
}

TEST(PatternMeshData, MeshesTheExampleSkirt)
{
    const Pattern pattern = example();
    for (const double edge : {kCoarse, kFine}) {
        SCOPED_TRACE(edge);
        const PatternMesh mesh = mesh_of(pattern, edge);
        expect_sewn(mesh, {2, 0});
        expect_quality(mesh);
        expect_equal_sides(pattern, mesh);
    }
}

} // namespace toile::test
