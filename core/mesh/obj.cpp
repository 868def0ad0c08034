#include "core/mesh/obj.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/long_work.h"
#include "core/base/number.h"
#include "core/mesh/polygon.h"

namespace toile {

namespace {

std::string text_of(const std::filesystem::path& file)
{
    if (std::filesystem::is_directory(file))
        throw InvalidInput(file.string() + ": can't be read; give a file, not a folder");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be opened; check the path and its permissions");
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Reads one OBJ file line by line, keeping the line number for error messages.
class ObjReader {
public:
    explicit ObjReader(const std::filesystem::path& file) : file_(file), text_(text_of(file)), left_(text_)
    {
        constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
        if (left_.starts_with(kByteOrderMark))
            left_.remove_prefix(kByteOrderMark.size());
    }

    ObjMesh read()
    {
        constexpr int kLinesBetweenUpdates = 10'000;
        for (int count = 0; next_line(); ++count) {
            if (count % kLinesBetweenUpdates == 0)
                LongWork::update(1.0 - double(left_.size()) / double(text_.size()));
            const std::string_view keyword = next_word();
            if (keyword == "v") {
                read_vertex();
            } else if (keyword == "vt") {
                const double u = number();
                mesh_.texture_coordinates.push_back(Vec2{u, is_line_read() ? 0.0 : number()});
            } else if (keyword == "f" || keyword == "fo") { // fo: a face in files of the first versions
                read_face();
            } else if (keyword == "g") {
                begin_group(mesh_, std::string(rest_of_line()), int(mesh_.polygons.size()));
            } else if (keyword == "l") {
                read_line();
            } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
                ++mesh_.free_form_elements;
            }
        }
        if (mesh_.positions.empty())
            refuse_content();
        drop_incomplete_texture();
        drop_incomplete_colours();
        drop_empty_group();
        return std::move(mesh_);
    }

private:
    static constexpr std::string_view kBlank = " \t\r";

    /// Takes the next line, with those that a backslash at its end joins to it. Lines end with LF, CR or
    /// both.
    /// @return false at the end of the file
    bool next_line()
    {
        if (left_.empty())
            return false;
        line_ += lines_taken_;
        lines_taken_ = 0;
        rest_ = take_statement();
        if (!rest_.ends_with('\\'))
            return true;
        joined_.clear();
        while (rest_.ends_with('\\')) {
            joined_.append(rest_.substr(0, rest_.size() - 1)) += ' ';
            rest_ = take_statement();
        }
        rest_ = joined_.append(rest_);
        return true;
    }

    /// A line without its comment, which may end in a backslash of its own: # C:\models\.
    std::string_view take_statement()
    {
        const std::string_view line = take_line();
        size_t comment = line.find('#');
        while (comment != std::string_view::npos && comment > 0 && line[comment - 1] != ' ' &&
               line[comment - 1] != '\t')
            comment = line.find('#', comment + 1); // part of a word
        return line.substr(0, comment);
    }

    std::string_view take_line()
    {
        const size_t end = std::min(left_.find_first_of("\r\n"), left_.size());
        const std::string_view line = left_.substr(0, end);
        const bool is_both = left_.substr(end).starts_with("\r\n");
        left_.remove_prefix(std::min(end + (is_both ? 2 : 1), left_.size()));
        ++lines_taken_;
        return line;
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InvalidInput(file_.string() + ":" + std::to_string(line_) + ": " + why);
    }

    /// Refuses a file without vertices.
    [[noreturn]] void refuse_content() const
    {
        const bool is_text = text_.find('\0') == std::string::npos;
        throw InvalidInput(file_.string() + ": is no OBJ: " +
                           (is_text ? "no line begins with v; it has \"v x y z\" for each vertex, then " +
                                          std::string("\"f 1 2 3\" for each face")
                                    : "it is binary or in UTF-16; an OBJ is plain text"));
    }

    bool is_line_read() const { return rest_.find_first_not_of(kBlank) == std::string_view::npos; }

    std::string_view next_word()
    {
        const size_t begin = rest_.find_first_not_of(kBlank);
        if (begin == std::string_view::npos)
            return rest_ = {};
        const size_t end = std::min(rest_.find_first_of(kBlank, begin), rest_.size());
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }

    /// Without the spaces around it.
    std::string_view rest_of_line() const
    {
        const size_t begin = std::min(rest_.find_first_not_of(kBlank), rest_.size());
        return rest_.substr(begin, rest_.find_last_not_of(kBlank) + 1 - begin);
    }

    double number()
    {
        if (is_line_read())
            refuse("the line ends too soon; a vertex has x, y and z, a texture coordinate u and v");
        const std::string_view word = next_word();
        const std::optional<double> value = number_in(word);
        if (!value)
            refuse("'" + std::string(word) + "' is not a finite number; write a decimal number: -0.25, 3e-4");
        return *value;
    }

    /// A 1-based or negative (counted from the end) OBJ index, as 0-based.
    int index(std::string_view word, size_t count, const char* what)
    {
        const std::optional<std::int64_t> value = whole_number_in(word);
        if (!value)
            refuse("'" + std::string(word) + "' is no " + what + " index; a corner is v, v/vt, v//vn or " +
                   "v/vt/vn in whole numbers");
        const std::int64_t resolved = *value < 0 ? std::int64_t(count) + *value : *value - 1;
        if (resolved < 0 || resolved >= std::int64_t(count))
            refuse(std::string(what) + " index " + std::to_string(*value) + " is out of range; " +
                   std::to_string(count) + " are defined above this line, numbered from 1");
        return int(resolved);
    }

    /// v x y z, with nothing, a weight, which is ignored, or red, green and blue after it.
    void read_vertex()
    {
        mesh_.positions.push_back(Vec3{number(), number(), number()});
        if (word_count() >= 3)
            mesh_.colours.push_back(Vec3{number(), number(), number()});
        else if (first_plain_vertex_line_ == 0)
            first_plain_vertex_line_ = line_;
    }

    /// Words that are left in the line.
    int word_count() const
    {
        int count = 0;
        for (size_t at = rest_.find_first_not_of(kBlank); at != std::string_view::npos;
             at = rest_.find_first_not_of(kBlank, std::min(rest_.find_first_of(kBlank, at), rest_.size())))
            ++count;
        return count;
    }

    void read_face()
    {
        std::vector<int> polygon;
        std::vector<int> uvs;
        for (std::string_view corner = next_word(); !corner.empty(); corner = next_word()) {
            const size_t slash = corner.find('/');
            polygon.push_back(index(corner.substr(0, slash), mesh_.positions.size(), "vertex"));
            if (slash == std::string_view::npos)
                continue;
            const std::string_view tail = corner.substr(slash + 1);
            if (const std::string_view uv = tail.substr(0, tail.find('/')); !uv.empty())
                uvs.push_back(index(uv, mesh_.texture_coordinates.size(), "texture"));
        }
        if (polygon.size() < 3 || polygon.size() > kMaxPolygonCorners)
            refuse("the face has " + std::to_string(polygon.size()) +
                   (polygon.size() == 1 ? " corner" : " corners") + "; it needs at least 3 and at most " +
                   std::to_string(kMaxPolygonCorners));
        if (!uvs.empty() && uvs.size() != polygon.size())
            refuse("some corners of the face have a texture index and some have none; give all or none");
        mesh_.polygons.push_back(std::move(polygon));
        mesh_.polygon_uvs.push_back(std::move(uvs));
        mesh_.polygon_lines.push_back(line_);
    }

    void read_line()
    {
        int before = -1;
        for (std::string_view point = next_word(); !point.empty(); point = next_word()) {
            const int v = index(point.substr(0, point.find('/')), mesh_.positions.size(), "vertex");
            if (before >= 0 && before != v)
                mesh_.lines.push_back({before, v});
            before = v;
        }
    }

    /// Drops texture indices unless every face has them.
    void drop_incomplete_texture()
    {
        std::vector<std::vector<int>>& uvs = mesh_.polygon_uvs;
        const auto plain = std::find_if(uvs.begin(), uvs.end(), [](const auto& of) { return of.empty(); });
        if (plain == uvs.end())
            return;
        if (std::any_of(uvs.begin(), uvs.end(), [](const auto& of) { return !of.empty(); }))
            mesh_.first_plain_line = mesh_.polygon_lines[size_t(plain - uvs.begin())];
        uvs.clear();
    }

    /// Drops colours unless every vertex has one.
    void drop_incomplete_colours()
    {
        if (first_plain_vertex_line_ == 0 || mesh_.colours.empty())
            return;
        mesh_.first_plain_vertex_line = first_plain_vertex_line_;
        mesh_.colours.clear();
    }

    /// Drops a group that begins after the last polygon.
    void drop_empty_group()
    {
        if (!mesh_.groups.empty() && mesh_.groups.back().first_polygon == int(mesh_.polygons.size()))
            mesh_.groups.pop_back();
    }

    std::filesystem::path file_;
    std::string text_;
    std::string_view left_;           ///< of text_, not taken yet
    std::string joined_;              ///< a continued line
    std::string_view rest_;           ///< of the line
    int line_ = 1;                    ///< where it begins
    int lines_taken_ = 0;             ///< of the file for it
    int first_plain_vertex_line_ = 0; ///< of a vertex without a colour; 0: none
    ObjMesh mesh_;
};

} // namespace

TriangleMesh ObjMesh::triangulated() const
{
    TriangleMesh mesh;
    mesh.positions = positions;
    for (int f = 0; f < int(polygons.size()); ++f)
        for (const Triangle& corner : triangles_of(f))
            mesh.triangles.push_back(
                Triangle(polygons[f][corner[0]], polygons[f][corner[1]], polygons[f][corner[2]]));
    return mesh;
}

std::vector<Triangle> ObjMesh::triangles_of(int polygon) const
{
    if (polygons[polygon].size() == 3)
        return {Triangle(0, 1, 2)};
    std::vector<Vec3> corners;
    corners.reserve(polygons[polygon].size());
    for (const int v : polygons[polygon])
        corners.push_back(positions[v]);
    return triangulate_polygon(corners);
}

void begin_group(ObjMesh& mesh, const std::string& name, int polygon)
{
    std::vector<ObjGroup>& groups = mesh.groups;
    if (!groups.empty() && groups.back().first_polygon == polygon)
        groups.pop_back();
    if (name != (groups.empty() ? "" : groups.back().name))
        groups.push_back({polygon, name});
}

ObjMesh faces_of(const TriangleMesh& mesh)
{
    ObjMesh faces;
    faces.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles)
        faces.polygons.push_back({t[0], t[1], t[2]});
    return faces;
}

