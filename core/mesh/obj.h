#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Most corners of a polygon that is read: its triangulation takes time by their square.
inline constexpr size_t kMaxPolygonCorners = 10000;

/// Polygons from one of a mesh to the next group.
struct ObjGroup {
    int first_polygon = 0;
    std::string name; ///< rest of the g line, with the spaces in it; empty: the group of no name

    bool operator==(const ObjGroup&) const = default;
};

/// Wavefront OBJ surface as stored. Vertex order, polygons and texture coordinates are kept, so that a cache
/// in vertex order plays on the mesh it came from (assimp reorders; 0 of 9 612 vertices stay).
struct ObjMesh {
    std::vector<Vec3> positions;               ///< [v lines]
    std::vector<Vec3> colours;                 ///< [v lines] red, green, blue [-]; empty: not all have one
    std::vector<Vec2> texture_coordinates;     ///< [vt lines]; may be empty
    std::vector<std::vector<int>> polygons;    ///< vertex indices, 0-based
    std::vector<std::vector<int>> polygon_uvs; ///< texture indices per corner, or empty; parallel to polygons
    std::vector<std::array<int, 2>> lines;     ///< vertex indices of the pieces of l lines
    std::vector<ObjGroup> groups;              ///< by their first polygons, ascending; may be empty

    // Of a file, for messages; empty or 0 for a mesh made otherwise.
    std::vector<int> polygon_lines;  ///< line of each polygon, counted from 1
    int first_plain_line = 0;        ///< of a polygon without texture indices where others have them; 0: none
    int first_plain_vertex_line = 0; ///< of a vertex without a colour where others have one; 0: none
    int free_form_elements = 0;      ///< curves and curved surfaces, which are not read

    /// Triangulates every polygon: triangulate_polygon().
    TriangleMesh triangulated() const;

    /// Corner numbers of the triangles of a polygon.
    std::vector<Triangle> triangles_of(int polygon) const;
};

/// The same surface as polygons of three corners.
ObjMesh faces_of(const TriangleMesh& mesh);

/// Corners of a triangle in a plane.
using FlatTriangle = std::array<Vec2, 3>;

/// Area, positive for corners in counter-clockwise order.
double signed_area(const FlatTriangle& triangle);

/// Texture coordinates of the corners of triangulated()'s triangles; empty for a mesh without any.
std::vector<FlatTriangle> texture_triangles(const ObjMesh& mesh);

/// Triangles of a mesh split as by subdivide(TriangleMesh), with their texture,
/// colours, groups and lines, which keep their ends.
ObjMesh subdivide(const ObjMesh& mesh, int levels);

/// Lets the polygons from `polygon` on be of a group, until the next begins.
/// @param polygon  at least the first of all groups so far
void begin_group(ObjMesh& mesh, const std::string& name, int polygon);

/// Reads v, vt, f, g and l lines (negative indices too), with any line ends, comments, continued lines and a
/// byte-order mark; ignores other lines of the format. Texture indices are kept only if every face has them,
/// colours (v x y z r g b) only if every vertex has one.
/// @throws InvalidInput naming file and line: missing file, one without vertices, a number that does not
///         parse or is not finite, an index out of range, a face of fewer than three or more than 10 000
///         corners
ObjMesh read_obj(const std::filesystem::path& file);

/// As for triangles, naming the line of the face.
void require_usable(const ObjMesh& mesh, const std::string& source);

/// Writes positions (with colours where present) with 9 significant digits, the polygons (with texture
/// coordinates where present) in their groups, and the lines. Characters of names that would end them are
/// written as _. The file appears complete or not at all.
/// @throws InvalidInput or DeviceError as write_atomically does.
void write_obj(const std::filesystem::path& file, const ObjMesh& mesh);
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

} // namespace toile
