#include "volume/mesh/vtk.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "volume/mesh/vtk_file.h"

namespace toile::volume {

namespace {

/// Cell type VTK_TETRA, and the last of the linear types without a volume: points, lines, triangles, quads.
constexpr std::int64_t kTetrahedron = 10, kLastFlatType = 9;

/// Cells as lists of points: those of cell i are points[first[i] .. first[i + 1]).
struct Cells {
    std::vector<std::int64_t> first, points;

    std::int64_t count() const { return std::int64_t(first.size()) - 1; }
};

/// Reads an unstructured grid.
class TetReader {
public:
    explicit TetReader(const std::filesystem::path& path) : source_(path.string()), file_(path) {}

    TetMesh read()
    {
        if (const std::string found = file_.dataset(); found != "unstructured_grid")
            file_.refuse("'" + found + "' is a data set without tetrahedra; give an UNSTRUCTURED_GRID of " +
                         "tetrahedra, or a closed surface as .obj");
        require_section("points");
        const std::int64_t count = file_.count();
        const std::vector<double> x = file_.numbers(3 * count, file_.word());
        for (size_t i = 0; i + 2 < x.size(); i += 3)
            mesh_.positions.push_back(Vec3(x[i], x[i + 1], x[i + 2]));
        require_section("cells");
        const Cells cells = read_cells();
        require_section("cell_types");
        if (file_.count() != cells.count())
            file_.refuse("the number of cell types is not that of the cells, " +
                         std::to_string(cells.count()));
        const std::vector<std::int64_t> types = file_.whole_numbers(cells.count(), "int");
        for (std::int64_t i = 0; i < cells.count(); ++i)
            add_cell(i, types[size_t(i)], cells);
        if (mesh_.tets.empty())
            refuse("none of the " + std::to_string(cells.count()) +
                   " cells is a tetrahedron (10); a surface is read as .obj");
        orient(
            mesh_, [this](int t) { return "cell " + std::to_string(cell_of_tet_[t]); }, source_);
        remove_unused_vertices(mesh_);
        return std::move(mesh_);
    }

private:
    void require_section(const std::string& name)
    {
        if (const std::string found = file_.section(); found != name)
            file_.refuse((found.empty() ? "the end of the file" : "'" + found.substr(0, 40) + "'") +
                         " where " + name + " should stand");
    }

    /// "CELLS n size", each cell as its number of points and the points; since version 5.1 "CELLS n + 1 size"
    /// with two arrays.
    Cells read_cells()
    {
        const std::int64_t rows = file_.count(), size = file_.count();
        Cells cells;
        if (file_.is_next("offsets")) {
            file_.expect("OFFSETS");
            cells.first = file_.whole_numbers(rows, file_.word());
            require_section("connectivity");
            cells.points = file_.whole_numbers(size, file_.word());
        } else {
            const std::vector<std::int64_t> list = file_.whole_numbers(size, "int");
            size_t at = 0;
            for (cells.first = {0}; cells.count() < rows;
                 cells.first.push_back(std::int64_t(cells.points.size()))) {
                const std::int64_t corners = at < list.size() ? list[at++] : -1;
                if (corners < 0 || corners > std::int64_t(list.size() - at))
                    file_.refuse("the list of cells ends in cell " + std::to_string(cells.count()) + " of " +
                                 std::to_string(rows));
                cells.points.insert(cells.points.end(), list.begin() + std::ptrdiff_t(at),
                                    list.begin() + std::ptrdiff_t(at) + corners);
                at += size_t(corners);
            }
        }
        if (cells.first.empty() || cells.first.front() != 0 ||
            cells.first.back() != std::int64_t(cells.points.size()) ||
            !std::is_sorted(cells.first.begin(), cells.first.end()))
            file_.refuse("the offsets of the cells do not ascend from 0 to " +
                         std::to_string(cells.points.size()));
        return cells;
    }

    void add_cell(std::int64_t i, std::int64_t type, const Cells& cells)
    {
        const std::string name = "cell " + std::to_string(i);
        if (type >= 1 && type <= kLastFlatType)
            return; // the boundary, which mesh generators write beside the volume
        if (type != kTetrahedron)
            refuse(name + " has type " + std::to_string(type) + "; only linear tetrahedra (10) are read");
        const std::int64_t begin = cells.first[size_t(i)], corners = cells.first[size_t(i) + 1] - begin;
        if (corners != 4)
            refuse(name + " has " + std::to_string(corners) + " corners; a tetrahedron has 4");
        Tet tet{};
        for (int k = 0; k < 4; ++k) {
            const std::int64_t v = cells.points[size_t(begin + k)];
            if (v < 0 || v >= std::int64_t(mesh_.positions.size()))
                refuse(name + " uses point " + std::to_string(v) + "; the points are 0 to " +
                       std::to_string(std::int64_t(mesh_.positions.size()) - 1));
            tet[k] = int(v);
        }
        mesh_.tets.push_back(tet);
        cell_of_tet_.push_back(i);
    }

    [[noreturn]] void refuse(const std::string& why) const { throw InvalidInput(source_ + ": " + why); }

    std::string source_;
    VtkFile file_;
    TetMesh mesh_;
    std::vector<std::int64_t> cell_of_tet_;
};

} // namespace

TetMesh read_vtk_tets(const std::filesystem::path& file) { return TetReader(file).read(); }

} // namespace toile::volume
