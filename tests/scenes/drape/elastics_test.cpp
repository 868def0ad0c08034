#include "scenes/drape/notions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/garment/pattern/panels.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Two panels of 40 cm x 20 cm, whose right and left sides are sewn, in edges of 5 cm.
garment::Pattern panels_with(const std::vector<garment::EdgePart>& edges)
{
    garment::Pattern pattern;
    pattern.source = "panels";
    pattern.panels = {rectangle("a", 0.4, 0.2), rectangle("b", 0.4, 0.2)};
    pattern.seams = {seam(forward(0, 1), backward(1, 3))};
    pattern.elastics = {{edges, 0.7, 9.0}};
    return pattern;
}

/// Where the vertices of a path start, along x of the first panel that has them. [m]
std::vector<double> along_x(const GarmentMesh& mesh, const std::vector<int>& path)
{
    std::vector<double> x;
    for (const int v : path)
        x.push_back(mesh.panels.uv[size_t(mesh.sewn.members[size_t(v)][0])].x());
    return x;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected)
{
    ASSERT_EQ(values.size(), expected.size());
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], 1e-12);
}

} // namespace

TEST(GarmentElastics, RunAlongWholeEdgesAndParts)
{
    // The second part runs against its edge; the third is shorter than half an edge of the mesh.
    const garment::Pattern pattern =
        panels_with({forward(0, 0), {0, 0, 0.8, 0.24}, {0, 0, 0.26, 0.3}, {0, 0, 0.98, 1.0}});
    const GarmentMesh mesh(pattern, 0.05);
    const std::vector<scene::Elastic> elastics = elastics_of(pattern, mesh);
    ASSERT_EQ(elastics.size(), 4u);
    for (const scene::Elastic& elastic : elastics) {
        EXPECT_EQ(elastic.ratio, 0.7);
        EXPECT_EQ(elastic.stiffness, 9.0);
    }
    expect_near(along_x(mesh, elastics[0].vertices), {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4});
    expect_near(along_x(mesh, elastics[1].vertices), {0.1, 0.15, 0.2, 0.25, 0.3});
    expect_near(along_x(mesh, elastics[2].vertices), {0.1, 0.15});
    expect_near(along_x(mesh, elastics[3].vertices), {0.35, 0.4});
}

TEST(GarmentElastics, HaveWeldedVerticesOnSeams)
{
    const garment::Pattern pattern = panels_with({forward(0, 1), backward(1, 3)});
    const GarmentMesh mesh(pattern, 0.05);
    const std::vector<scene::Elastic> elastics = elastics_of(pattern, mesh);
    std::vector<int> other = elastics[1].vertices;
    std::reverse(other.begin(), other.end());
    EXPECT_EQ(elastics[0].vertices, other) << "both sides are one line";
}

} // namespace toile::test
