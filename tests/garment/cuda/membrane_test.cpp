#include <algorithm>
#include <iostream>
#include <limits>
#include <random>

#include <Eigen/SVD>

#include "core/compute/parallel.h"
#include "garment/energy/membrane_lanes.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr int kTriangles = 10000, kVertices = 5000;

/// Every hundredth triangle is collapsed: to a line, or, every two hundredth, to a point.
bool is_collapsed(int t) { return t % 100 == 0; }

/// Random triangles between random vertices. Collapsed ones lie on whole coordinates with rest shapes that
/// are powers of two. Their arithmetic is then exact, and every machine finds them collapsed.
struct TriangleSoup {
    std::vector<Vec3> x;
    std::vector<Triangle> tri;
    std::vector<Mat2> rest_inv;
    std::vector<double> area;
    MembraneWeights weights{120.0, 80.0, 60.0};
    std::vector<int> fabric = std::vector<int>(kTriangles, 1);
    std::vector<MembraneWeights> all_weights{{}, weights};

    TriangleSoup()
    {
        std::mt19937 random(5);
        std::uniform_real_distribution<double> offset(-0.02, 0.02), rest(60.0, 140.0), skew(-30.0, 30.0);
        std::uniform_int_distribution<int> vertex(4, kVertices - 1);
        for (int v = 0; v < kVertices; ++v)
            x.push_back(v < 4 ? Vec3(v, 2 * v, -v) : Vec3(offset(random), offset(random), offset(random)));
        for (int t = 0; t < kTriangles; ++t) {
            tri.emplace_back(vertex(random), vertex(random), vertex(random));
            rest_inv.emplace_back();
            rest_inv[t] << rest(random), skew(random), skew(random), rest(random);
            if (is_collapsed(t)) {
                tri[t] = t % 200 == 0 ? Triangle(1, 1, 1) : Triangle(0, 1, 3);
                rest_inv[t] = 128.0 * Mat2::Identity();
            }
            area.push_back(0.5 / rest_inv[t].determinant());
        }
    }

    Mat32 deformation_gradient(int t) const
    {
        Mat32 edges;
        edges.col(0) = x[tri[t][1]] - x[tri[t][0]];
        edges.col(1) = x[tri[t][2]] - x[tri[t][0]];
        return edges * rest_inv[t];
    }
};

/// Result of the local step.
struct Response {
    std::vector<Mat32> corner_gradient = std::vector<Mat32>(kTriangles);
    std::vector<double> energy = std::vector<double>(kTriangles);
};

/// Local step by Membrane's CPU code: eight triangles at a time.
Response in_lanes(const TriangleSoup& soup)
{
    std::vector<Mat2Of<Lanes>> rest_inv(lane_blocks(kTriangles));
    std::vector<Lanes> area(rest_inv.size());
    for (int block = 0; block < lane_blocks(kTriangles); ++block) {
        for (int k = 0; k < 4; ++k)
            rest_inv[block](k) =
                gather(block * kLanes, kTriangles, [&](int t) { return soup.rest_inv[t](k); });
        area[block] = gather(block * kLanes, kTriangles, [&](int t) { return soup.area[t]; });
    }
    Response response;
    const ProjectMembrane kernel{
        soup.x, soup.tri, rest_inv, area, soup.weights, {}, response.corner_gradient, response.energy};
    for (int block = 0; block < lane_blocks(kTriangles); ++block)
        kernel(block);
    return response;
}

Response one_by_one(const TriangleSoup& soup)
{
    Response response;
    const ProjectMembraneTriangle<Mat32> kernel{soup.x,
                                                soup.tri,
                                                soup.rest_inv,
                                                soup.area,
                                                soup.fabric,
                                                soup.all_weights,
                                                response.corner_gradient,
                                                response.energy};
    for (int t = 0; t < kTriangles; ++t)
        kernel(t);
    return response;
}

/// Allowed difference of two results for a triangle, in units of rounding, and the size of their terms. The
/// closest isometry is computed from det C, in which rounding grows by the square of F's condition.
struct Scale {
    double force, energy, condition;

    Scale(const TriangleSoup& soup, int t)
    {
        const Mat32 F = soup.deformation_gradient(t);
        const Vec2 singular = Eigen::JacobiSVD<Mat32>(F).singularValues();
        const double stiffness = soup.weights.warp + soup.weights.weft + soup.weights.shear;
        const double stress = stiffness * (1.0 + F.norm());
        force = soup.area[t] * stress * soup.rest_inv[t].norm();
        energy = soup.area[t] * stress * (1.0 + F.norm());
        // Exactly collapsed triangles are handled separately, without that determinant.
        condition = is_collapsed(t) ? 1.0 : singular[0] / singular[1];
    }
};

