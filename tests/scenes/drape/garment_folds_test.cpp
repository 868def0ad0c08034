#include "scenes/drape/garment_folds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "garment/pattern/mesh/resampling.h"
#include "scenes/drape/seam_closing.h"
#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/drape/tube_pattern.h"

/// Folds of panels and of seams as lines of a garment's surface.
namespace toile::test {

using namespace scenes;

namespace {

garment::Pattern tube_of(double width) { return garment_format::parse_pattern(tube(width, ""), "tube.json"); }

/// A fold down the middle of a panel of the tube.
garment::PanelFold middle(int panel, double angle_deg)
{
    return {panel, {{0.0, -0.1}, {0.0, 0.1}}, angle_deg, 0.3, "middle"};
}

using EdgeEnds = std::array<int, 2>;

/// Number of triangles at each edge.
std::map<EdgeEnds, int> edges_of(const ObjMesh& mesh)
{
    std::map<EdgeEnds, int> count;
    for (const std::vector<int>& t : mesh.polygons)
        for (int k = 0; k < 3; ++k)
            ++count[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
    return count;
}

void expect_inner_edges(const GarmentSurface& surface)
{
    const std::map<EdgeEnds, int> edges = edges_of(surface.mesh);
    for (const scene::Fold& fold : surface.folds)
        for (size_t i = 0; i + 1 < fold.vertices.size(); ++i) {
            const auto [a, b] = std::minmax(fold.vertices[i], fold.vertices[i + 1]);
            const auto edge = edges.find({a, b});
            ASSERT_NE(edge, edges.end()) << a << " " << b;
            EXPECT_EQ(edge->second, 2) << a << " " << b;
        }
}

std::vector<Vec3> in_a_plane(const GarmentMesh& mesh)
{
    std::vector<Vec3> x;
    for (const Vec2& uv : mesh.panels.uv)
        x.emplace_back(uv.x(), uv.y(), 0.0);
    return x;
}

/// Positions in which the threads of a seam have no length.
std::vector<Vec3> with_closed_seam(const GarmentMesh& mesh, size_t seam)
{
    std::vector<Vec3> x;
    for (int v = 0; v < mesh.panels.vertex_count(); ++v)
        x.emplace_back(double(v), 0.0, 0.0);
    for (const auto& [a, b] : mesh.panels.stitches[seam])
        x[size_t(b)] = x[size_t(a)];
    return x;
}

} // namespace

TEST(GarmentFolds, RunAlongEdgesOfTheSurface)
{
    garment::Pattern pattern = tube_of(0.3);
    pattern.folds = {middle(0, 120.0), middle(1, -60.0)};
    for (const double edge : {0.05, 0.02}) {
        const GarmentMesh mesh(pattern, edge);
        const SeamClosing seams(mesh, in_a_plane(mesh));
        const GarmentSurface surface = seams.panels();
        ASSERT_EQ(surface.folds.size(), 2u);
        expect_inner_edges(surface);
        EXPECT_EQ(surface.folds[0].angle_deg, 120.0);
        EXPECT_EQ(surface.folds[1].angle_deg, -60.0);
        EXPECT_EQ(surface.folds[0].stiffness, 0.3);
        for (const scene::Fold& fold : surface.folds) {
            EXPECT_EQ(fold.vertices.size(), size_t(std::lround(0.2 / edge)) + 1);
            for (const int v : fold.vertices)
                EXPECT_NEAR(surface.mesh.positions[size_t(v)].x(), 0.0, 1e-9);
        }
    }
}

/// A fold that the coarse mesh has made is one of the fine mesh.
TEST(GarmentFolds, AreKeptByResampling)
{
    garment::Pattern pattern = tube_of(0.3);
    pattern.folds = {middle(0, 90.0)};
    const GarmentMesh coarse(pattern, 0.05), fine(pattern, 0.015);
    std::vector<Vec3> folded;
    for (const Vec2& uv : coarse.panels.uv)
        folded.emplace_back(std::min(uv.x(), 0.0), uv.y(), std::max(uv.x(), 0.0));
    const std::vector<Vec3> x = garment::resample(coarse.panels, fine.panels).apply(coarse.panels, folded);
    for (int v = fine.panels.first_vertex[0]; v < fine.panels.first_vertex[1]; ++v)
        EXPECT_LT(
            (x[size_t(v)] - Vec3(std::min(fine.panels.uv[size_t(v)].x(), 0.0), fine.panels.uv[size_t(v)].y(),
                                 std::max(fine.panels.uv[size_t(v)].x(), 0.0)))
                .norm(),
            1e-6);
}

TEST(GarmentFolds, OfSeamsBeginWhereTheyAreWelded)
{
    garment::Pattern pattern = tube_of(0.3);
    pattern.seams[0].fold_deg = 45.0;
    const GarmentMesh mesh(pattern, 0.05);
    const std::vector<Vec3> x = with_closed_seam(mesh, 0);
    SeamClosing seams(mesh, x);
    EXPECT_TRUE(seams.panels().folds.empty());

    seams.weld();
    const GarmentSurface surface = seams.panels();
    ASSERT_EQ(surface.folds.size(), mesh.panels.stitches[0].size() - 1);
    expect_inner_edges(surface);
    for (const scene::Fold& fold : surface.folds) {
        EXPECT_EQ(fold.angle_deg, 45.0);
        EXPECT_EQ(fold.stiffness, garment::kFoldStiffness);
    }
    EXPECT_EQ(mesh.surface(std::vector<Vec3>(size_t(mesh.sewn.vertex_count), Vec3::Zero())).folds.size(),
              mesh.panels.stitches[0].size() - 1)
        << "the other seam is flat";
}

/// The outside of a panel that is turned is the inside of the surface.
TEST(GarmentFolds, ChangeSignOnPanelsThatAreTurned)
{
    garment::Pattern pattern = tube_of(0.3);
    pattern.folds = {middle(0, 120.0), middle(1, 120.0)};
    pattern.seams[0].fold_deg = 45.0;
    for (garment::Seam& seam : pattern.seams) // front to back
        std::swap(seam.b[0].from, seam.b[0].to);
    const GarmentMesh mesh(pattern, 0.05);
    ASSERT_NE(mesh.sewn.is_turned[0], mesh.sewn.is_turned[1]);
    const std::vector<scene::Fold> folds = mesh.folds.on(mesh.panels, mesh.sewn);
    EXPECT_EQ(folds[0].angle_deg, mesh.sewn.is_turned[0] ? -120.0 : 120.0);
    EXPECT_EQ(folds[1].angle_deg, mesh.sewn.is_turned[1] ? -120.0 : 120.0);
    EXPECT_EQ(folds[2].angle_deg, mesh.sewn.is_turned[size_t(pattern.seams[0].a[0].panel)] ? -45.0 : 45.0);
}

/// The seam of a pleat is a dart: both of its sides end in one vertex, up to which it is folded.
TEST(GarmentFolds, OfSeamsReachTheTipsOfDarts)
{
    garment::Pattern pattern = tube_of(0.3);
    garment::Seam pleat;
    pleat.a = {{0, 2, 0.5, 0.25}};
    pleat.b = {{0, 2, 0.5, 0.75}};
    pleat.name = "pleat";
    pleat.fold_deg = 180.0;
    pattern.seams.push_back(pleat);
    const GarmentMesh mesh(pattern, 0.02);
    const GarmentSurface surface =
        mesh.surface(std::vector<Vec3>(size_t(mesh.sewn.vertex_count), Vec3::Zero()));
    expect_inner_edges(surface);
    EXPECT_EQ(surface.folds.size(), mesh.panels.stitches[2].size()) << "with the edge to the tip";
    double length = 0.0;
    for (size_t i = 0; i < mesh.panels.stitches[2].size(); ++i)
        length = std::max(length, 0.5 * (mesh.panels.uv[size_t(mesh.panels.stitches[2][i][0])] -
                                         mesh.panels.uv[size_t(mesh.panels.stitches[2][i][1])])
                                            .norm());
    EXPECT_NEAR(length, 0.075, 1e-6) << "the pleat is 7.5 cm deep";
}

} // namespace toile::test
