#include "garment/pattern/mesh/gathers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "garment/pattern/mesh/material_coordinates.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

/// A band, panel 0, to whose lower edge the upper edge of a skirt, panel 1, is sewn.
Pattern band_and_skirt(double band_width, double skirt_width)
{
    Pattern pattern = pattern_of(rectangle("band", band_width, 0.12));
    pattern.panels.push_back(rectangle("skirt", skirt_width, 0.3));
    pattern.seams.push_back(seam("waist", 0, 0, 1, 2));
    return pattern;
}

PatternMesh mesh_of(const Pattern& pattern, double edge = 0.02)
{
    return mesh_pattern(pattern, {edge, {}, {}});
}

/// Edges of the mesh from each vertex to the nearest one on an edge of its panel. [vertices]
std::vector<int> rows_from(const PatternMesh& mesh, int panel, int edge)
{
    std::vector<int> row(mesh.uv.size(), 1000);
    for (const EdgeVertex& at : mesh.edge_vertices[panel][edge])
        row[at.vertex] = 0;
    for (bool is_changed = true; is_changed;) {
        is_changed = false;
        for (const Triangle& t : mesh.triangles)
            for (const int a : t)
                for (const int b : t)
                    if (row[b] > row[a] + 1) {
                        row[b] = row[a] + 1;
                        is_changed = true;
                    }
    }
    return row;
}

/// Lengths at rest of each edge, by its vertices, in all triangles that it has.
std::map<std::array<int, 2>, std::vector<double>> lengths_of(const PatternMesh& mesh,
                                                             const std::vector<FlatTriangle>& rest)
{
    std::map<std::array<int, 2>, std::vector<double>> lengths;
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            lengths[{std::min(a, b), std::max(a, b)}].push_back((rest[t][(k + 1) % 3] - rest[t][k]).norm());
        }
    return lengths;
}

/// Lengths at rest along an edge of a panel, from its start.
std::vector<double> along(const PatternMesh& mesh, const std::vector<FlatTriangle>& rest, int panel, int edge)
{
    const auto lengths = lengths_of(mesh, rest);
    std::vector<double> result;
    const auto& vertices = mesh.edge_vertices[panel][edge];
    for (size_t i = 0; i + 1 < vertices.size(); ++i) {
        const int a = vertices[i].vertex, b = vertices[i + 1].vertex;
        const std::vector<double>& one = lengths.at({std::min(a, b), std::max(a, b)});
        EXPECT_EQ(one.size(), 1u);
        result.push_back(one[0]);
    }
    return result;
}

/// Both edges have the same lengths, one in the opposite direction.
void expect_equal_sides(const PatternMesh& mesh, const std::vector<FlatTriangle>& rest,
                        std::array<int, 2> side_a, std::array<int, 2> side_b)
{
    const std::vector<double> a = along(mesh, rest, side_a[0], side_a[1]);
    std::vector<double> b = along(mesh, rest, side_b[0], side_b[1]);
    std::reverse(b.begin(), b.end());
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i], b[i], 1e-12);
}

FlatTriangle flat_triangle(const PatternMesh& mesh, int t)
{
    return {mesh.uv[mesh.triangles[t][0]], mesh.uv[mesh.triangles[t][1]], mesh.uv[mesh.triangles[t][2]]};
}

/// No triangle is turned over or smaller than a fraction of its flat shape; none is rotated.
void expect_sound(const PatternMesh& mesh, const std::vector<FlatTriangle>& rest, double smallest)
{
    ASSERT_EQ(int(rest.size()), mesh.triangle_count());
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const FlatTriangle flat = flat_triangle(mesh, t);
        EXPECT_GT(signed_area(rest[t]) / signed_area(flat), smallest);
        const Mat2 D = (Mat2() << flat[1] - flat[0], flat[2] - flat[0]).finished();
        const Mat2 E = (Mat2() << rest[t][1] - rest[t][0], rest[t][2] - rest[t][0]).finished();
        const Mat2 F = E * D.inverse();
        EXPECT_NEAR(F(0, 1), F(1, 0), 1e-11);
        EXPECT_NEAR((rest[t][0] + rest[t][1] + rest[t][2] - flat[0] - flat[1] - flat[2]).norm(), 0.0, 1e-14);
    }
}

