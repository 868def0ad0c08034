#include "volume/mesh/tet_mesh.h"

#include <algorithm>
#include <tuple>

#include <Eigen/Geometry>

#include "core/base/error.h"

namespace toile::volume {

namespace {

//        d
//       /|\        faces seen from outside, (b - a) x (c - a) . (d - a) > 0:
//      a-+-c       (a, c, b), (a, b, d), (b, c, d), (a, d, c)
//       \|/
//        b
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/// A face of a tetrahedron, turned so that the smallest corner is the first.
struct Face {
    Triangle corners;
    int tet;

    /// The same for the two tetrahedra of a face.
    auto key() const
    {
        return std::make_tuple(corners[0], std::min(corners[1], corners[2]),
                               std::max(corners[1], corners[2]));
    }
    bool has_same_side(const Face& other) const { return corners == other.corners; }
};

/// Faces of all tetrahedra; those of the same corners follow each other, ordered by tetrahedron.
std::vector<Face> sorted_faces(View<const Tet> tets)
{
    std::vector<Face> faces;
    faces.reserve(4 * size_t(tets.size()));
    for (int t = 0; t < tets.size(); ++t)
        for (const auto& corner : kFaces) {
            std::array<int, 3> face{tets[t][corner[0]], tets[t][corner[1]], tets[t][corner[2]]};
            std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
            faces.push_back({{face[0], face[1], face[2]}, t});
        }
    std::stable_sort(faces.begin(), faces.end(),
                     [](const Face& a, const Face& b) { return a.key() < b.key(); });
    return faces;
}

/// Removes vertices that no element uses, and numbers those of the elements anew.
template <typename Element>
void keep_used(std::vector<Vec3>& positions, std::vector<Element>& elements)
{
    std::vector<int> number(positions.size(), -1);
    for (const Element& element : elements)
        for (const int v : element)
            number[v] = 0;
    int used = 0;
    for (size_t v = 0; v < number.size(); ++v)
        if (number[v] == 0) {
            positions[used] = positions[v];
            number[v] = used++;
        }
    positions.resize(used);
    for (Element& element : elements)
        for (int& v : element)
            v = number[v];
}

} // namespace

double volume_of(const Tet& tet, View<const Vec3> x)
{
    const Vec3& a = x[tet[0]];
    return (x[tet[1]] - a).cross(x[tet[2]] - a).dot(x[tet[3]] - a) / 6.0;
}

void orient(TetMesh& mesh, const std::function<std::string(int tet)>& name_of, const std::string& source)
{
    for (int t = 0; t < mesh.tet_count(); ++t) {
        const double volume = volume_of(mesh.tets[t], mesh.positions);
        if (volume == 0.0)
            throw InvalidInput(source + ": " + name_of(t) + " is flat; a tetrahedron has a volume");
        if (volume < 0.0) {
            std::swap(mesh.tets[t][2], mesh.tets[t][3]);
            ++mesh.turned;
        }
    }
    const std::vector<Face> faces = sorted_faces(mesh.tets);
    for (size_t i = 0; i + 1 < faces.size(); ++i)
        for (size_t j = i + 1; j < faces.size() && faces[j].key() == faces[i].key(); ++j)
            if (faces[i].has_same_side(faces[j]))
                throw InvalidInput(source + ": " + name_of(faces[i].tet) + " and " + name_of(faces[j].tet) +
                                   " lie on the same side of a face that they share; remove one of them");
}

std::vector<Triangle> boundary_triangles(View<const Tet> tets)
{
    const std::vector<Face> faces = sorted_faces(tets);
    std::vector<Triangle> boundary;
    for (size_t i = 0; i < faces.size();) {
        size_t end = i + 1;
        while (end < faces.size() && faces[end].key() == faces[i].key())
            ++end;
        if (end == i + 1)
            boundary.push_back(faces[i].corners);
        i = end;
    }
    return boundary;
}

void remove_unused_vertices(TetMesh& mesh) { keep_used(mesh.positions, mesh.tets); }

TriangleMesh boundary_surface(const TetMesh& mesh)
{
    TriangleMesh surface{mesh.positions, boundary_triangles(mesh.tets)};
    keep_used(surface.positions, surface.triangles);
    return surface;
}

} // namespace toile::volume
