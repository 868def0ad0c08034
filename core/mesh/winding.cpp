#include "core/mesh/winding.h"

#include <algorithm>
#include <tuple>

namespace toile {

namespace {

/// One side of a face, with its end points in ascending order for matching.
struct Side {
    int low, high;
    int face;
    bool ascending; ///< the face runs it from low to high
};

/// A face across an edge.
struct Neighbour {
    int face;
    bool agrees; ///< it runs the shared edge the other way
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

/// The piece around `first`, and in `turned` which of its faces differ from it.
std::vector<int> flood(int first, const std::vector<std::vector<Neighbour>>& neighbours,
                       std::vector<char>& visited, std::vector<char>& turned)
{
    std::vector<int> piece{first};
    visited[first] = 1;
    for (size_t next = 0; next < piece.size(); ++next)
        for (const Neighbour& neighbour : neighbours[piece[next]]) {
            if (visited[neighbour.face] != 0)
                continue;
            visited[neighbour.face] = 1;
            turned[neighbour.face] = char((turned[piece[next]] != 0) == neighbour.agrees);
            piece.push_back(neighbour.face);
        }
    return piece;
}

/// The other way round from the same first corner, so that a face's fan of triangles stays the same.
void turn(std::vector<int>& corners) { std::reverse(corners.begin() + 1, corners.end()); }

} // namespace

int make_windings_agree(ObjMesh& mesh)
{
    const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(mesh.polygons);
    std::vector<char> visited(mesh.polygons.size(), 0), turned(mesh.polygons.size(), 0);
    int turned_count = 0;
    for (size_t f = 0; f < mesh.polygons.size(); ++f) {
        if (visited[f] != 0)
            continue;
        const std::vector<int> piece = flood(int(f), neighbours, visited, turned);
        const auto differing =
            std::count_if(piece.begin(), piece.end(), [&](int face) { return turned[face] != 0; });
        const bool keep_others = 2 * differing > std::ptrdiff_t(piece.size());
        for (const int face : piece) {
            if ((turned[face] != 0) == keep_others)
                continue;
            turn(mesh.polygons[face]);
            if (!mesh.polygon_uvs.empty())
                turn(mesh.polygon_uvs[face]);
            ++turned_count;
        }
    }
    return turned_count;
}

} // namespace toile