TEST(Gathers, HaveTheShorterLengthAndFadeOverTwoRows)
{
    const Pattern pattern = band_and_skirt(0.2, 0.4);
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    expect_sound(mesh, rest, 0.45);
    expect_equal_sides(mesh, rest, {0, 0}, {1, 2});
    for (const double length : along(mesh, rest, 1, 2))
        EXPECT_NEAR(length, 0.02 / 2.0, 1e-12) << "0.2 m in 20 parts, as the skirt's 0.4 m have";

    // Lengths along the seam have factors 1/2 on it and sqrt(1/2) a row below; those across stay.
    const std::vector<int> row = rows_from(mesh, 1, 2);
    const std::array<double, 3> square{0.25, 0.5, 1.0};
    int untouched = 0, beside_seam = 0;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const FlatTriangle flat = flat_triangle(mesh, t);
        std::array<int, 3> rows;
        for (int k = 0; k < 3; ++k)
            rows[k] = std::min(row[mesh.triangles[t][k]], 2);
        if (mesh.panel_of_triangle(t) == 0 || rows == std::array{2, 2, 2}) {
            EXPECT_EQ(rest[t], flat);
            ++untouched;
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            const Vec2 e = flat[(k + 1) % 3] - flat[k];
            const double along_seam = 0.5 * (square[rows[k]] + square[rows[(k + 1) % 3]]);
            const double expected = std::sqrt(along_seam * e.x() * e.x() + e.y() * e.y());
            EXPECT_NEAR((rest[t][(k + 1) % 3] - rest[t][k]).norm(), expected, 1e-12);
        }
        // A triangle on the seam: half as long, and as high as its slanted sides make it.
        std::sort(rows.begin(), rows.end());
        if (rows != std::array{0, 0, 1})
            continue;
        ++beside_seam;
        const double ratio = signed_area(rest[t]) / signed_area(flat);
        EXPECT_GT(ratio, 0.5);
        EXPECT_LT(ratio, 0.54);
    }
    EXPECT_EQ(beside_seam, 20);
    EXPECT_GT(untouched, mesh.triangle_count() / 2);
}

TEST(Gathers, LetNeighboursAgreeAboutTheirEdges)
{
    const Pattern pattern = band_and_skirt(0.2, 0.43);
    const PatternMesh mesh = mesh_of(pattern);
    for (const auto& [ends, lengths] : lengths_of(mesh, gathered_rest(pattern, mesh)))
        EXPECT_NEAR(lengths.front(), lengths.back(), 1e-12);
}

TEST(Gathers, StretchTheShorterSideIfAsked)
{
    Pattern pattern = band_and_skirt(0.2, 0.3);
    pattern.seams[0].gather = Gather::Long;
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    expect_sound(mesh, rest, 0.9);
    for (const double length : along(mesh, rest, 0, 0))
        EXPECT_NEAR(length, 0.02, 1e-12) << "0.3 m in 15 parts";
    for (int t = mesh.first_triangle[1]; t < mesh.triangle_count(); ++t)
        EXPECT_EQ(rest[t], flat_triangle(mesh, t)) << "the longer side stays";
}

TEST(Gathers, KeepTrianglesThatTheirEdgesWouldCollapse)
{
    Pattern pattern = band_and_skirt(0.2, 0.76);
    for (const Gather gather : {Gather::Short, Gather::Long}) {
        pattern.seams[0].gather = gather;
        const PatternMesh mesh = mesh_of(pattern);
        const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
        expect_sound(mesh, rest, 0.1);
        expect_equal_sides(mesh, rest, {0, 0}, {1, 2});
    }
}

TEST(Gathers, AreNoneWhereSidesAreEven)
{
    for (const Pattern& pattern : {tee(), trousers(), band_and_skirt(0.3, 0.3 * (1.0 + 0.5 * kEvenSides))}) {
        const PatternMesh mesh = mesh_of(pattern);
        const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
        for (int t = 0; t < mesh.triangle_count(); ++t)
            EXPECT_EQ(rest[t], flat_triangle(mesh, t));
    }
}

TEST(Gathers, AreMadeBySidesThatShrinkApart)
{
    // Both sides have 0.3 m as they are cut, and the band 0.27 m at rest.
    Pattern pattern = band_and_skirt(0.3, 0.3);
    pattern.panels[0].shrink_weft = 0.9;
    for (const Gather gather : {Gather::Short, Gather::Long}) {
        pattern.seams[0].gather = gather;
        const PatternMesh mesh = mesh_of(pattern);
        const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
        expect_equal_sides(mesh, rest, {0, 0}, {1, 2});
        for (const double length : along(mesh, rest, 1, 2))
            EXPECT_NEAR(length, (gather == Gather::Short ? 0.27 : 0.3) / 15.0, 1e-12);
        for (const double length : along(mesh, rest, 0, 2))
            EXPECT_NEAR(length, 0.27 / 15.0, 1e-12) << "the free side of the band";
        for (const double length : along(mesh, rest, 1, 0))
            EXPECT_NEAR(length, 0.3 / 15.0, 1e-12) << "the hem";
    }
}