namespace {

/// The texture as a surface in the plane z = 0, parallel to triangulated().
TriangleMesh texture_surface(const ObjMesh& mesh)
{
    TriangleMesh texture;
    for (const Vec2& uv : mesh.texture_coordinates)
        texture.positions.emplace_back(uv.x(), uv.y(), 0.0);
    for (int f = 0; f < int(mesh.polygon_uvs.size()); ++f) {
        const std::vector<int>& uvs = mesh.polygon_uvs[f];
        for (const Triangle& corner : mesh.triangles_of(f))
            texture.triangles.emplace_back(uvs[corner[0]], uvs[corner[1]], uvs[corner[2]]);
    }
    return texture;
}

} // namespace

double signed_area(const FlatTriangle& triangle)
{
    const Vec2 a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
    return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

std::vector<FlatTriangle> texture_triangles(const ObjMesh& mesh)
{
    std::vector<FlatTriangle> corners;
    for (int f = 0; f < int(mesh.polygon_uvs.size()); ++f)
        for (const Triangle& corner : mesh.triangles_of(f)) {
            const auto at = [&](int k) { return mesh.texture_coordinates[mesh.polygon_uvs[f][corner[k]]]; };
            corners.push_back({at(0), at(1), at(2)});
        }
    return corners;
}

ObjMesh subdivide(const ObjMesh& mesh, int levels)
{
    ObjMesh fine = faces_of(subdivide(mesh.triangulated(), levels));
    fine.lines = mesh.lines;
    if (!mesh.colours.empty())
        fine.colours = subdivide({mesh.colours, mesh.triangulated().triangles}, levels).positions;
    auto group = mesh.groups.begin();
    int triangles = 0;
    for (int f = 0; f < int(mesh.polygons.size()); ++f) {
        for (; group != mesh.groups.end() && group->first_polygon == f; ++group)
            fine.groups.push_back({triangles << (2 * levels), group->name});
        triangles += int(mesh.triangles_of(f).size());
    }
    if (mesh.polygon_uvs.empty())
        return fine;
    const ObjMesh texture = faces_of(subdivide(texture_surface(mesh), levels));
    for (const Vec3& uv : texture.positions)
        fine.texture_coordinates.emplace_back(uv.x(), uv.y());
    fine.polygon_uvs = texture.polygons;
    return fine;
}

void require_usable(const ObjMesh& mesh, const std::string& source)
{
    if (mesh.polygons.empty())
        throw InvalidInput(source + ": the mesh has no triangle; a surface needs at least one face" +
                           (mesh.free_form_elements > 0 ? ", its curved surfaces as polygons" : ""));
    if (mesh.polygon_lines.empty()) {
        require_usable(mesh.triangulated(), source);
        return;
    }
    const auto refuse = [&](int polygon, const std::string& defect) {
        throw InvalidInput(source + ":" + std::to_string(mesh.polygon_lines[polygon]) + ": the face " +
                           (mesh.polygons[polygon].size() > 3 ? "has a triangle that " : "") + defect);
    };
    TriangleMesh one;
    one.positions = mesh.positions;
    for (int f = 0; f < int(mesh.polygons.size()); ++f)
        for (const Triangle& corner : mesh.triangles_of(f)) {
            const std::vector<int>& polygon = mesh.polygons[f];
            one.triangles = {Triangle(polygon[corner[0]], polygon[corner[1]], polygon[corner[2]])};
            if (const std::string defect = defect_of(one, 0); !defect.empty())
                refuse(f, defect);
        }
}

namespace {

/// Appends numbers with 9 significant digits, whatever the locale.
void append_line(std::string& text, const char* keyword, std::span<const double> numbers)
{
    text += keyword;
    for (const double number : numbers) {
        std::array<char, 32> digits;
        const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number,
                                                std::chars_format::general, 9);
        (text += ' ').append(digits.data(), end);
    }
    text += '\n';
}

/// Characters that end a name, or the line, for a reader.
std::string group_line(std::string name)
{
    for (char& c : name)
        if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || c == '#' || c == '\\')
            c = '_';
    return name.empty() ? "g\n" : "g " + name + "\n";
}

} // namespace

