#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/linear/cholesky.h"
#include "core/linear/field.h"
#include "core/pd/energy/system.h"
#include "research/paper_rule/gauss_legendre.h"
#include "research/paper_rule/near_samples.h"
#include "research/paper_rule/paper_rule.h"
#include "tests/core/linear/matrices.h"
#include "tests/core/mesh/meshes.h"
#include "tests/volume/blocks.h"
#include "volume/energy/elastic_solid.h"

/// The paper's rule on tetrahedra: Algorithm 1 with voxels, and its weights.
namespace toile::test {

using namespace research;

namespace {

constexpr double kDt = 1.0 / 120.0; // [s]
constexpr double kDensity = 1000.0; // [kg/m^3]
constexpr int kVoxels = 24;         // along a bar: two a cell
const Vec3 kBar(0.3, 0.1, 0.1);     // [m]
constexpr std::array kCells{12, 4, 4};

struct Bar {
    volume::TetMesh mesh = make_block(kBar, kCells, 0.2).mesh;
    VoxelisedMesh<3> voxels{mesh.positions, mesh.tets, kVoxels};
    std::vector<double> masses;
    std::unique_ptr<System> system;

    explicit Bar(double young = 1e5)
    {
        const auto rest = std::make_shared<const volume::RestTets>(rest_tets(mesh, "bar"));
        masses = rest->vertex_volumes();
        for (double& mass : masses)
            mass *= kDensity;
        system = std::make_unique<System>(
            masses, std::vector<std::shared_ptr<Energy>>{std::make_shared<volume::ElasticSolid>(
                        rest, std::vector<volume::Lame>(rest->tets.size(),
                                                        volume::ElasticMaterial{young, 0.3}.lame("bar")))});
        system->prepare(kDt, none_fixed());
    }

    std::vector<unsigned char> none_fixed() const
    {
        return std::vector<unsigned char>(mesh.positions.size(), 0);
    }
    const SparseMatrix& matrix() const { return system->matrix(); }

    /// u(i) = G(:, i) / G_ii.
    std::vector<double> kernel_row(int vertex, double* diagonal = nullptr) const
    {
        std::vector<Vec3> column(mesh.positions.size(), Vec3::Zero());
        column[vertex].x() = 1.0;
        Cholesky(matrix()).solve(column, column);
        std::vector<double> u;
        u.reserve(column.size());
        for (const Vec3& entry : column)
            u.push_back(entry.x() / column[vertex].x());
        if (diagonal)
            *diagonal = column[vertex].x();
        return u;
    }

    /// Inertia of a bent bar [N].
    std::vector<Vec3> smooth_load() const
    {
        std::vector<Vec3> b;
        for (size_t v = 0; v < masses.size(); ++v) {
            const Vec3& p = mesh.positions[v];
            b.push_back(masses[v] / (kDt * kDt) *
                        Vec3(p.x() + 0.01 * std::sin(20.0 * p.y()), p.y() + p.x() * p.x(), p.z()));
        }
        return b;
    }