/// Expects all differences within tolerance and prints the max relative ones.
void expect_same(const TriangleSoup& soup, const Response& a, const Response& b, const std::string& what)
{
    constexpr double kRounding = 1e-14;
    double worst = 0.0, worst_regular = 0.0;
    for (int t = 0; t < kTriangles; ++t) {
        const Scale scale(soup, t);
        const double force = (a.corner_gradient[t] - b.corner_gradient[t]).norm() / scale.force;
        const double energy = std::abs(a.energy[t] - b.energy[t]) / scale.energy;
        ASSERT_TRUE(a.corner_gradient[t].allFinite() && std::isfinite(a.energy[t])) << t;
        ASSERT_TRUE(b.corner_gradient[t].allFinite() && std::isfinite(b.energy[t])) << t;
        const double allowed = kRounding * scale.condition * scale.condition;
        EXPECT_LE(force, allowed) << "force of triangle " << t << ", condition " << scale.condition;
        EXPECT_LE(energy, allowed) << "energy of triangle " << t << ", condition " << scale.condition;
        worst = std::max({worst, force / allowed, energy / allowed});
        if (scale.condition < 3.0)
            worst_regular = std::max({worst_regular, force, energy});
    }
    std::cout << what << ": largest relative difference " << worst_regular << " at condition below 3, "
              << worst << " of what is allowed at any\n";
}

TEST(MembraneTriangle, MatchesTheLanes)
{
    const TriangleSoup soup;
    expect_same(soup, one_by_one(soup), in_lanes(soup), "triangles, lanes");
}

TEST(MembraneTriangle, HasNoForceFromAPoint)
{
    const TriangleSoup soup;
    const Response response = one_by_one(soup);
    EXPECT_EQ(response.energy[200], 0.0);
    EXPECT_EQ(response.corner_gradient[200], Mat32::Zero());
    EXPECT_GT(response.energy[100], 0.0); // the line's yarns are stretched
}

class CudaMembrane : public OnDevice {
protected:
    /// Local step of the soup on the device.
    Response project(const TriangleSoup& soup) const
    {
        DeviceArray<Vec3> x(space(), "test/x");
        DeviceArray<Triangle> tri(space(), "test/tri");
        DeviceArray<Mat2> rest_inv(space(), "test/rest_inv");
        DeviceArray<double> area(space(), "test/area"), energy(space(), "test/energy", kTriangles);
        DeviceArray<Mat32> corner_gradient(space(), "test/corner_gradient", kTriangles);
        x.upload(soup.x);
        tri.upload(soup.tri);
        rest_inv.upload(soup.rest_inv);
        area.upload(soup.area);
        DeviceArray<int> fabric(space(), "test/fabric");
        DeviceArray<MembraneWeights> weights(space(), "test/weights");
        fabric.upload(soup.fabric);
        weights.upload(soup.all_weights);
        launch(space(), ProjectMembraneTriangle<Mat32>{x.view(), tri.view(), rest_inv.view(), area.view(),
                                                       fabric.view(), weights.view(), corner_gradient.view(),
                                                       energy.view()});
        return {corner_gradient.downloaded(), energy.downloaded()};
    }
};

TEST_F(CudaMembrane, MatchesTheCpu)
{
    const TriangleSoup soup;
    const Response on_gpu = project(soup);
    expect_same(soup, on_gpu, in_lanes(soup), "device, lanes");
    expect_same(soup, on_gpu, one_by_one(soup), "device, triangles");
}

TEST_F(CudaMembrane, HasTheSameBitsEveryTime)
{
    const TriangleSoup soup;
    const Response first = project(soup), second = project(soup);
    EXPECT_EQ(first.corner_gradient, second.corner_gradient);
    EXPECT_EQ(first.energy, second.energy);
}

/// Additions only, in the same order: the same bits as on the CPU.
TEST_F(CudaMembrane, GathersToTheSameBits)
{
    const TriangleSoup soup;
    const Response response = one_by_one(soup);
    std::vector<std::vector<int>> corners_of(kVertices);
    for (int t = 0; t < kTriangles; ++t)
        for (int k = 0; k < 3; ++k)
            corners_of[soup.tri[t][k]].push_back(3 * t + k);
    std::vector<int> first{0}, corners;
    for (const std::vector<int>& corners_of_vertex : corners_of) {
        corners.insert(corners.end(), corners_of_vertex.begin(), corners_of_vertex.end());
        first.push_back(int(corners.size()));
    }
    std::vector<Vec3> expected(kVertices, Vec3(1.0, 2.0, 3.0));

    DeviceArray<int> first_device(space(), "test/first"), corners_device(space(), "test/corners");
    DeviceArray<Mat32> corner_gradient(space(), "test/corner_gradient");
    DeviceArray<Vec3> gradient(space(), "test/gradient");
    first_device.upload(first);
    corners_device.upload(corners);
    corner_gradient.upload(response.corner_gradient);
    gradient.upload(expected);
    launch(space(), GatherCorners{first_device.view(), corners_device.view(), corner_gradient.view(),
                                  gradient.view()});

    const GatherCorners on_host{first, corners, response.corner_gradient, expected};
    for (int v = 0; v < kVertices; ++v)
        on_host(v);
    EXPECT_EQ(gradient.downloaded(), expected);
}

} // namespace
} // namespace toile::test
