#include "volume/mesh/short_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "volume/mesh/quality.h"
#include "volume/mesh/vertex_freedom.h"

namespace toile::volume {

namespace {

/// Dihedral angle [degrees] down to which a collapse may lower the smallest of those around it.
constexpr double kSmallest = 8.0;

/// Vertices, edges and triangles, each ascending.
using Simplices = std::set<std::vector<int>>;

/// A mesh closed by tetrahedra between its surface and one more vertex outside, so that every vertex of the
/// mesh is an inner one.
class ClosedMesh {
public:
    /// @param length  [m] of edges that are short
    ClosedMesh(TetMesh& mesh, double length)
        : mesh_(mesh), length_(length), outside_(mesh.vertex_count()), tets_(mesh.tets),
          is_left_(mesh.tets.size(), 1), tets_of_(mesh.positions.size() + 1)
    {
        const std::vector<Triangle> surface = boundary_triangles(mesh.tets);
        freedom_ = vertex_freedom(mesh.positions, surface).of;
        for (const Triangle& t : surface)
            tets_.push_back({t[0], t[1], t[2], outside_});
        is_left_.resize(tets_.size(), 1);
        for (int t = 0; t < int(tets_.size()); ++t)
            for (const int v : tets_[t])
                tets_of_[v].push_back(t);
    }

    /// @return the number of edges that have collapsed
    int collapse()
    {
        std::set<std::tuple<double, int, int>> edges;
        for (int t = 0; t < int(tets_.size()); ++t)
            for (int k = 0; is_left_[t] && is_inside(t) && k < 6; ++k) {
                const auto [a, b] = std::minmax(tets_[t][kEdges[k][0]], tets_[t][kEdges[k][1]]);
                if (const double d = distance(a, b); d < length_)
                    edges.emplace(d, a, b);
            }
        int collapsed = 0;
        for (const auto& [d, a, b] : edges)
            collapsed += distance(a, b) == d && are_joined(a, b) && collapse(a, b) ? 1 : 0;
        return collapsed;
    }

    std::vector<Tet> tets() const
    {
        std::vector<Tet> left;
        for (int t = 0; t < int(tets_.size()); ++t)
            if (is_left_[t] && is_inside(t))
                left.push_back(tets_[t]);
        return left;
    }

private:
    static constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

    bool has(int t, int v) const { return std::find(tets_[t].begin(), tets_[t].end(), v) != tets_[t].end(); }
    bool is_inside(int t) const { return !has(t, outside_); }
    double distance(int a, int b) const { return (mesh_.positions[a] - mesh_.positions[b]).norm(); }

    bool are_joined(int a, int b) const
    {
        return std::any_of(tets_of_[a].begin(), tets_of_[a].end(),
                           [&](int t) { return is_left_[t] && has(t, b); });
    }

    /// Faces of the tetrahedra around vertices that do not have these vertices themselves.
    Simplices link(const std::vector<int>& vertices) const
    {
        Simplices link;
        for (const int t : tets_of_[vertices.front()]) {
            if (!is_left_[t] ||
                !std::all_of(vertices.begin(), vertices.end(), [&](int v) { return has(t, v); }))
                continue;
            std::vector<int> others;
            std::copy_if(tets_[t].begin(), tets_[t].end(), std::back_inserter(others), [&](int v) {
                return std::find(vertices.begin(), vertices.end(), v) == vertices.end();
            });
            std::sort(others.begin(), others.end());
            for (int bits = 1; bits < 1 << others.size(); ++bits) {
                std::vector<int> face;
                for (size_t k = 0; k < others.size(); ++k)
                    if (bits >> k & 1)
                        face.push_back(others[k]);
                link.insert(std::move(face));
            }
        }
        return link;
    }

    bool keeps_topology(int a, int b) const
    {
        const Simplices of_a = link({a}), of_b = link({b});
        Simplices common;
        std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                              std::inserter(common, common.end()));
        return common == link({a, b});
    }

    /// Smallest dihedral angle of the tetrahedra at a vertex, of those only that do not have `other` too;
    /// 0 if one is inside out.
    double smallest_angle(int v, int other) const
    {
        double smallest = 180.0;
        for (const int t : tets_of_[v]) {
            if (!is_left_[t] || !is_inside(t) || has(t, other))
                continue;
            if (!(volume_of(tets_[t], mesh_.positions) > 0.0))
                return 0.0;
            smallest = std::min(smallest, smallest_dihedral(tets_[t], mesh_.positions));
        }
        return smallest;
    }

