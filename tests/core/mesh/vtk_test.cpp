#include "core/mesh/vtk.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

const std::string kHead = "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kPoints = "POINTS 6 double\n9 9 9\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";

class VtkTest : public testing::Test {
protected:
    std::filesystem::path file_of(const std::string& text)
    {
        std::filesystem::path file = folder.path() / "mesh.vtk";
        std::ofstream(file) << text;
        return file;
    }
    std::string refusal(const std::string& text)
    {
        try {
            read_vtk_tets(file_of(text));
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    }
    TemporaryFolder folder;
};

TEST_F(VtkTest, GivesTheSurfaceOfTwoTetrahedra)
{
    // The second has negative volume as stored. No tetrahedron uses point 0.
    const TetMesh mesh =
        read_vtk_tets(file_of(kHead + kPoints + "CELLS 2 10\n4 1 2 3 4\n4 2 3 4 5\nCELL_TYPES 2\n10\n10\n"));
    const TriangleMesh surface = boundary_surface(mesh);
    EXPECT_EQ(surface.vertex_count(), 5);
    EXPECT_EQ(surface.triangle_count(), 6);
    EXPECT_NEAR(solid_moments(surface, "two").volume, 1.0 / 6.0 + 1.0 / 3.0, 1e-15);
}

TEST_F(VtkTest, NamesTheErrorAndItsLine)
{
    EXPECT_NE(refusal("solid").find("not a legacy VTK file"), std::string::npos);
    EXPECT_NE(refusal(kHead + "POINTS 1 double\n0 x 0\n").find("mesh.vtk:6: 'x' is not a number"),
              std::string::npos);
    EXPECT_NE(refusal(kHead + kPoints + "CELLS 1 5\n4 1 2 3 6\n").find("cell 0 uses point 6"),
              std::string::npos);
    EXPECT_NE(refusal(kHead + kPoints + "CELLS 1 4\n3 1 2 3\n").find("has 3 corners"), std::string::npos);
    EXPECT_NE(refusal(kHead + kPoints + "CELLS 1 5\n4 1 2 3 4\nCELL_TYPES 1\n12\n").find("type 12"),
              std::string::npos);
    EXPECT_NE(refusal("# vtk DataFile Version 2.0\ntitle\nBINARY\n").find("ASCII"), std::string::npos);
}

} // namespace
} // namespace toile::test
