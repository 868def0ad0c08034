#include "volume/mesh/msh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/blocks.h"

namespace toile::test {

using namespace volume;

namespace {

const std::string kVersion2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kVersion4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

/// Two tetrahedra, the second with negative volume as stored, and a triangle; no element uses node 50.
const std::string kNodes2 = "$Nodes\n6\n50 9 9 9\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n7 1 1 1\n$EndNodes\n";
const std::string kElements2 =
    "$Elements\n3\n1 2 2 0 1 1 2 3\n2 4 2 0 1 1 2 3 4\n3 4 2 0 1 2 3 4 7\n$EndElements\n";
const std::string kNodes4 = "$Nodes\n2 6 1 50\n3 0 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                            "3 1 1 2\n7\n50\n1 1 1 0 0 0\n9 9 9 0 0 0\n$EndNodes\n";
const std::string kElements4 =
    "$Elements\n2 3 1 3\n2 0 2 1\n1 1 2 3\n3 0 4 2\n2 1 2 3 4\n3 2 3 4 7\n$EndElements\n";

class MshTest : public testing::Test {
protected:
    std::filesystem::path file_of(const std::string& text)
    {
        std::filesystem::path file = folder.path() / "mesh.msh";
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
    void expect_two_tets(const std::string& text)
    {
        const TetMesh mesh = read_msh_tets(file_of(text));
        ASSERT_EQ(mesh.tet_count(), 2);
        EXPECT_EQ(mesh.vertex_count(), 5);
        EXPECT_NEAR(volume_of(mesh.tets[0], mesh.positions), 1.0 / 6.0, 1e-15);
        EXPECT_NEAR(volume_of(mesh.tets[1], mesh.positions), 1.0 / 3.0, 1e-15);
    }
    void expect_refusal(const std::string& text, const std::string& says)
    {
        try {
            read_msh_tets(file_of(text));
            FAIL() << "no error of: " << says;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("mesh.msh"), std::string::npos) << error.what();
        }
    }
    TemporaryFolder folder;
};

/// Text with the numbers' bytes.
template <typename... Numbers>
std::string bytes(Numbers... numbers)
{
    std::string text;
    const auto append = [&](auto number) {
        std::array<char, sizeof number> bytes;
        std::memcpy(bytes.data(), &number, sizeof number);
        text.append(bytes.data(), bytes.size());
    };
    (append(numbers), ...);
    return text;
}

TEST_F(MshTest, ReadsBothVersionsAsText)
{
    expect_two_tets(kVersion2 + kNodes2 + kElements2);
    expect_two_tets(kVersion4 + "$Entities\n1 2 3\n$EndEntities\n" + kNodes4 + kElements4 +
                    "$Surface\n1 2 3\n$EndSurface\n");
    std::string windows = kVersion2 + kNodes2 + kElements2;
    for (size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
        windows.insert(at, "\r");
    expect_two_tets(windows);
}

TEST_F(MshTest, ReadsVersion2AsBytes)
{
    const auto node = [](int tag, double x, double y, double z) { return bytes(tag, x, y, z); };
    expect_two_tets("$MeshFormat\n2.2 1 8\n" + bytes(1) + "\n$EndMeshFormat\n$Nodes\n6\n" +
                    node(50, 9, 9, 9) + node(1, 0, 0, 0) + node(2, 1, 0, 0) + node(3, 0, 1, 0) +
                    node(4, 0, 0, 1) + node(7, 1, 1, 1) + "\n$EndNodes\n$Elements\n3\n" +
                    bytes(2, 1, 2, 1, 0, 1, 1, 2, 3) +                         // a triangle
                    bytes(4, 2, 2, 2, 0, 1, 1, 2, 3, 4, 3, 0, 1, 2, 3, 4, 7) + // tetrahedra
                    "\n$EndElements\n");
}

TEST_F(MshTest, ReadsVersion4AsBytes)
{
    using Size = std::int64_t;
    const auto sizes = [](auto... numbers) { return bytes(Size(numbers)...); };
    const auto point = [](double x, double y, double z) { return bytes(x, y, z); };
    expect_two_tets("$MeshFormat\n4.1 1 8\n" + bytes(1) + "\n$EndMeshFormat\n$Nodes\n" + sizes(1, 6, 1, 50) +
                    bytes(3, 0, 0) + sizes(6, 50, 1, 2, 3, 4, 7) + point(9, 9, 9) + point(0, 0, 0) +
                    point(1, 0, 0) + point(0, 1, 0) + point(0, 0, 1) + point(1, 1, 1) +
                    "\n$EndNodes\n$Elements\n" + sizes(2, 3, 1, 3) + bytes(2, 0, 2) + sizes(1, 1, 1, 2, 3) +
                    bytes(3, 0, 4) + sizes(2, 2, 1, 2, 3, 4, 3, 2, 3, 4, 7) + "\n$EndElements\n");
}

TEST_F(MshTest, ReadsWhatItWrites)
{
    const TetMesh mesh = make_block({1.0, 0.1, 3.0}, {3, 2, 4}, 0.2).mesh;
    const std::filesystem::path file = folder.path() / "new/block.msh";
    write_msh(file, mesh);
    const TetMesh read = read_msh_tets(file);
    EXPECT_EQ(read.positions, mesh.positions);
    EXPECT_EQ(read.tets, mesh.tets);
}

TEST_F(MshTest, NamesTheErrorAndItsPlace)
{
    expect_refusal("solid", "its first line is $MeshFormat");
    expect_refusal("$MeshFormat\n3 0 8\n", "versions 2.2 and 4.1 are read");
    expect_refusal("$MeshFormat\n2.2 2 8\n", "0 (ASCII) or 1 (binary)");
    expect_refusal("$MeshFormat\n2.2 0 4\n", "8 are read");
    expect_refusal("$MeshFormat\n2.2 1 8\n" + bytes(1 << 24), "another byte order");
    expect_refusal(kVersion2, "no linear tetrahedra");
    expect_refusal(kVersion2 + kNodes2, "no linear tetrahedra");
    expect_refusal(kVersion2 + kElements2, "uses node 1, which does not exist");
    expect_refusal(kVersion2 + "$Nodes\n1000000000\n", "has room for");
    expect_refusal(kVersion2 + "$Nodes\n-1\n", "has room for");
    expect_refusal(kVersion2 + "$Nodes\nmany\n", "'many' where a number of items");
    expect_refusal(kVersion2 + "$Nodes\n2\n1 0 0 0\n1 0 0 1\n$EndNodes\n", "node 1 exists twice");
    expect_refusal(kVersion2 + "$Nodes\n1\n1 0 zero 0\n$EndNodes\n", "mesh.msh:6: 'zero' is not finite");
    expect_refusal(kVersion2 + "$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n", "where $EndNodes should stand");
    expect_refusal(kVersion2 + "$Comments\nabc", "section $Comments does not end");
    expect_refusal(kVersion2 + "garbage\n", "'garbage' where a section should begin");
    expect_refusal(kVersion2 + kNodes2 + "$Elements\n1\n1 11 0 1 2 3 4 1 2 3 4 1 2\n$EndElements\n",
                   "element 1 is of type 11");
    expect_refusal(kVersion2 + kNodes2 + "$Elements\n1\n5 4 0 1 2 3 3\n$EndElements\n", "element 5 is flat");
    expect_refusal(kVersion2 + kNodes2 + "$Elements\n2\n5 4 0 1 2 3 4\n6 4 0 1 2 3 7\n$EndElements\n",
                   "element 5 and element 6 lie on the same side");
    expect_refusal(kVersion4 + "$Nodes\n1 2 1 2\n3 0 0 1\n1\n0 0 0\n$EndNodes\n", "2 nodes are announced");
    EXPECT_THROW(read_msh_tets(folder.path() / "missing.msh"), InvalidInput);
}

TEST_F(MshTest, RefusesEveryCutOffFile)
{
    for (const std::string& whole : {kVersion2 + kNodes2 + kElements2, kVersion4 + kNodes4 + kElements4})
        for (size_t end = 0; end < whole.size() - std::strlen("$EndElements\n"); ++end)
            EXPECT_THROW(read_msh_tets(file_of(whole.substr(0, end))), InvalidInput) << end;
}

TEST_F(MshTest, ReadsTheTetrahedraOfOtherPrograms)
{
    const std::filesystem::path tets = std::filesystem::path(TOILE_DATA_DIR) / "tets";
    if (!std::filesystem::is_directory(tets))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no tets/";
    const auto volume = [&](const char* name) {
        const TetMesh mesh = read_msh_tets(tets / name);
        double sum = 0.0;
        for (const Tet& tet : mesh.tets)
            sum += volume_of(tet, mesh.positions);
        return sum;
    };
    EXPECT_NEAR(volume("spot_18k.msh"), 0.7183, 5e-5);
    EXPECT_NEAR(volume("ipc_sphere1K.msh"), M_PI / 6.0, 0.01);
    EXPECT_GT(volume("ipc_bar-651.msh"), 0.0);
    EXPECT_GT(volume("ipc_mat20x20.msh"), 0.0);
    EXPECT_GT(volume("ipc_torus.msh"), 0.0);
}

} // namespace
} // namespace toile::test