    /// Of the tetrahedra at a vertex, of those only that do not have `other` too [m^3].
    double volume_at(int v, int other) const
    {
        double volume = 0.0;
        for (const int t : tets_of_[v])
            if (is_left_[t] && is_inside(t) && !has(t, other))
                volume += volume_of(tets_[t], mesh_.positions);
        return volume;
    }

    /// Corners of the surface triangle of a tetrahedron outside, when `from` has become `to`.
    std::array<int, 3> surface_triangle(int t, int from, int to) const
    {
        std::array<int, 3> triangle;
        std::copy_if(tets_[t].begin(), tets_[t].end(), triangle.begin(),
                     [&](int v) { return v != outside_; });
        std::replace(triangle.begin(), triangle.end(), from, to);
        return triangle;
    }

    /// True if the segment from p to q passes through the triangle.
    bool crosses(int p, int q, const std::array<int, 3>& triangle) const
    {
        const auto [a, b, c] = triangle;
        const View<const Vec3> x = mesh_.positions;
        if (volume_of({a, b, c, p}, x) * volume_of({a, b, c, q}, x) >= 0.0)
            return false;
        const auto [least, most] =
            std::minmax({volume_of({p, q, a, b}, x), volume_of({p, q, b, c}, x), volume_of({p, q, c, a}, x)});
        return least > 0.0 || most < 0.0;
    }

    /// True if an edge of the first triangle without a corner of the other passes through that.
    bool edges_cross(const std::array<int, 3>& edges, const std::array<int, 3>& triangle) const
    {
        const auto is_free = [&](int v) {
            return std::find(triangle.begin(), triangle.end(), v) == triangle.end();
        };
        for (int k = 0; k < 3; ++k)
            if (const int p = edges[k], q = edges[(k + 1) % 3];
                is_free(p) && is_free(q) && crosses(p, q, triangle))
                return true;
        return false;
    }

    /// True if the surface at a vertex that has moved to another crosses the surface elsewhere.
    bool crosses_surface(int from, int to) const
    {
        std::vector<std::array<int, 3>> moved;
        Eigen::AlignedBox3d box;
        for (const int t : tets_of_[from])
            if (is_left_[t] && !is_inside(t) && !has(t, to)) {
                moved.push_back(surface_triangle(t, from, to));
                for (const int v : moved.back())
                    box.extend(mesh_.positions[v]);
            }
        for (const int t : tets_of_[outside_]) {
            if (moved.empty() || !is_left_[t] || (has(t, from) && has(t, to)))
                continue;
            const std::array<int, 3> other = surface_triangle(t, from, to);
            Eigen::AlignedBox3d around;
            for (const int v : other)
                around.extend(mesh_.positions[v]);
            if (box.intersects(around) && std::any_of(moved.begin(), moved.end(), [&](const auto& triangle) {
                    return edges_cross(triangle, other) || edges_cross(other, triangle);
                }))
                return true;
        }
        return false;
    }

    bool collapse(int a, int b)
    {
        if (!keeps_topology(a, b))
            return false;
        if (freedom_[a] < freedom_[b])
            return move(b, a);
        return move(a, b) || (freedom_[a] == freedom_[b] && move(b, a));
    }

    /// Moves a vertex to another, with which it becomes one. @return false if shapes do not allow it
    bool move(int from, int to)
    {
        const double before = std::min(smallest_angle(from, outside_), smallest_angle(to, from));
        const double volume = volume_at(from, outside_);
        const Vec3 at = std::exchange(mesh_.positions[from], mesh_.positions[to]);
        const double angle = smallest_angle(from, to);
        const double change = std::fabs(volume_at(from, to) - volume);
        if (!(angle > 0.0 && angle >= std::min(before, kSmallest) && change <= std::pow(length_, 3) &&
              !crosses_surface(from, to))) {
            mesh_.positions[from] = at;
            return false;
        }
        for (const int t : tets_of_[from]) {
            if (has(t, to)) {
                is_left_[t] = 0;
                continue;
            }
            std::replace(tets_[t].begin(), tets_[t].end(), from, to);
            tets_of_[to].push_back(t);
        }
        tets_of_[from].clear();
        return true;
    }

    TetMesh& mesh_;
    double length_; ///< [m] of edges that are short
    int outside_;   ///< number of the vertex outside
    std::vector<Tet> tets_;
    std::vector<unsigned char> is_left_;    ///< [tets]
    std::vector<std::vector<int>> tets_of_; ///< [vertices + 1]
    std::vector<Freedom> freedom_;
};

} // namespace

void collapse_short_edges(TetMesh& mesh, double length)
{
    ClosedMesh closed(mesh, length);
    while (closed.collapse() > 0)
        ;
    mesh.tets = closed.tets();
    remove_unused_vertices(mesh);
}

} // namespace toile::volume
