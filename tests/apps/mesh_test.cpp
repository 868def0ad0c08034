#include <gtest/gtest.h>

#include <array>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

/// toile mesh: what it prints, writes and refuses.
namespace toile::test {

namespace {

/// A cube of `size` [m], each of its sides with four vertices of its own, as flat-shaded exports have them.
std::string cube(const std::string& size)
{
    const auto corner = [&](int bits) {
        std::string line = "v";
        for (int k = 0; k < 3; ++k)
            line += ((bits >> k) & 1) != 0 ? " " + size : std::string(" 0");
        return line + "\n";
    };
    std::string obj;
    for (const auto& side :
         {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
        for (const int bits : side)
            obj += corner(bits);
        obj += "f -4 -3 -2 -1\n";
    }
    return obj;
}

class Mesh : public FileTest {
protected:
    Finished mesh(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "mesh");
        return run_toile(arguments, temporary_.path());
    }
};

} // namespace

TEST_F(Mesh, JoinsSidesThatAreApartAndWritesTheSameBytesTwice)
{
    temporary_.write("cube.obj", cube("0.1"));
    std::string first;
    for (const char* const file : {"a.msh", "b.msh"}) {
        const Finished finished = mesh({"cube.obj", "--cell", "0.04", "-o", file, "--json"});
        ASSERT_EQ(finished.exit_code, 0) << finished.errors;
        const nlohmann::json json = nlohmann::json::parse(finished.output);
        EXPECT_GT(json["tetrahedra"].get<int>(), 50);
        EXPECT_EQ(json["inverted"].get<int>(), 0);
        EXPECT_GT(json["smallest_dihedral_deg"].get<double>(), 7.0);
        EXPECT_NEAR(json["volume"].get<double>(), 1e-3, 1e-6);
        EXPECT_NEAR(json["volume_error"].get<double>(), 0.0, 1e-3);
        const std::string bytes = bytes_of(temporary_.path() / file);
        EXPECT_TRUE(first.empty() || bytes == first);
        first = bytes;
    }
}

TEST_F(Mesh, ReadsOtherUnitsAndWritesMetres)
{
    temporary_.write("m.obj", cube("0.1"));
    temporary_.write("cm.obj", cube("10"));
    ASSERT_EQ(mesh({"m.obj", "--cell", "0.04", "-o", "m.msh"}).exit_code, 0);
    const Finished finished = mesh({"cm.obj", "--unit", "cm", "--cell", "0.04", "-o", "cm.msh"});
    ASSERT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_EQ(bytes_of(temporary_.path() / "m.msh"), bytes_of(temporary_.path() / "cm.msh"));
}

TEST_F(Mesh, RefusesInOneLineAndWritesNothing)
{
    temporary_.write("cube.obj", cube("0.1"));
    const std::string whole = cube("0.1");
    temporary_.write("open.obj", whole.substr(0, whole.rfind("f ")));
    std::string far = cube("0.1");
    for (const char* const axis : {"0.05 0.05 0.05", "0.15 0.05 0.05", "0.05 0.15 0.05", "0.05 0.05 0.15"})
        far += std::string("v ") + axis + "\n";
    temporary_.write("crossing.obj", far + "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n");
    temporary_.write("empty.obj", "");
    const struct {
        std::vector<std::string> arguments;
        std::vector<std::string> says;
    } runs[]{
        {{"cube.obj", "--cell", "-1", "-o", "o.msh"}, {"--cell", "-1", "such as 0.02"}},
        {{"cube.obj", "--cell", "nan", "-o", "o.msh"}, {"--cell", "nan", "such as 0.02"}},
        {{"cube.obj", "--cell", "abc", "-o", "o.msh"}, {"--cell", "abc", "takes a number"}},
        {{"cube.obj", "--cell", "1e-5", "-o", "o.msh"}, {"cube.obj", "choose", "m or more"}},
        {{"cube.obj", "--cell", "0.02", "--unit", "ell", "-o", "o.msh"}, {"--unit", "ell", "cm"}},
        {{"open.obj", "--cell", "0.02", "-o", "o.msh"},
         {"open.obj: the edge from (0, 0, 0.1) to ", "one triangle only", "closed surface"}},
        {{"crossing.obj", "--cell", "0.02", "-o", "o.msh"},
         {"crossing.obj: the surface crosses itself near ("}},
        {{"empty.obj", "--cell", "0.02", "-o", "o.msh"}, {"empty.obj: is no OBJ", "f 1 2 3"}},
        {{"none.obj", "--cell", "0.02", "-o", "o.msh"}, {"none.obj"}},
        {{"cube.obj", "--cell", "0.02", "-o", "o.vtk"}, {"o.vtk", ".msh"}},
    };
    const auto before = temporary_.snapshot();
    for (const auto& run : runs) {
        const Finished finished = mesh(run.arguments);
        SCOPED_TRACE(finished.errors);
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_EQ(finished.output, "");
        EXPECT_EQ(finished.error_lines(), 1);
        for (const std::string& part : run.says)
            EXPECT_NE(finished.errors.find(part), std::string::npos) << part;
        EXPECT_EQ(temporary_.snapshot(), before);
    }
}

} // namespace toile::test
