#include "garment/pattern/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"

namespace toile::garment {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

int pieces(double length, double resolution) { return std::max(1, int(std::lround(length / resolution))); }

/// A closed ring of evenly spaced vertices.
struct Ring {
    int first = 0;
    int count = 1;
    double shift = 0.0; ///< angle of the first vertex, in vertex spacings

    int vertex(int k) const { return first + k % count; }
    /// Middle between vertices k and k + 1 [revolutions].
    double middle(int k) const { return (k + 0.5 + shift) / count; }
};

/// Deviation of a skirt's hem from its circle over the radius [-] at an angle, the same in every run. A cone
/// in perfect symmetry would not fold: dry friction in the weave holds what rounding starts.
double unevenness(double angle)
{
    constexpr double kLargest = 0.002;
    constexpr int kWaves[] = {5, 8, 11, 13};
    double sum = 0.0;
    for (const int n : kWaves)
        sum += std::sin(n * angle + n * n);
    return 0.25 * kLargest * sum;
}

/// Triangulates the band between two rings by advancing on the ring that is behind in angle.
void bridge_rings(const Ring& inner, const Ring& outer, std::vector<Triangle>& out)
{
    int i = 0, o = 0;
    while (i < inner.count || o < outer.count) {
        const int from_inner = inner.vertex(i), from_outer = outer.vertex(o);
        const bool advance_outer =
            i == inner.count || (o < outer.count && outer.middle(o) <= inner.middle(i));
        if (advance_outer)
            out.emplace_back(from_inner, outer.vertex(++o), from_outer);
        else
            out.emplace_back(from_inner, inner.vertex(++i), from_outer);
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
    Ring inner;
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
            bridge_rings(inner, {first, count}, mesh.triangles);
        inner = {first, count};
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
    Ring above;
    for (int r = 0; r <= rows; ++r) {
        const double along = double(r) / rows;
        const double radius = cut.waist_radius + along * flare;
        const Ring ring{mesh.vertex_count(), std::max(6, pieces(kTwoPi * radius, cut.resolution)),
                        0.5 * (r % 2)};
        for (int k = 0; k < ring.count; ++k) {
            const double angle = kTwoPi * (k + ring.shift) / ring.count;
            const double uneven = radius * (1.0 + along * unevenness(angle));
            mesh.positions.emplace_back(uneven * std::cos(angle), -along * drop, uneven * std::sin(angle));
        }
        if (r > 0)
            bridge_rings(above, ring, mesh.triangles);
        above = ring;
    }
    return mesh;
}

} // namespace toile::garment