TEST(Gathers, AreNoneWhereBothSidesShrinkAlike)
{
    // The warp of one lies along the seam, the weft of the other.
    Pattern pattern = band_and_skirt(0.3, 0.3);
    pattern.panels[0].grain_deg = 90.0;
    pattern.panels[0].shrink_warp = pattern.panels[1].shrink_weft = 0.9;
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    const std::vector<Vec2> material = material_coordinates(pattern, mesh);
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(rest[size_t(t)][size_t(k)], material[size_t(mesh.triangles[t][k])]);
    expect_equal_sides(mesh, rest, {0, 0}, {1, 2});
}

TEST(Gathers, VanishWhereTheLongerSideShrinksToTheShorter)
{
    Pattern pattern = band_and_skirt(0.2, 0.25);
    pattern.panels[1].shrink_weft = 0.8;
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    const std::vector<Vec2> material = material_coordinates(pattern, mesh);
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(rest[size_t(t)][size_t(k)], material[size_t(mesh.triangles[t][k])]);
}

TEST(Gathers, GoUpToTheTipOfADart)
{
    // The sides of the dart have 0.206 m and 0.186 m.
    Pattern pattern = pattern_of(polygon(
        "front", {{0.0, 0.0}, {0.2, 0.0}, {0.25, 0.2}, {0.3, 0.02}, {0.5, 0.0}, {0.5, 0.4}, {0.0, 0.4}}));
    pattern.seams.push_back(seam("dart", 0, 1, 0, 2));
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    expect_sound(mesh, rest, 0.8);
    expect_equal_sides(mesh, rest, {0, 1}, {0, 2});
    double length = 0.0;
    for (const double part : along(mesh, rest, 0, 1))
        length += part;
    EXPECT_NEAR(length, std::hypot(0.05, 0.18), 1e-12);
}

TEST(Gathers, MeetInTheCornerOfAPanel)
{
    // Top and right side of a patch are gathered to bands; so is its left side, to its own bottom.
    Pattern pattern = pattern_of(rectangle("patch", 0.3, 0.4));
    pattern.panels.push_back(rectangle("upper", 0.15, 0.1));
    pattern.panels.push_back(rectangle("right", 0.1, 0.25));
    pattern.seams = {seam("top", 0, 2, 1, 0), seam("side", 0, 1, 2, 3), seam("own", 0, 3, 0, 0)};
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    expect_sound(mesh, rest, 0.2);
    expect_equal_sides(mesh, rest, {0, 2}, {1, 0});
    expect_equal_sides(mesh, rest, {0, 1}, {2, 3});
    expect_equal_sides(mesh, rest, {0, 3}, {0, 0});

    // At the corner, factors 1/2 along the top and 5/8 along the side; one vertex inside, their square roots.
    const int corner = mesh.edge_vertices[0][2].front().vertex;
    const int on_outline = int(mesh.edge_vertices[0][0].size() + mesh.edge_vertices[0][1].size() +
                               mesh.edge_vertices[0][2].size() + mesh.edge_vertices[0][3].size()) -
                           4;
    int inward = 0;
    for (const auto& [ends, lengths] : lengths_of(mesh, rest)) {
        if (ends[0] != corner || ends[1] < on_outline)
            continue;
        const Vec2 e = mesh.uv[ends[1]] - mesh.uv[corner];
        const double square = 0.5 * (0.25 + 0.5) * e.x() * e.x() + 0.5 * (0.390625 + 0.625) * e.y() * e.y();
        EXPECT_NEAR(lengths.front(), std::sqrt(square), 1e-12);
        ++inward;
    }
    EXPECT_GT(inward, 0);
}

TEST(Gathers, FollowChainsOverSeveralPanels)
{
    Pattern pattern = pattern_of(rectangle("band", 0.3, 0.1));
    pattern.panels.push_back(rectangle("left", 0.25, 0.2));
    pattern.panels.push_back(mirrored(rectangle("right", 0.35, 0.2), "right"));
    pattern.seams.push_back({{{0, 0, 0.0, 1.0}}, {{1, 2, 1.0, 0.0}, {2, 2, 0.0, 1.0}}, "waist", {}});
    const PatternMesh mesh = mesh_of(pattern);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    expect_sound(mesh, rest, 0.45);
    const std::vector<double> band = along(mesh, rest, 0, 0), right = along(mesh, rest, 2, 2);
    std::vector<double> chain = along(mesh, rest, 1, 2);
    std::reverse(chain.begin(), chain.end());
    chain.insert(chain.end(), right.begin(), right.end());
    ASSERT_EQ(chain.size(), band.size());
    for (size_t i = 0; i < band.size(); ++i)
        EXPECT_NEAR(chain[i], band[i], 1e-12);
}

} // namespace

} // namespace toile::garment::test
