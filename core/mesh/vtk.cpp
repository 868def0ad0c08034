#include "core/mesh/vtk.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include "core/base/error.h"

namespace toile {

namespace {

/// Cell type VTK_TETRA.
constexpr int kTetrahedron = 10;

/// Reads a legacy VTK file word by word, keeping the line for error messages.
class VtkReader {
public:
    explicit VtkReader(const std::filesystem::path& file) : file_(file)
    {
        std::ifstream stream(file, std::ios::binary);
        if (!stream)
            throw InvalidInput(file.string() + ": can't be opened; check the path and its permissions");
        text_.assign(std::istreambuf_iterator<char>(stream), {});
    }

    TetMesh read()
    {
        if (line().rfind("# vtk DataFile", 0) != 0)
            refuse("not a legacy VTK file; its first line begins with '# vtk DataFile'");
        line(); // title
        expect("ASCII");
        expect("DATASET");
        expect("UNSTRUCTURED_GRID");
        expect("POINTS");
        const int points = count();
        word(); // number type
        for (int i = 0; i < points; ++i)
            mesh_.positions.push_back(Vec3{number(), number(), number()});
        expect("CELLS");
        const int cells = count();
        count(); // numbers in the list
        for (int i = 0; i < cells; ++i)
            read_cell(i);
        expect("CELL_TYPES");
        if (count() != cells)
            refuse("the number of cell types is not that of the cells, " + std::to_string(cells));
        for (int i = 0; i < cells; ++i)
            if (const int type = whole(); type != kTetrahedron)
                refuse("cell " + std::to_string(i) + " has type " + std::to_string(type) +
                       "; only linear tetrahedra (10) are read");
        if (cells == 0)
            refuse("no cells; give tetrahedra");
        return std::move(mesh_);
    }

private:
    [[noreturn]] void refuse(const std::string& why) const
    {
        const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
        throw InvalidInput(file_.string() + ":" + std::to_string(line) + ": " + why);
    }

    std::string_view line()
    {
        const size_t begin = at_;
        const size_t end = std::min(text_.find('\n', begin), text_.size());
        at_ = std::min(end + 1, text_.size());
        return std::string_view(text_).substr(begin, end - begin);
    }

    std::string_view word()
    {
        constexpr const char* kBlank = " \t\r\n";
        at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
        const size_t begin = at_;
        at_ = std::min(text_.find_first_of(kBlank, begin), text_.size());
        return std::string_view(text_).substr(begin, at_ - begin);
    }

    void expect(const std::string& keyword)
    {
        if (const std::string found(word()); found != keyword)
            refuse("'" + found + "' where " + keyword +
                   " should stand; only unstructured grids in ASCII are read");
    }

    template <typename T>
    T parsed(const char* what)
    {
        const std::string_view found = word();
        T value{};
        const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
        if (error != std::errc{} || end != found.data() + found.size())
            refuse("'" + std::string(found) + "' is not " + what);
        return value;
    }
    int whole() { return parsed<int>("a whole number"); }
    double number()
    {
        const double value = parsed<double>("a number");
        if (!std::isfinite(value))
            refuse("a coordinate is not finite");
        return value;
    }
    int count()
    {
        const int value = whole();
        if (value < 0)
            refuse(std::to_string(value) + " is not a count");
        return value;
    }

    void read_cell(int cell)
    {
        const std::string name = "cell " + std::to_string(cell);
        if (const int corners = whole(); corners != 4)
            refuse(name + " has " + std::to_string(corners) + " corners; a tetrahedron has 4");
        std::array<int, 4> tet{};
        for (int& v : tet) {
            v = whole();
            if (v < 0 || v >= int(mesh_.positions.size()))
                refuse(name + " uses point " + std::to_string(v) + "; the points are 0 to " +
                       std::to_string(int(mesh_.positions.size()) - 1));
        }
        const Vec3& a = mesh_.positions[tet[0]];
        const double volume =
            (mesh_.positions[tet[1]] - a).cross(mesh_.positions[tet[2]] - a).dot(mesh_.positions[tet[3]] - a);
        if (volume == 0.0)
            refuse(name + " is flat; a tetrahedron has a volume");
        if (volume < 0.0)
            std::swap(tet[2], tet[3]);
        mesh_.tets.push_back(tet);
    }

    std::filesystem::path file_;
    std::string text_;
    size_t at_ = 0;
    TetMesh mesh_;
};

} // namespace

TetMesh read_vtk_tets(const std::filesystem::path& file) { return VtkReader(file).read(); }

//        d
//       /|\        faces seen from outside, (b - a) x (c - a) . (d - a) > 0:
//      a-+-c       (a, c, b), (a, b, d), (b, c, d), (a, d, c)
//       \|/
//        b
TriangleMesh boundary_surface(const TetMesh& mesh)
{
    constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    std::map<std::array<int, 3>, int> uses; // sorted corners
    const auto key_of = [](const Triangle& face) {
        std::array<int, 3> key{face[0], face[1], face[2]};
        std::sort(key.begin(), key.end());
        return key;
    };
    std::vector<Triangle> faces;
    for (const std::array<int, 4>& tet : mesh.tets)
        for (const auto& corner : kFaces) {
            faces.emplace_back(tet[corner[0]], tet[corner[1]], tet[corner[2]]);
            ++uses[key_of(faces.back())];
        }

    TriangleMesh surface;
    std::vector<int> number(mesh.positions.size(), -1);
    for (const Triangle& face : faces)
        if (uses[key_of(face)] == 1) {
            surface.triangles.push_back(face);
            for (const int v : face)
                number[v] = 0;
        }
    for (size_t v = 0; v < number.size(); ++v)
        if (number[v] == 0) {
            number[v] = surface.vertex_count();
            surface.positions.push_back(mesh.positions[v]);
        }
    for (Triangle& face : surface.triangles)
        for (int& v : face)
            v = number[v];
    return surface;
}

} // namespace toile
