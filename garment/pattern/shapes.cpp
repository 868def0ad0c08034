#include "garment/pattern/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/backend/error.h"

namespace toile {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

int pieces(double length, double resolution) { return std::max(1, int(std::lround(length / resolution))); }

/// Triangulates the band between two closed rings of vertices by advancing on the ring that is behind in
/// angle.
void bridge_rings(int inner_first, int inner_count, int outer_first, int outer_count,
                  std::vector<Triangle>& out)
{
    int i = 0, o = 0;
    while (i < inner_count || o < outer_count) {
        const int inner = inner_first + i % inner_count, outer = outer_first + o % outer_count;
        const bool advance_outer = i == inner_count || (o < outer_count && double(o + 0.5) / outer_count <=
                                                                               double(i + 0.5) / inner_count);
        if (advance_outer)
            out.emplace_back(inner, outer_first + (o++ + 1) % outer_count, outer);
        else
            out.emplace_back(inner, inner_first + (i++ + 1) % inner_count, outer);
    }
}

} // namespace

TriangleMesh cut_rectangle(const Vec2& size, double resolution)
{
    const int columns = pieces(size.x(), resolution), rows = pieces(size.y(), resolution);
    TriangleMesh mesh;
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c)
            mesh.positions.emplace_back((double(c) / columns - 0.5) * size.x(), 0.0,
                                        (double(r) / rows - 0.5) * size.y());
    const auto at = [&](int c, int r) { return r * (columns + 1) + c; };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int a = at(c, r), b = at(c + 1, r), d = at(c, r + 1), e = at(c + 1, r + 1);
            if ((r + c) % 2 == 0)
                mesh.triangles.insert(mesh.triangles.end(), {Triangle(a, d, e), Triangle(a, e, b)});
            else
                mesh.triangles.insert(mesh.triangles.end(), {Triangle(a, d, b), Triangle(b, d, e)});
        }
    return mesh;
}

TriangleMesh cut_disc(double radius, double resolution)
{
    const int rings = pieces(radius, resolution);
    TriangleMesh mesh;
    mesh.positions.push_back(Vec3::Zero());
    int inner_first = 0, inner_count = 1;
    for (int ring = 1; ring <= rings; ++ring) {
        const int count = 6 * ring, first = mesh.vertex_count();
        for (int k = 0; k < count; ++k) {
            const double angle = kTwoPi * k / count;
            mesh.positions.emplace_back(radius * ring / rings * std::cos(angle), 0.0,
                                        radius * ring / rings * std::sin(angle));
        }
        if (ring == 1)
            for (int k = 0; k < count; ++k)
                mesh.triangles.emplace_back(0, first + (k + 1) % count, first + k);
        else
            bridge_rings(inner_first, inner_count, first, count, mesh.triangles);
        inner_first = first;
        inner_count = count;
    }
    return mesh;
}

TriangleMesh cut_skirt(const SkirtCut& cut)
{
    const double flare = cut.hem_radius - cut.waist_radius;
    if (!(flare >= 0.0) || !(cut.length > flare))
        throw InvalidInput("skirt: hem_radius " + std::to_string(cut.hem_radius) +
                           " m must lie between waist_radius " + std::to_string(cut.waist_radius) +
                           " m and waist_radius + length");
    const double drop = std::sqrt(cut.length * cut.length - flare * flare);
    const int rows = pieces(cut.length, cut.resolution);
    TriangleMesh mesh;
    int above_first = 0, above_count = 0;
    for (int r = 0; r <= rows; ++r) {
        const double along = double(r) / rows;
        const double radius = cut.waist_radius + along * flare;
        const int count = std::max(6, pieces(kTwoPi * radius, cut.resolution)), first = mesh.vertex_count();
        for (int k = 0; k < count; ++k) {
            const double angle = kTwoPi * (k + 0.5 * (r % 2)) / count;
            mesh.positions.emplace_back(radius * std::cos(angle), -along * drop, radius * std::sin(angle));
        }
        if (r > 0)
            bridge_rings(above_first, above_count, first, count, mesh.triangles);
        above_first = first;
        above_count = count;
    }
    return mesh;
}

} // namespace toile
