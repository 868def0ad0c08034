#include "core/mesh/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include <Eigen/Geometry>

namespace toile {

namespace {

/// Side of a face, with its end points in ascending order for matching.
struct Side {
    int low, high;
    int face;
    bool ascending; ///< the face runs along it from low to high
};

/// Neighbour of a face across an edge.
struct Neighbour {
    int face;
    bool agrees; ///< it runs along the shared edge in the opposite direction
};

/// True for a triangle with a repeated corner: it has no neighbours.
template <typename Face>
bool is_collapsed(const Face& face)
{
    return int(face.size()) == 3 && (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]);
}

/// @tparam Face  container of vertex indices
template <typename Face>
std::vector<Side> sorted_sides(const std::vector<Face>& faces)
{
    std::vector<Side> sides;
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < int(faces[f].size()) && !is_collapsed(faces[f]); ++k) {
            const int a = faces[f][k];
            const int b = faces[f][(k + 1) % int(faces[f].size())];
            sides.push_back({std::min(a, b), std::max(a, b), int(f), a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return sides;
}

using Sides = std::vector<Side>::iterator;

/// Joins nothing where three or more faces share an edge.
constexpr auto kNoPair = [](Sides, Sides) { return false; };

/// @param pair_at_branch  moves the two of three or more sides of an edge that continue each other to the
///                        front; false if none do
template <typename Face, typename PairAtBranch>
std::vector<std::vector<Neighbour>> neighbours_of(const std::vector<Face>& faces,
                                                  const PairAtBranch& pair_at_branch)
{
    std::vector<std::vector<Neighbour>> neighbours(faces.size());
    std::vector<Side> sides = sorted_sides(faces);
    for (auto begin = sides.begin(); begin != sides.end();) {
        auto end = begin + 1;
        while (end != sides.end() && end->low == begin->low && end->high == begin->high)
            ++end;
        if (end - begin == 2 || (end - begin > 2 && pair_at_branch(begin, end))) {
            const Side &a = *begin, &b = *(begin + 1);
            const bool agrees = a.ascending != b.ascending;
            neighbours[a.face].push_back({b.face, agrees});
            neighbours[b.face].push_back({a.face, agrees});
        }
        begin = end;
    }
    return neighbours;
}

/// Direction from an edge into a polygon, perpendicular to the edge.
Vec3 inward(const ObjMesh& mesh, const Side& side)
{
    const Vec3& low = mesh.positions[side.low];
    Vec3 mean = Vec3::Zero();
    for (const int v : mesh.polygons[side.face])
        mean += (mesh.positions[v] - low) / double(mesh.polygons[side.face].size());
    const Vec3 along = (mesh.positions[side.high] - low).normalized();
    return (mean - mean.dot(along) * along).normalized();
}

/// Moves the two that continue each other most straightly to the front. Always true: there are two.
bool pair_flattest(const ObjMesh& mesh, Sides begin, Sides end)
{
    double flattest = 2.0;
    Sides first = begin, second = begin + 1;
    for (Sides a = begin; a != end; ++a)
        for (Sides b = a + 1; b != end; ++b)
            if (const double cosine = inward(mesh, *a).dot(inward(mesh, *b)); cosine < flattest) {
                flattest = cosine;
                first = a;
                second = b;
            }
    std::iter_swap(begin, first);
    std::iter_swap(begin + 1, second);
    return true;
}

/// Piece that contains `first`; marks in `flipped` its faces that disagree with `first`.
std::vector<int> flood(int first, const std::vector<std::vector<Neighbour>>& neighbours,
                       std::vector<char>& visited, std::vector<char>& flipped)
{
    std::vector<int> piece{first};
    visited[first] = 1;
    for (size_t next = 0; next < piece.size(); ++next)
        for (const Neighbour& neighbour : neighbours[piece[next]]) {
            if (visited[neighbour.face] != 0)
                continue;
            visited[neighbour.face] = 1;
            flipped[neighbour.face] = char((flipped[piece[next]] != 0) == neighbour.agrees);
            piece.push_back(neighbour.face);
        }
    return piece;
}

/// Faces joined by edges, and which of them differ from the majority.
struct Piece {
    std::vector<int> faces;
    std::vector<int> differing;
    bool is_closed = true; ///< every edge joins two faces
};

template <typename Face>
std::vector<Piece> pieces_of(const std::vector<Face>& faces,
                             const std::vector<std::vector<Neighbour>>& neighbours)
{
    std::vector<char> visited(faces.size(), 0), flipped(faces.size(), 0);
    std::vector<Piece> pieces;
    for (size_t f = 0; f < faces.size(); ++f) {
        if (visited[f] != 0)
            continue;
        Piece piece;
        piece.faces = flood(int(f), neighbours, visited, flipped);
        const auto differing = std::count_if(piece.faces.begin(), piece.faces.end(),
                                             [&](int face) { return flipped[face] != 0; });
        const bool keep_others = 2 * differing > std::ptrdiff_t(piece.faces.size());
        for (const int face : piece.faces) {
            if ((flipped[face] != 0) != keep_others)
                piece.differing.push_back(face);
            piece.is_closed = piece.is_closed && neighbours[face].size() == faces[face].size();
        }
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

} // namespace

int branching_edges(const ObjMesh& mesh)
{
    const std::vector<Side> sides = sorted_sides(mesh.polygons);
    const auto is_same = [&](size_t a, size_t b) {
        return sides[a].low == sides[b].low && sides[a].high == sides[b].high;
    };
    int count = 0;
    for (size_t i = 2; i < sides.size(); ++i) // the third of each edge
        count += is_same(i - 2, i) && (i == 2 || !is_same(i - 3, i)) ? 1 : 0;
    return count;
}

std::optional<std::array<int, 2>> one_sided_polygons(const ObjMesh& mesh)
{
    const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(mesh.polygons, kNoPair);
    for (size_t f = 0; f < neighbours.size(); ++f)
        for (const Neighbour& neighbour : neighbours[f])
            if (!neighbour.agrees)
                return std::array<int, 2>{int(f), neighbour.face};
    return std::nullopt;
}

namespace {

/// Reverses a face from the same first corner, so that a convex one is split as before.
void flip(std::vector<int>& corners) { std::reverse(corners.begin() + 1, corners.end()); }
void flip(Triangle& corners) { std::swap(corners[1], corners[2]); }

/// Min volume of a piece over the cube of its bounding box's diagonal [-], below which it has no inside.
constexpr double kThinnest = 1e-9;

/// A closed piece of a body.
struct Solid {
    const std::vector<int>* faces;
    Bounds box;
    double volume; ///< [m^3] negative: inside out

    bool is_inside_out() const { return volume < -kThinnest * std::pow(box.diagonal(), 3); }
};

Solid solid_of(const TriangleMesh& mesh, const Piece& piece)
{
    Solid solid{&piece.faces, {}, 0.0};
    for (const int t : piece.faces)
        for (const int v : mesh.triangles[t])
            solid.box.extend(mesh.positions[v]);
    const Vec3 origin = solid.box.center(); // near the solid, so that little cancels
    for (const int t : piece.faces) {
        const Triangle& corner = mesh.triangles[t];
        const Vec3 a = mesh.positions[corner[0]] - origin, b = mesh.positions[corner[1]] - origin,
                   c = mesh.positions[corner[2]] - origin;
        solid.volume += a.dot(b.cross(c)) / 6.0;
    }
    return solid;
}

/// True if p lies in a solid: its triangles cover the full solid angle seen from there [van Oosterom and
/// Strackee 1983, The solid angle of a plane triangle].
bool encloses(const TriangleMesh& mesh, const Solid& solid, const Vec3& p)
{
    if ((p.array() < solid.box.lower.array()).any() || (p.array() > solid.box.upper.array()).any())
        return false;
    double angle = 0.0;
    for (const int t : *solid.faces) {
        const Triangle& corner = mesh.triangles[t];
        const Vec3 a = mesh.positions[corner[0]] - p, b = mesh.positions[corner[1]] - p,
                   c = mesh.positions[corner[2]] - p;
        const double x = a.norm(), y = b.norm(), z = c.norm();
        angle += 2.0 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
    }
    return std::fabs(angle) > 2.0 * std::numbers::pi;
}

} // namespace

int make_windings_agree(ObjMesh& mesh)
{
    int count = 0;
    const auto flattest = [&](Sides begin, Sides end) { return pair_flattest(mesh, begin, end); };
    for (const Piece& piece : pieces_of(mesh.polygons, neighbours_of(mesh.polygons, flattest)))
        for (const int face : piece.differing) {
            flip(mesh.polygons[face]);
            if (!mesh.polygon_uvs.empty())
                flip(mesh.polygon_uvs[face]);
            ++count;
        }
    return count;
}

int face_outwards(TriangleMesh& mesh)
{
    const std::vector<Piece> pieces = pieces_of(mesh.triangles, neighbours_of(mesh.triangles, kNoPair));
    const std::vector<Triangle> before = mesh.triangles;
    std::vector<Solid> solids;
    for (const Piece& piece : pieces) {
        for (const int t : piece.differing)
            flip(mesh.triangles[t]);
        if (piece.is_closed)
            solids.push_back(solid_of(mesh, piece));
    }
    std::stable_sort(solids.begin(), solids.end(), [](const Solid& a, const Solid& b) {
        return std::fabs(a.volume) > std::fabs(b.volume);
    });
    const bool any_inside_out =
        std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.is_inside_out(); });
    std::vector<char> turned(solids.size(), 0);
    for (size_t i = 0; any_inside_out && i < solids.size(); ++i) {
        const Vec3& inner = mesh.positions[mesh.triangles[solids[i].faces->front()][0]];
        size_t outer = 0; // the largest that encloses it
        while (outer < i && !encloses(mesh, solids[outer], inner))
            ++outer;
        turned[i] = char(outer < i ? turned[outer] : solids[i].is_inside_out());
    }
    for (size_t i = 0; i < solids.size(); ++i)
        for (const int t : *solids[i].faces)
            if (turned[i] != 0)
                flip(mesh.triangles[t]);
    int count = 0;
    for (size_t t = 0; t < before.size(); ++t)
        count += mesh.triangles[t] != before[t] ? 1 : 0;
    return count;
}

} // namespace toile
