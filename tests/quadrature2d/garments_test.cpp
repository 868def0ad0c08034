#include <cmath>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "core/mesh/obj.h"
#include "core/quadrature/quadrature_solver.h"
#include "garment/energy/membrane.h"
#include "garment/energy/rest_shape.h"
#include "quadrature2d/geodesic_embedding.h"
#include "tests/support/contraction.h"

/// Contraction of the quadrature solver on modelled garments: panels joined by seams, holes, several pieces,
/// cells of very different sizes.
namespace toile::test {

using namespace garment;
using namespace quadrature2d;

namespace {

struct Garment {
    std::shared_ptr<const RestShape> rest;
    std::vector<unsigned char> fixed; ///< the top 3 cm
    SparseMatrix H;

    /// @param stiffness  [N/m] of the warp; the weft has 0.4, shear 0.1 of it
    Garment(const std::filesystem::path& file, double stiffness)
    {
        const TriangleMesh mesh = read_obj(file).triangulated();
        rest = std::make_shared<const RestShape>(
            rest_shape_of_surface(mesh, Vec3::UnitY(), 0.0, file.filename().string()));
        const double top = bounds(mesh.positions).upper.y();
        for (const Vec3& p : mesh.positions)
            fixed.push_back(p.y() > top - 0.03);
        const Membrane membrane(rest, {stiffness, 0.4 * stiffness, 0.1 * stiffness}, "garment");
        Triplets entries;
        membrane.add_hessian(entries);
        const std::vector<double> areas = rest->vertex_areas();
        for (int v = 0; v < rest->vertex_count(); ++v)
            entries.emplace_back(v, v, 0.2 * areas[v] * 120.0 * 120.0);
        H.resize(rest->vertex_count(), rest->vertex_count());
        H.setFromTriplets(entries.begin(), entries.end());
        for (int row = 0; row < H.rows(); ++row)
            for (SparseMatrix::InnerIterator entry(H, row); entry; ++entry)
                if (fixed[row] || fixed[int(entry.col())])
                    entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
    }
};

/// Random field, independent from vertex to vertex, 0 at fixed vertices.
std::vector<Vec3> rough_field(const Garment& garment)
{
    std::vector<Vec3> x(garment.H.rows());
    for (int v = 0; v < int(x.size()); ++v)
        x[v] = garment.fixed[v] ? Vec3(Vec3::Zero())
                                : Vec3(std::sin(3.1 * v), std::cos(7.7 * v), std::sin(1.0 * v * v));
    return x;
}

class Garments : public testing::TestWithParam<const char*> {};

TEST_P(Garments, AreSolvedByQuadratureThatContracts)
{
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / "garments" / GetParam();
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no garments/" << GetParam();
    for (const double stiffness : {10.0, 1e3, 1e5}) {
        const Garment garment(file, stiffness);
        const RestShape& rest = *garment.rest;
        QuadratureSolver solver(geodesic_embedding(
            rest.vertex_count(), surface_metric(rest.triangles, rest.edges, rest.topology)));
        solver.update(garment.H, garment.fixed);
        const double factor = contraction(solver, garment.H, rough_field(garment), 50);
        // At 10 N/m the kernel reaches only two cells of these coarse meshes, and H weighs every error fully.
        EXPECT_LT(factor, stiffness < 100.0 ? 0.75 : 0.5) << stiffness << " N/m";
        EXPECT_LT(solver.table().gathers_per_node(), 320.0);
        RecordProperty("contraction at " + std::to_string(int(stiffness)) + " N/m", std::to_string(factor));
        RecordProperty("gathers at " + std::to_string(int(stiffness)) + " N/m",
                       std::to_string(solver.table().gathers_per_node()));
    }
}

INSTANTIATE_TEST_SUITE_P(Data, Garments,
                         testing::Values("diffcloth_skirt3448.obj", "diffcloth_tshirt1900.obj",
                                         "mh_man_male_casualsuit04.obj", "mh_woman_female_casualsuit01.obj",
                                         "mh_woman_skirt.obj", "mh_woman_tights.obj"),
                         [](const auto& file) { return std::filesystem::path(file.param).stem().string(); });

} // namespace
} // namespace toile::test