    /// One in the middle, on a side, an edge, a corner.
    std::vector<int> some_vertices() const
    {
        const Block block = make_block(kBar, kCells);
        return {block.at(6, 2, 2), block.at(3, 4, 1), block.at(8, 4, 4), block.at(0, 0, 0)};
    }
};

/// Fraction of the influence in the box, voxel by voxel.
double fraction_in(const VoxelisedMesh<3>& mesh, const VoxelBox<3>& box, const std::vector<double>& u)
{
    double inside = 0.0, total = 0.0;
    for (int voxel = 0; voxel < mesh.grid().count(); ++voxel)
        for (SparseMatrix::InnerIterator entry(mesh.coverage(), voxel); entry; ++entry) {
            total += entry.value() * std::abs(u[entry.col()]);
            if (box.contains(mesh.grid().at(voxel)))
                inside += entry.value() * std::abs(u[entry.col()]);
        }
    return inside / total;
}

/// A bar bent by a right angle: the block without its upper half beyond the first third.
volume::TetMesh l_shape()
{
    const volume::TetMesh whole = make_block(Vec3(0.3, 0.2, 0.1), {12, 8, 4}).mesh;
    volume::TetMesh part{whole.positions, {}};
    for (const volume::Tet& tet : whole.tets) {
        Vec3 center = Vec3::Zero();
        for (const int vertex : tet)
            center += 0.25 * whole.positions[vertex];
        if (center.x() < 0.1 || center.y() < 0.1)
            part.tets.push_back(tet);
    }
    remove_unused_vertices(part);
    return part;
}

TEST(VoxelisedSolid, CoverageSumsToTheVolumes)
{
    const Bar bar;
    const std::vector<double> volumes = rest_tets(bar.mesh, "bar").vertex_volumes();
    const Eigen::VectorXd sums =
        bar.voxels.coverage().transpose() * Eigen::VectorXd::Ones(bar.voxels.grid().count());
    for (int k = 0; k < bar.mesh.vertex_count(); ++k) {
        EXPECT_NEAR(sums[k], volumes[k], 1e-12 * volumes[k]);
        EXPECT_NEAR(bar.voxels.volume(k), volumes[k], 1e-12 * volumes[k]);
    }
}

/// Voxels of eight cells each hold their own volume.
TEST(VoxelisedSolid, CoverageIsTheVolumeOfEachVoxel)
{
    const volume::TetMesh mesh = make_block(kBar, kCells).mesh;
    const VoxelisedMesh<3> voxels(mesh.positions, mesh.tets, 6);
    ASSERT_EQ(voxels.grid().size, (Voxel<3>{6, 2, 2}));
    const Eigen::VectorXd of_voxel = voxels.coverage() * Eigen::VectorXd::Ones(mesh.vertex_count());
    const double expected = kBar.prod() / voxels.grid().count();
    EXPECT_NEAR(of_voxel.minCoeff(), expected, 1e-9 * expected);
    EXPECT_NEAR(of_voxel.maxCoeff(), expected, 1e-9 * expected);
}

TEST(VoxelisedSolid, LocatesPointsInTheirTetrahedra)
{
    const volume::TetMesh mesh = l_shape();
    const VoxelisedMesh<3> voxels(mesh.positions, mesh.tets, 31);
    for (const Vec3& point : {Vec3(0.05, 0.17, 0.03), Vec3(0.0, 0.0, 0.0), Vec3(0.27, 0.02, 0.1)}) {
        const auto located = voxels.locate(point);
        ASSERT_TRUE(located);
        Vec3 back = Vec3::Zero();
        for (int corner = 0; corner < 4; ++corner)
            back += located->weight[corner] * mesh.positions[located->vertex[corner]];
        EXPECT_LT((back - point).norm(), 1e-12);
        EXPECT_GE(located->weight.minCoeff(), 0.0);
    }
    EXPECT_FALSE(voxels.locate(Vec3(0.2, 0.15, 0.05)));
}

TEST(VoxelisedSolid, NamesTheDefectOfAMesh)
{
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto message = [&](std::vector<volume::Tet> tets) {
        return message_of([&] { VoxelisedMesh<3> mesh(corners, tets, 8); });
    };
    EXPECT_EQ(message({}), "paper rule: no tetrahedron");
    EXPECT_EQ(message({{0, 1, 2, 3}, {0, 2, 1, 3}}), "paper rule: tetrahedron 1 is inside out or flat");
    EXPECT_EQ(message({{0, 1, 2, 4}}), "paper rule: tetrahedron 0 names a vertex outside of 0..3");
}

TEST(SolidFieldDomains, AreNestedAndHoldTheirFractions)
{
    for (const double young : {1e3, 1e5, 1e7}) {
        const Bar bar(young);
        for (const int vertex : bar.some_vertices()) {
            SCOPED_TRACE("E = " + std::to_string(young) + ", vertex " + std::to_string(vertex));
            const std::vector<double> u = bar.kernel_row(vertex);
            const FieldDomains<3> domains = field_domains(bar.voxels, vertex, u, {});
            EXPECT_TRUE(domains.near.contains(bar.voxels.voxel_of(vertex)));
            double largest_slice = 0.0; // of a box of a bar, by volume
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(domains.near.first[axis], domains.middle.first[axis]);
                EXPECT_LE(domains.near.last[axis], domains.middle.last[axis]);
                EXPECT_GE(domains.middle.first[axis], 0);
                EXPECT_LT(domains.middle.last[axis], bar.voxels.grid().size[axis]);
                largest_slice = std::max(largest_slice, 1.0 / domains.near.extent(axis));
            }
            // The kernel falls outwards, so a slice holds no more than its share of the box.
            EXPECT_GE(fraction_in(bar.voxels, domains.near, u), 0.7 - 1e-12);
            EXPECT_LT(fraction_in(bar.voxels, domains.near, u) * (1.0 - largest_slice), 0.7);
            EXPECT_GE(fraction_in(bar.voxels, domains.middle, u), 0.9 - 1e-12);
        }
    }
}

TEST(SolidFieldDomains, StayInTheBody)
{
    const volume::TetMesh mesh = l_shape();
    const VoxelisedMesh<3> voxels(mesh.positions, mesh.tets, 24);
    for (int vertex = 0; vertex < mesh.vertex_count(); vertex += 11) {
        std::vector<double> u;
        for (const Vec3& p : mesh.positions)
            u.push_back(std::exp(-20.0 * (p - mesh.positions[vertex]).norm()));
        field_domains(voxels, vertex, u, {}).middle.for_each([&](const Voxel<3>& voxel) {
            EXPECT_FALSE(voxel[0] >= 8 && voxel[1] >= 8) << voxel[0] << " " << voxel[1];
        });
    }
}

TEST(SolidFarClusters, HoldTheFarFieldsVolume)
{
    const Bar bar;
    const int vertex = bar.some_vertices()[0];
    const std::vector<double> u = bar.kernel_row(vertex);
    const VoxelBox<3> middle{{8, 0, 0}, {15, 7, 7}}; // cuts the bar in two
    const std::vector<FarCluster> clusters = far_clusters(bar.voxels, middle, u, 8, 3);
    EXPECT_EQ(clusters.size(), 8u);
    double expected = 0.0, sum = 0.0;
    for (int k = 0; k < bar.mesh.vertex_count(); ++k)
        expected += middle.contains(bar.voxels.voxel_of(k)) ? 0.0 : bar.voxels.volume(k);
    int left = 0;
    for (const FarCluster& cluster : clusters) {
        EXPECT_FALSE(middle.contains(bar.voxels.voxel_of(cluster.vertex)));
        sum += cluster.volume;
        left += bar.voxels.voxel_of(cluster.vertex)[0] < 8;
    }
    EXPECT_NEAR(sum, expected, 1e-12 * expected);
    EXPECT_EQ(left, 4);
}

TEST(GaussLegendre, BoxesAroundFillTheRest)
{
    const Box<3> inner(Vec3(1, 1, 0), Vec3(2, 3, 1)), outer(Vec3(0, 0, 0), Vec3(4, 4, 2));
    const std::vector<Box<3>> boxes = boxes_around(inner, outer);
    EXPECT_EQ(boxes.size(), 5u); // none below
    double volume = inner.volume();
    for (size_t a = 0; a < boxes.size(); ++a) {
        EXPECT_TRUE(outer.contains(boxes[a]));
        EXPECT_EQ(boxes[a].intersection(inner).volume(), 0.0);
        for (size_t b = 0; b < a; ++b)
            EXPECT_LE(boxes[a].intersection(boxes[b]).sizes().minCoeff(), 0.0);
        volume += boxes[a].volume();
    }
    EXPECT_DOUBLE_EQ(volume, outer.volume());
}

/// sum_k weight_k b_k for u = 1 and a linear phi, with a cluster for every far vertex: every rule integrates
/// phi over the middle box exactly, up to what the Gaussian does in the near box.
TEST(SolidRuleWeights, IntegrateLinearFunctions)
{
    const Bar bar;
    const std::vector<double> u(bar.masses.size(), 1.0);
    const auto phi = [](const Vec3& p) { return 1.0 + 2.0 * p.x() - 3.0 * p.y() + p.z(); };
    RuleSettings settings;
    settings.penalty = 0.0;
    settings.domains = {0.3, 0.3}; // near and middle are one box
    settings.cluster_count = bar.mesh.vertex_count();
    for (const NearMiddle near_middle : {NearMiddle::Stacked, NearMiddle::GaussLegendre})
        for (const int vertex : bar.some_vertices()) {
            settings.near_middle = near_middle;
            const NearField<3> field = near_field(bar.voxels, vertex, u, settings);
            double expected = field.middle.volume() * phi(field.middle.center()), sum = 0.0;
            for (int k = 0; k < bar.mesh.vertex_count(); ++k)
                if (!field.domains.middle.contains(bar.voxels.voxel_of(k)))
                    expected += bar.voxels.volume(k) * phi(bar.mesh.positions[k]);
            for (const WeightedVertex& entry :
                 rule_weights(bar.voxels, vertex, View<const double>(u), settings))
                sum += entry.weight * bar.voxels.volume(entry.vertex) * phi(bar.mesh.positions[entry.vertex]);
            EXPECT_NEAR(sum, expected, 1e-6 * expected) << int(near_middle) << " " << vertex;
        }
}

/// The tabulated rule against its formulas, evaluated field by field with phi on the tetrahedra.
TEST(SolidPaperRule, MatchesADenseEvaluation)
{
    const Bar bar;
    const std::vector<Vec3> b = bar.smooth_load();
    for (const NearMiddle near_middle :
         {NearMiddle::Stacked, NearMiddle::GaussLegendre, NearMiddle::Subdivided}) {
        PaperRule::Settings settings;
        settings.voxels = kVoxels;
        settings.denominator = Denominator::Exact;
        settings.rule.near_middle = near_middle;
        PaperRule rule(bar.mesh.positions, bar.mesh.tets, settings);
        rule.update(bar.matrix(), bar.none_fixed());
        std::vector<Vec3> x(b.size());
        rule.solve(b, x);

        for (const int i : bar.some_vertices()) {
            double diagonal = 0.0;
            const std::vector<double> u = bar.kernel_row(i, &diagonal);
            const auto density = [&](int k) { return u[k] * b[k].y() / bar.voxels.volume(k); };
            const auto phi = [&](const Vec3& point) {
                const auto located = bar.voxels.locate(point);
                double value = 0.0;
                for (int corner = 0; located && corner < 4; ++corner)
                    value += located->weight[corner] * density(located->vertex[corner]);
                return value;
            };
            const NearField<3> field = near_field(bar.voxels, i, u, settings.rule);
            Gaussian<3> gaussian = field.gaussian;
            gaussian.amplitude = 0.0;
            const std::vector<double> of_samples = amplitude_weights(field.gaussian, field.target);
            for (size_t s = 0; s < of_samples.size(); ++s)
                gaussian.amplitude += of_samples[s] * density(field.samples[s]);

            double integral = 0.0;
            const auto middle_points = gauss_legendre(field.middle, 3);
            if (near_middle == NearMiddle::Stacked)
                integral = stacked_integral(phi, gaussian, field.near, middle_points);
            else if (near_middle == NearMiddle::Subdivided) {
                integral = gaussian.integral(field.near);
                for (const Box<3>& box : boxes_around(field.near, field.middle))
                    integral += weighted_sum(phi, gauss_legendre(box, 2));
            } else
                integral = weighted_sum(phi, gauss_legendre(field.near, 4)) +
                           weighted_sum([&](const Vec3& p) { return field.near.contains(p) ? 0.0 : phi(p); },
                                        middle_points);
            for (const FarCluster& cluster :
                 far_clusters(bar.voxels, field.domains.middle, u, 8, settings.rule.seed + unsigned(i)))
                integral += cluster.volume * density(cluster.vertex);
            EXPECT_NEAR(x[i].y(), diagonal * integral, 1e-9 * std::abs(x[i].y())) << int(near_middle);
        }
    }
}

/// Once with exact denominators it is right to a third.
TEST(SolidPaperRule, DoesNotContractAsAnIteration)
{
    const Bar bar;
    const std::vector<Vec3> b = bar.smooth_load();
    std::vector<Vec3> exact(b.size());
    Cholesky(bar.matrix()).solve(b, exact);
    for (const Denominator denominator : {Denominator::Exact, Denominator::SameRule}) {
        PaperRule::Settings settings;
        settings.voxels = kVoxels;
        settings.denominator = denominator;
        std::vector<double> errors;
        for (const int applications : {1, 10}) {
            settings.applications = applications;
            PaperRule rule(bar.mesh.positions, bar.mesh.tets, settings);
            rule.update(bar.matrix(), bar.none_fixed());
            std::vector<Vec3> x(b.size());
            rule.solve(b, x);
            errors.push_back((as_matrix(x) - as_matrix(exact)).norm() / as_matrix(exact).norm());
        }
        EXPECT_GT(errors[1], 1e6);
        if (denominator == Denominator::Exact)
            EXPECT_LT(errors[0], 0.5);
        else
            EXPECT_GT(errors[0], 1.0);
    }
}

} // namespace
} // namespace toile::test
