#include "garment/energy/by_fabric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "garment/energy/bend_damping.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/energy/rest_shape.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"
#include "tests/garment/sheets.h"

/// Energies of cloth of several fabrics, and the parts of its rest shape.
namespace toile::test {

using namespace garment;

namespace {

/// A sheet of 1 m whose triangles alternate between two fabrics in blocks.
struct Patchwork {
    std::shared_ptr<const RestShape> rest;
    std::vector<int> fabric;              ///< [triangles]
    std::vector<std::vector<int>> groups; ///< [fabrics]

    Patchwork()
    {
        constexpr int kCells = 8;
        std::vector<Vec2> uv;
        std::vector<Triangle> triangles;
        for (int j = 0; j <= kCells; ++j)
            for (int i = 0; i <= kCells; ++i)
                uv.emplace_back(double(i) / kCells, double(j) / kCells);
        groups.resize(2);
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const int a = j * (kCells + 1) + i, b = a + kCells + 1;
                for (const Triangle& t : {Triangle(a, a + 1, b + 1), Triangle(a, b + 1, b)}) {
                    fabric.push_back((i / 3 + j / 3) % 2);
                    groups[size_t(fabric.back())].push_back(int(triangles.size()));
                    triangles.push_back(t);
                }
            }
        rest = std::make_shared<const RestShape>(rest_shape_of_pattern(uv, triangles, "patchwork"));
    }
};

double distance(const SparseMatrix& a, const SparseMatrix& b) { return SparseMatrix(a - b).norm(); }

/// The energy is a sum over triangles: K(a, b) = a K(1, 0) + b K(0, 1).
TEST(ByFabric, BendingIsTheSumOfItsFabrics)
{
    const Patchwork sheet;
    const auto matrix = [&](double first, double second) {
        const ByFabric<Bending::Settings> settings({{first, first}, {second, second}}, sheet.fabric);
        return Bending(sheet.rest, settings, "test").matrix();
    };
    const SparseMatrix sum = 2.0 * matrix(1e-5, 0.0) + 3.0 * matrix(0.0, 1e-5);
    EXPECT_LT(distance(matrix(2e-5, 3e-5), sum), 1e-9 * sum.norm());
    EXPECT_EQ(
        distance(matrix(2e-5, 2e-5), Bending(sheet.rest, Bending::Settings{2e-5, 2e-5}, "test").matrix()),
        0.0);
}

/// Factors on the stiffness of triangles, from 0.5 to 4.
std::vector<double> factors(size_t count)
{
    std::vector<double> factors;
    for (size_t t = 0; t < count; ++t)
        factors.push_back(0.5 + 3.5 * double((7 * t) % count) / double(count));
    return factors;
}

/// Positions of a creased and stretched sheet.
std::vector<Vec3> bent(const RestShape& rest)
{
    std::vector<Vec3> x;
    for (int v = 0; v < rest.vertex_count(); ++v) {
        const double u = double(v % 9) / 8.0, w = double(v / 9) / 8.0;
        x.emplace_back(1.1 * u + 0.02 * w, 0.1 * std::sin(5.0 * u) * std::cos(3.0 * w), 0.97 * w);
    }
    return x;
}

TEST(ByFabric, StiffnessOfTrianglesScalesTheirShareOfTheMembrane)
{
    const Patchwork sheet;
    const Membrane::Settings settings{.stretch_damping = 0.01, .shear_damping = 0.02};
    const std::vector<double> stiffness = factors(sheet.rest->triangles.size());
    const auto painted = std::make_shared<Membrane>(sheet.rest, settings, "test", stiffness);
    const std::vector<Vec3> x = bent(*sheet.rest);
    std::vector<Vec3> start = x;
    for (Vec3& p : start)
        p.x() *= 0.99;
    painted->begin_step(start, 0.01);

    double sum = 0.0;
    for (int t = 0; t < int(stiffness.size()); ++t) {
        Membrane one(std::make_shared<const RestShape>(part_of(*sheet.rest, {t})), settings, "test");
        one.begin_step(start, 0.01);
        sum += stiffness[size_t(t)] * value_of(one, x);
    }
    EXPECT_NEAR(value_of(*painted, x), sum, 1e-12 * sum);
    expect_gradient_of_value(*painted, x);
    expect_exact(painted, x);
    const std::vector<double> diagonal = hessian_diagonal(*painted, int(x.size()));
    const std::vector<double> plain = hessian_diagonal(Membrane(sheet.rest, settings, "test"), int(x.size()));
    for (size_t v = 0; v < x.size(); ++v) {
        EXPECT_GT(diagonal[v], 0.5 * plain[v]);
        EXPECT_LT(diagonal[v], 4.0 * plain[v]);
    }
}

TEST(ByFabric, StiffnessOfTrianglesScalesTheirShareOfBending)
{
    const Patchwork sheet;
    const Bending::Settings rigidity{2e-5, 3e-5};
    const std::vector<double> stiffness = factors(sheet.rest->triangles.size());
    const auto terms = [&](const std::vector<double>& factors) {
        return Bending::terms(*sheet.rest, ByFabric(std::vector{rigidity}, {}, factors), "test");
    };
    const std::vector<Bending::Term> painted = terms(stiffness), plain = terms({});
    ASSERT_EQ(painted.size(), stiffness.size());
    for (size_t t = 0; t < painted.size(); ++t)
        EXPECT_LT((painted[t].stiffness - stiffness[t] * plain[t].stiffness).norm(),
                  1e-12 * painted[t].stiffness.norm());

    const auto damping = [&](double factor) {
        const BendDamping::Settings settings{rigidity, 0.05, 0.0};
        BendDamping energy(
            *sheet.rest, ByFabric(std::vector{settings}, {}, std::vector(stiffness.size(), factor)), "test");
        std::vector<Vec3> x = bent(*sheet.rest);
        energy.begin_step(x, 0.01);
        for (Vec3& p : x)
            p.y() *= 1.3;
        return value_of(energy, x);
    };
    EXPECT_GT(damping(1.0), 0.0);
    EXPECT_NEAR(damping(4.0), 4.0 * damping(1.0), 1e-12 * damping(4.0));
}

TEST(ByFabric, PartsKeepTrianglesAndEdges)
{
    const Patchwork sheet;
    int inner = 0, cut = 0;
    for (const std::vector<int>& group : sheet.groups) {
        const RestShape part = part_of(*sheet.rest, group);
        ASSERT_EQ(part.triangles.size(), group.size());
        EXPECT_EQ(part.vertex_count(), sheet.rest->vertex_count());
        for (size_t t = 0; t < group.size(); ++t)
            EXPECT_EQ(part.triangles[t], sheet.rest->triangles[size_t(group[t])]);
        for (int e = 0; e < int(part.topology.edges.size()); ++e) {
            const Edge& edge = part.topology.edges[size_t(e)];
            (edge.is_border() ? cut : inner) += 1;
            for (int side = 0; side < (edge.is_border() ? 1 : 2); ++side) {
                const Triangle& t = part.triangles[size_t(edge.triangle[size_t(side)])];
                const std::array<int, 3>& edges =
                    part.topology.triangle_edge[size_t(edge.triangle[size_t(side)])];
                const int k = int(std::find(edges.begin(), edges.end(), e) - edges.begin());
                ASSERT_LT(k, 3);
                EXPECT_EQ(t[k], edge.vertex[size_t(side)]);
                EXPECT_EQ(t[(k + 1) % 3], edge.vertex[size_t(1 - side)]);
                EXPECT_EQ(t[(k + 2) % 3], edge.opposite[size_t(side)]);
            }
        }
    }
    // Every inner edge of the sheet is inside one part, or at the border of both.
    int inner_of_sheet = 0, border_of_sheet = 0;
    for (const Edge& edge : sheet.rest->topology.edges)
        (edge.is_border() ? border_of_sheet : inner_of_sheet) += 1;
    EXPECT_EQ(2 * inner + cut, 2 * inner_of_sheet + border_of_sheet);
    EXPECT_GT(cut, border_of_sheet);
}

} // namespace
} // namespace toile::test
