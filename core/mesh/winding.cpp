#include "core/mesh/winding.h"

#include <algorithm>
#include <tuple>

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

std::vector<Side> sorted_sides(const std::vector<std::vector<int>>& faces)
{
    std::vector<Side> sides;
    for (size_t f = 0; f < faces.size(); ++f)
        for (size_t k = 0; k < faces[f].size(); ++k) {
            const int a = faces[f][k];
            const int b = faces[f][(k + 1) % faces[f].size()];
            sides.push_back({std::min(a, b), std::max(a, b), int(f), a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return sides;
}

std::vector<std::vector<Neighbour>> neighbours_of(const std::vector<std::vector<int>>& faces)
{
    std::vector<std::vector<Neighbour>> neighbours(faces.size());
    const std::vector<Side> sides = sorted_sides(faces);
    for (size_t begin = 0; begin < sides.size();) {
        size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low &&
               sides[end].high == sides[begin].high)
            ++end;
        if (end - begin == 2) {
            const Side &a = sides[begin], &b = sides[begin + 1];
            const bool agrees = a.ascending != b.ascending;
            neighbours[a.face].push_back({b.face, agrees});
            neighbours[b.face].push_back({a.face, agrees});
        }
        begin = end;
    }
    return neighbours;
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

/// Reverses a face from the same first corner, so that its fan of triangles stays the same.
void flip(std::vector<int>& corners) { std::reverse(corners.begin() + 1, corners.end()); }

} // namespace

int make_windings_agree(ObjMesh& mesh)
{
    const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(mesh.polygons);
    std::vector<char> visited(mesh.polygons.size(), 0), flipped(mesh.polygons.size(), 0);
    int flipped_count = 0;
    for (size_t f = 0; f < mesh.polygons.size(); ++f) {
        if (visited[f] != 0)
            continue;
        const std::vector<int> piece = flood(int(f), neighbours, visited, flipped);
        const auto differing =
            std::count_if(piece.begin(), piece.end(), [&](int face) { return flipped[face] != 0; });
        const bool keep_others = 2 * differing > std::ptrdiff_t(piece.size());
        for (const int face : piece) {
            if ((flipped[face] != 0) == keep_others)
                continue;
            flip(mesh.polygons[face]);
            if (!mesh.polygon_uvs.empty())
                flip(mesh.polygon_uvs[face]);
            ++flipped_count;
        }
    }
    return flipped_count;
}

} // namespace toile
