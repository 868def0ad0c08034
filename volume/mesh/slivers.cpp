#include "volume/mesh/slivers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "volume/mesh/quality.h"
#include "volume/mesh/vertex_freedom.h"

namespace toile::volume {

namespace {

/// Passes over the slivers; halvings of a search's step, which begins with kReach of the shortest edge.
constexpr int kPasses = 8, kHalvings = 6;
constexpr double kReach = 0.25;

/// Angle at the edge between two surface faces [degrees] from which on a tetrahedron may be peeled off.
constexpr double kFlat = 155.0;

/// Directions of the search: along the axes, and along the diagonals of a cube.
std::vector<Vec3> search_directions()
{
    std::vector<Vec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if ((x + y + z) % 2 != 0)
                    directions.push_back(Vec3(x, y, z).normalized());
    return directions;
}

bool is_sliver(const Tet& tet, View<const Vec3> x) { return smallest_dihedral(tet, x) < kSliver; }

using Edge = std::pair<int, int>;
Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Moves the vertices of slivers.
class Improvement {
public:
    /// @param surface  of the mesh
    Improvement(TetMesh& mesh, View<const Triangle> surface)
        : mesh_(mesh), tets_of_(mesh.positions.size()), freedom_(vertex_freedom(mesh.positions, surface))
    {
        for (int t = 0; t < mesh.tet_count(); ++t)
            for (const int v : mesh.tets[t])
                tets_of_[v].push_back(t);
    }

    /// @return true if an angle has become larger
    bool move_vertices()
    {
        std::set<int> at_slivers;
        for (const Tet& tet : mesh_.tets)
            if (is_sliver(tet, mesh_.positions))
                at_slivers.insert(tet.begin(), tet.end());
        bool has_moved = false;
        for (const int v : at_slivers)
            if (freedom_.of[v] != Freedom::None)
                has_moved = improve(v) || has_moved;
        return has_moved;
    }

private:
    double smallest_around(int v) const
    {
        double smallest = 180.0;
        for (const int t : tets_of_[v]) {
            if (!(volume_of(mesh_.tets[t], mesh_.positions) > 0.0))
                return 0.0;
            smallest = std::min(smallest, smallest_dihedral(mesh_.tets[t], mesh_.positions));
        }
        return smallest;
    }

    double shortest_edge(int v) const
    {
        double shortest = std::numeric_limits<double>::infinity();
        for (const int t : tets_of_[v])
            for (const int w : mesh_.tets[t])
                if (w != v)
                    shortest = std::min(shortest, (mesh_.positions[w] - mesh_.positions[v]).norm());
        return shortest;
    }

    bool improve(int v)
    {
        Vec3& x = mesh_.positions[v];
        const Vec3 normal = freedom_.normal[v].normalized();
        const double before = smallest_around(v);
        double largest = before, step = kReach * shortest_edge(v);
        for (int k = 0; k < kHalvings; ++k, step *= 0.5) {
            const Vec3 centre = x;
            Vec3 best = centre;
            for (Vec3 direction : directions_) {
                if (freedom_.of[v] == Freedom::Plane)
                    direction -= normal * normal.dot(direction);
                x = centre + step * direction;
                if (const double angle = smallest_around(v); angle > largest) {
                    largest = angle;
                    best = x;
                }
            }
            x = best;
        }
        return largest > before;
    }

    TetMesh& mesh_;
    std::vector<std::vector<int>> tets_of_;
    VertexFreedom freedom_; ///< of the surface at the start
    const std::vector<Vec3> directions_ = search_directions();
};

/// Corners of a tetrahedron's two surface faces: those of their common edge first.
/// @return false if it has not just two surface faces
bool find_roof(const Tet& tet, const std::set<std::array<int, 3>>& faces, std::array<int, 4>& roof)
{
    std::vector<int> across; // corners opposite to surface faces
    for (int k = 0; k < 4; ++k) {
        std::array<int, 3> face;
        std::copy_if(tet.begin(), tet.end(), face.begin(), [&](int v) { return v != tet[k]; });
        std::sort(face.begin(), face.end());
        if (faces.count(face) != 0)
            across.push_back(k);
    }
    if (across.size() != 2)
        return false;
    roof[2] = tet[across[0]];
    roof[3] = tet[across[1]];
    std::copy_if(tet.begin(), tet.end(), roof.begin(), [&](int v) { return v != roof[2] && v != roof[3]; });
    return true;
}

/// Peels off flat tetrahedra. @return true if there are any
bool peel(TetMesh& mesh, View<const Triangle> surface)
{
    std::set<std::array<int, 3>> faces;
    std::set<Edge> edges;
    std::vector<unsigned char> is_outer(mesh.positions.size(), 0);
    for (const Triangle& t : surface) {
        std::array<int, 3> face{t[0], t[1], t[2]};
        std::sort(face.begin(), face.end());
        faces.insert(face);
        for (int k = 0; k < 3; ++k) {
            edges.insert(edge_of(t[k], t[(k + 1) % 3]));
            is_outer[t[k]] = 1;
        }
    }
    std::set<int> touched; // vertices of peeled ones: their neighbours wait for the next pass
    const size_t before = mesh.tets.size();
    std::erase_if(mesh.tets, [&](const Tet& tet) {
        std::array<int, 4> roof;
        const bool is_outside = std::all_of(tet.begin(), tet.end(), [&](int v) { return is_outer[v] != 0; });
        if (!is_outside || !is_sliver(tet, mesh.positions) || !find_roof(tet, faces, roof))
            return false;
        const Vec3 &a = mesh.positions[roof[0]], &b = mesh.positions[roof[1]];
        const bool is_flat = dihedral_angle(a, b, mesh.positions[roof[2]], mesh.positions[roof[3]]) > kFlat;
        if (!is_flat || edges.count(edge_of(roof[2], roof[3])) != 0 ||
            std::any_of(tet.begin(), tet.end(), [&](int v) { return touched.count(v) != 0; }))
            return false;
        touched.insert(tet.begin(), tet.end());
        return true;
    });
    return mesh.tets.size() < before;
}

} // namespace

void improve_slivers(TetMesh& mesh)
{
    std::vector<Triangle> surface = boundary_triangles(mesh.tets);
    for (int pass = 0; pass < kPasses; ++pass) {
        const bool has_peeled = peel(mesh, surface);
        if (has_peeled)
            surface = boundary_triangles(mesh.tets);
        const bool has_moved = Improvement(mesh, surface).move_vertices();
        if (!has_peeled && !has_moved)
            break;
    }
    remove_unused_vertices(mesh);
}

} // namespace toile::volume