ObjMesh read_obj(const std::filesystem::path& file) { return ObjReader(file).read(); }

void write_obj(const std::filesystem::path& file, const ObjMesh& mesh)
{
    std::string text;
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        std::array<double, 6> numbers{};
        std::copy_n(mesh.positions[v].data(), 3, numbers.begin());
        if (!mesh.colours.empty())
            std::copy_n(mesh.colours[v].data(), 3, numbers.begin() + 3);
        append_line(text, "v", std::span(numbers).first(mesh.colours.empty() ? 3 : 6));
    }
    for (const Vec2& t : mesh.texture_coordinates)
        append_line(text, "vt", {t.data(), 2});
    auto group = mesh.groups.begin();
    for (size_t f = 0; f < mesh.polygons.size(); ++f) {
        for (; group != mesh.groups.end() && group->first_polygon == int(f); ++group)
            text += group_line(group->name);
        text += 'f';
        for (size_t k = 0; k < mesh.polygons[f].size(); ++k) {
            text += ' ' + std::to_string(mesh.polygons[f][k] + 1);
            if (!mesh.polygon_uvs.empty())
                text += '/' + std::to_string(mesh.polygon_uvs[f][k] + 1);
        }
        text += '\n';
    }
    for (const auto& [a, b] : mesh.lines)
        text += "l " + std::to_string(a + 1) + ' ' + std::to_string(b + 1) + '\n';
    write_atomically(file, text);
}

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh)
{
    write_obj(file, faces_of(mesh));
}

} // namespace toile
