#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "export/binary_file.h"
#include "export/ply/ply_file.h"
#include "export/ply/ply_values.h"

namespace toile::exports {

namespace {

std::string bytes_of(const std::filesystem::path& file)
{
    const BinaryFile source(file, BinaryFile::Mode::Read);
    std::string bytes(size_t(source.size()), '\0');
    source.read_at(0, bytes.data(), bytes.size());
    return bytes;
}

/// Reads the mesh element by element.
class PlyReader {
public:
    explicit PlyReader(const std::filesystem::path& file)
        : file_(file), bytes_(bytes_of(file)), header_(read_ply_header(file, bytes_)),
          values_(file_, header_, bytes_)
    {
    }

    std::vector<Vec3> read_positions()
    {
        for (const PlyElement& element : header_.elements) {
            read_element(element);
            if (element.name == "vertex")
                break;
        }
        require_vertices();
        return std::move(mesh_.positions);
    }

    ObjMesh read()
    {
        for (const PlyElement& element : header_.elements)
            read_element(element);
        require_vertices();
        for (const std::vector<int>& polygon : mesh_.polygons)
            for (const int v : polygon)
                if (v >= int(mesh_.positions.size()))
                    refuse("a face uses vertex " + std::to_string(v) + "; there are vertices 0 to " +
                           std::to_string(mesh_.positions.size() - 1));
        if (mesh_.polygons.empty())
            return std::move(mesh_);
        if (mesh_.polygon_uvs.size() != mesh_.polygons.size()) {
            mesh_.polygon_uvs.clear();
            mesh_.texture_coordinates.clear();
        }
        if (mesh_.polygon_uvs.empty() && !vertex_texture_.empty()) {
            mesh_.texture_coordinates = std::move(vertex_texture_);
            mesh_.polygon_uvs = mesh_.polygons;
        }
        return std::move(mesh_);
    }

private:
    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InvalidInput(file_.string() + ": " + why);
    }

    void require_vertices() const
    {
        if (mesh_.positions.empty())
            refuse("has no vertices; export it again");
    }

    void read_element(const PlyElement& element)
    {
        values_.require_room(element);
        if (element.name == "vertex" && mesh_.positions.empty())
            read_vertices(element);
        else if (element.name == "face" && mesh_.polygons.empty())
            read_faces(element);
        else if (!element.properties.empty())
            for (std::int64_t k = 0; k < element.count; ++k)
                for (const PlyProperty& property : element.properties)
                    values_.skip(property);
    }

    double finite(double value) const
    {
        if (!std::isfinite(value))
            values_.refuse("a number is not finite");
        return value;
    }

    void read_vertices(const PlyElement& element)
    {
        std::array<int, 3> axes{element.find({"x"}, false), element.find({"y"}, false),
                                element.find({"z"}, false)};
        for (const int axis : axes)
            if (axis < 0)
                refuse("its vertices have no x, y and z; export it again");
        const int u = element.find({"s", "u", "texture_u"}, false);
        const int v = element.find({"t", "v", "texture_v"}, false);
        std::vector<double> row(element.properties.size());
        mesh_.positions.reserve(size_t(element.count));
        for (std::int64_t k = 0; k < element.count; ++k) {
            for (int p = 0; p < int(row.size()); ++p) {
                const PlyProperty& property = element.properties[size_t(p)];
                if (p == axes[0] || p == axes[1] || p == axes[2] || p == u || p == v)
                    row[size_t(p)] = values_.scalar(property.type);
                else
                    values_.skip(property);
            }
            mesh_.positions.push_back(Vec3(finite(row[size_t(axes[0])]), finite(row[size_t(axes[1])]),
                                           finite(row[size_t(axes[2])])));
            if (u >= 0 && v >= 0)
                vertex_texture_.push_back(Vec2(finite(row[size_t(u)]), finite(row[size_t(v)])));
        }
    }

    void read_faces(const PlyElement& element)
    {
        const int corners = element.find({"vertex_indices", "vertex_index"}, true);
        const int texture = element.find({"texcoord"}, true);
        if (corners < 0)
            refuse("its faces have no vertex_indices; export it again");
        std::vector<double> list;
        std::vector<double> uvs;
        for (std::int64_t k = 0; k < element.count; ++k) {
            uvs.clear();
            for (int p = 0; p < int(element.properties.size()); ++p) {
                const PlyProperty& property = element.properties[size_t(p)];
                if (p == corners)
                    values_.list(property, list);
                else if (p == texture)
                    values_.list(property, uvs);
                else
                    values_.skip(property);
            }
            add_polygon(list);
            if (uvs.size() == 2 * list.size())
                add_texture(uvs);
        }
    }

    void add_polygon(const std::vector<double>& corners)
    {
        if (corners.size() < 3 || corners.size() > kMaxPolygonCorners)
            values_.refuse("a face has " + std::to_string(corners.size()) + " corners; it must have 3 to " +
                           std::to_string(kMaxPolygonCorners));
        std::vector<int>& polygon = mesh_.polygons.emplace_back();
        polygon.reserve(corners.size());
        for (const double corner : corners) {
            if (!(corner >= 0.0 && corner <= 2147483646.0) || corner != std::floor(corner))
                values_.refuse("a face uses vertex " + std::to_string(corner));
            polygon.push_back(int(corner));
        }
    }

    /// Corners with equal coordinates share them.
    void add_texture(const std::vector<double>& uvs)
    {
        std::vector<int>& polygon = mesh_.polygon_uvs.emplace_back();
        polygon.reserve(uvs.size() / 2);
        for (size_t k = 0; k < uvs.size(); k += 2) {
            const auto [at, is_new] = index_of_texture_.try_emplace(
                std::pair(finite(uvs[k]), finite(uvs[k + 1])), int(mesh_.texture_coordinates.size()));
            if (is_new)
                mesh_.texture_coordinates.push_back(Vec2(uvs[k], uvs[k + 1]));
            polygon.push_back(at->second);
        }
    }

    const std::filesystem::path& file_;
    std::string bytes_;
    PlyHeader header_;
    PlyValues values_;
    ObjMesh mesh_;
    std::vector<Vec2> vertex_texture_; ///< [vertices] or empty
    std::map<std::pair<double, double>, int> index_of_texture_;
};

} // namespace

ObjMesh read_ply(const std::filesystem::path& file) { return PlyReader(file).read(); }

std::optional<Axes> read_ply_axes(const std::filesystem::path& file)
{
    return read_ply_header(file, bytes_of(file)).axes;
}

std::vector<Vec3> read_ply_positions(const std::filesystem::path& file)
{
    return PlyReader(file).read_positions();
}

} // namespace toile::exports
