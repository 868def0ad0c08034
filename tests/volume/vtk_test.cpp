#include "volume/mesh/vtk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace volume;

namespace {

const std::string kHead = "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kPoints = "POINTS 6 double\n9 9 9\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";

class VtkTest : public testing::Test {
protected:
    std::filesystem::path file_of(const std::string& text)
    {
        std::filesystem::path file = folder.path() / "mesh.vtk";
        std::ofstream(file, std::ios::binary) << text;
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
    const std::string types = "\nCELL_TYPES 1\n10\n";
    const std::vector<std::array<std::string, 2>> mistakes{
        {"solid", "mesh.vtk:1: not a legacy VTK file"},
        {"", "mesh.vtk:1: not a legacy VTK file"},
        {"<?xml version=\"1.0\"?>\n", "mesh.vtk:1: not a legacy VTK file"},
        {"# vtk DataFile Version 2.0\ntitle\n", "the end of the file where ASCII or BINARY should stand"},
        {"# vtk DataFile Version 2.0\ntitle\nASCII\nPOINTS 1 float\n", "'POINTS' where DATASET should stand"},
        {"# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\n", "'polydata' is a data set without"},
        {kHead + "POINTS 1 double\n0 x 0\n",
         "mesh.vtk:6: 'x' is not a finite number; it is number 2 of the 3 announced"},
        {kHead + "POINTS 1 double\n0 inf 0\n", "mesh.vtk:6: 'inf' is not a finite number"},
        {kHead + "POINTS 2 double\n0 0 0\nCELLS 1 5\n",
         "mesh.vtk:7: 'CELLS' is not a finite number; it is number 4"},
        {kHead + "POINTS -5 double\n", "'-5' where a count should stand"},
        {kHead + "POINTS 2000000000 double\n", "'2000000000' where a count should stand"},
        {kHead + kPoints + "CELLS 2 10\n4 1 2 3 4\n", "the end of the file is not a whole number"},
        {kHead + kPoints + "CELLS 2 5\n4 1 2 3 4\n", "the list of cells ends in cell 1 of 2"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 4\n", "the end of the file where cell_types should stand"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n", "is not that of the cells, 1"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 6" + types,
         "mesh.vtk: cell 0 uses point 6; the points are 0 to 5"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 -1" + types, "cell 0 uses point -1"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 1" + types, "cell 0 is flat"},
        {kHead + kPoints + "CELLS 1 4\n3 1 2 3" + types, "cell 0 has 3 corners"},
        {kHead + kPoints + "CELLS 1 5\n4 1 2 3 4\nCELL_TYPES 1\n12\n", "cell 0 has type 12"},
        {kHead + kPoints + "CELLS 1 4\n3 1 2 3\nCELL_TYPES 1\n5\n", "none of the 1 cells is a tetrahedron"},
        {kHead + kPoints + "CELLS 0 0\nCELL_TYPES 0\n", "none of the 0 cells is a tetrahedron"},
        {kHead + kPoints + "CELLS 2 4\nOFFSETS int\n0 9\nCONNECTIVITY int\n1 2 3 4" + types,
         "the offsets of the cells"},
        {kHead + kPoints + "CELLS 2 10\n4 1 2 3 4\n4 4 3 2 1\nCELL_TYPES 2\n10\n10\n",
         "cell 0 and cell 1 lie on the same side of a face"},
        {"# vtk DataFile Version 2.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n1234",
         "byte 77: 18 numbers are announced, the file ends after 1"},
    };
    for (const auto& [text, says] : mistakes)
        EXPECT_NE(refusal(text).find(says), std::string::npos) << "no " << says << " in " << refusal(text);
}

std::string big_endian(const auto& number)
{
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

template <typename Number>
std::string big_endian(std::initializer_list<Number> numbers)
{
    std::string bytes;
    for (const Number number : numbers)
        bytes += big_endian(number);
    return bytes;
}

/// As VTK 9, meshio, Gmsh and others write it.
TEST_F(VtkTest, ReadsEveryVersion)
{
    const std::string head = "# vtk DataFile Version 5.1\ntitle\n", grid = "DATASET UNSTRUCTURED_GRID\n";
    const std::string points = "POINTS 5 float\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";
    const std::string lists = "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\n", types = "CELL_TYPES 2\n10\n10\n";
    const std::string arrays = "CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n"
                               "0 1 2 3 1 2 3 4\n";
    const std::string metadata =
        "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n";
    const std::string field =
        "FIELD FieldData 2\nTIME 1 1 double\n0.5\n" + metadata + "note 1 1 string\na%20b\n";
    const std::string text = head + "ASCII\n" + grid + points + lists + types;
    std::string returns = text;
    std::replace(returns.begin(), returns.end(), '\n', '\r');
    std::string small = text;
    std::transform(small.begin(), small.end(), small.begin(), [](char c) { return char(std::tolower(c)); });
    const auto binary = [&](const std::string& cells) {
        return head + "BINARY\n" + grid + "POINTS 5 float\n" +
               big_endian({0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 1.f, 1.f, 1.f}) +
               "\n" + metadata + cells + "\nCELL_TYPES 2\n" + big_endian({10, 10}) + "\n";
    };
    const std::vector<std::string> texts{
        text,
        returns,
        small,
        "\xef\xbb\xbf" + text,
        head + "ASCII\n" + grid + points + arrays + types,
        head + "ASCII\n" + grid + field + points + metadata + arrays + types +
            "POINT_DATA 5\nSCALARS a float\n",
        head + "ASCII\n" + grid + points + "CELLS 4 16\n1 0\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\n" +
            "CELL_TYPES 4\n1\n5\n10\n10\n",
        binary("CELLS 2 10\n" + big_endian({4, 0, 1, 2, 3, 4, 1, 2, 3, 4})),
        binary("CELLS 3 8\nOFFSETS vtktypeint64\n" + big_endian<std::int64_t>({0, 4, 8}) +
               "\nCONNECTIVITY vtktypeint64\n" + big_endian<std::int64_t>({0, 1, 2, 3, 1, 2, 3, 4})),
    };
    const TetMesh plain = read_vtk_tets(file_of(text));
    EXPECT_EQ(plain.tets.size(), 2u);
    for (const std::string& other : texts) {
        EXPECT_EQ(refusal(other), "");
        const TetMesh mesh = read_vtk_tets(file_of(other));
        EXPECT_EQ(mesh.positions, plain.positions) << other;
        EXPECT_EQ(mesh.tets, plain.tets) << other;
    }
}

TEST_F(VtkTest, RefusesBinaryNumbersThatAreNotFinite)
{
    const std::string text =
        "# vtk DataFile Version 2.0\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n" +
        big_endian({0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, std::nanf(""), 0.f, 0.f, 0.f, 1.f}) + "\nCELLS 1 5\n" +
        big_endian({4, 0, 1, 2, 3}) + "\nCELL_TYPES 1\n" + big_endian({10}) + "\n";
    EXPECT_NE(refusal(text).find("number 8 of the 12 announced is not finite"), std::string::npos)
        << refusal(text);
}

} // namespace
} // namespace toile::test
