#include "avatars/mannequin/polygonise.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/topology.h"

namespace toile::avatars {

namespace {

/// Passes of vertex relaxation. The triangles' worst angle stops improving after about ten.
constexpr int kRelaxPasses = 12;

/// Step of the difference quotient for the field's gradient [m].
constexpr double kGradientStep = 1e-4;

/// Grid points around the shape. x = 0 is a plane of grid points, which keeps the mesh nearly symmetric.
struct Grid {
    double h; ///< [m]
    Vec3 lower;
    std::array<int, 3> size; ///< points along x, y, z

    Grid(double spacing, const Vec3& extent) : h(spacing)
    {
        const int half_x = int(std::ceil(extent.x() / h));
        const int half_z = int(std::ceil(extent.z() / h));
        lower = {-half_x * h, -2.35 * h, -half_z * h};
        size = {2 * half_x + 1, int(std::ceil(extent.y() / h)) + 5, 2 * half_z + 1};
    }
    int count() const { return size[0] * size[1] * size[2]; }
    int index(int x, int y, int z) const { return (z * size[1] + y) * size[0] + x; }
    int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size[0] : size[0] * size[1]; }
    Vec3 point(int i) const
    {
        const int layer = i / (size[0] * size[1]);
        return lower + h * Vec3(i % size[0], (i / size[0]) % size[1], layer);
    }
};

struct SampleShape {
    const MannequinShape& shape;
    const Grid& grid;
    View<double> value; // [grid points] out [m]

    void operator()(int i) const { value[i] = shape.distance(grid.point(i)); }
};

/// Lowest inside corner that each inside corner of a cell reaches along cell edges through inside corners.
/// Cell corners are numbered by bits: 1 = +x, 2 = +y, 4 = +z.
std::array<int, 8> inside_parts(const std::array<double, 8>& value)
{
    std::array<int, 8> part;
    for (int c = 0; c < 8; ++c)
        part[c] = value[c] < 0.0 ? c : -1;
    for (int pass = 0; pass < 4; ++pass)
        for (int c = 0; c < 8; ++c)
            for (int bit = 1; bit < 8; bit <<= 1)
                if (const int other = c ^ bit; part[c] >= 0 && part[other] >= 0)
                    part[c] = part[other] = std::min(part[c], part[other]);
    return part;
}

/// Creates a vertex per inside part of every cell that the surface crosses, and a quad around every crossed
/// grid edge.
class SurfaceNets {
public:
    SurfaceNets(const Grid& grid, View<const double> value)
        : grid_(grid), value_(value), vertex_of_(8 * size_t(grid.count()), -1)
    {
        for (int z = 0; z + 1 < grid.size[2]; ++z)
            for (int y = 0; y + 1 < grid.size[1]; ++y)
                for (int x = 0; x + 1 < grid.size[0]; ++x)
                    place_cell_vertices(grid.index(x, y, z));
        for (int z = 1; z + 1 < grid.size[2]; ++z)
            for (int y = 1; y + 1 < grid.size[1]; ++y)
                for (int x = 1; x + 1 < grid.size[0]; ++x)
                    for (int axis = 0; axis < 3; ++axis)
                        add_quad(grid.index(x, y, z), axis);
    }

    TriangleMesh mesh;

private:
    int corner_point(int cell, int corner) const
    {
        return cell + (corner & 1 ? grid_.stride(0) : 0) + (corner & 2 ? grid_.stride(1) : 0) +
               (corner & 4 ? grid_.stride(2) : 0);
    }

    void place_cell_vertices(int cell)
    {
        std::array<double, 8> value;
        for (int c = 0; c < 8; ++c)
            value[c] = value_[corner_point(cell, c)];
        const std::array<int, 8> part = inside_parts(value);

        // The vertex of each part is the mean of the crossings on its edges.
        std::array<Vec3, 8> sum;
        std::array<int, 8> crossings{};
        sum.fill(Vec3::Zero());
        for (int c = 0; c < 8; ++c)
            for (int bit = 1; bit < 8; bit <<= 1) {
                const int other = c ^ bit;
                if (part[c] < 0 || part[other] >= 0)
                    continue;
                const double fraction = value[c] / (value[c] - value[other]);
                const Vec3 from = grid_.point(corner_point(cell, c));
                const Vec3 to = grid_.point(corner_point(cell, other));
                sum[part[c]] += from + fraction * (to - from);
                ++crossings[part[c]];
            }
        for (int c = 0; c < 8; ++c) {
            if (part[c] < 0 || crossings[part[c]] == 0)
                continue;
            if (part[c] == c) {
                vertex_of_[8 * size_t(cell) + c] = mesh.vertex_count();
                mesh.positions.push_back(sum[c] / crossings[c]);
            }
            vertex_of_[8 * size_t(cell) + c] = vertex_of_[8 * size_t(cell) + part[c]];
        }
    }

    /// Adds the quad of the four cells around the grid edge from point p along `axis`, split along its
    /// shorter diagonal.
    void add_quad(int p, int axis)
    {
        const int q = p + grid_.stride(axis);
        if ((value_[p] < 0.0) == (value_[q] < 0.0))
            return;
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const int inside_bit = value_[p] < 0.0 ? 0 : 1 << axis;

        // Visit the cells in cyclic order about the axis; the inside end is this corner of each of them.
        const std::array<std::array<int, 2>, 4> back{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
        std::array<int, 4> v;
        for (int k = 0; k < 4; ++k) {
            const int cell = p - back[k][0] * grid_.stride(b) - back[k][1] * grid_.stride(c);
            const int corner = inside_bit | back[k][0] << b | back[k][1] << c;
            v[k] = vertex_of_[8 * size_t(cell) + corner];
        }
        if (value_[p] >= 0.0)
            std::swap(v[1], v[3]);
        const auto length = [&](int i, int j) {
            return (mesh.positions[v[i]] - mesh.positions[v[j]]).norm();
        };
        const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
        mesh.triangles.emplace_back(v[first], v[first + 1], v[first + 2]);
        mesh.triangles.emplace_back(v[first], v[first + 2], v[(first + 3) % 4]);
    }

    const Grid& grid_;
    View<const double> value_;
    std::vector<int> vertex_of_; ///< [8 * cells] vertex of the inside part at a cell's corner
};

/// One relaxation pass: moves a vertex towards the mean of its neighbours along the surface, then back onto
/// the field by Newton's method.
struct RelaxVertices {
    const MannequinShape& shape;
    View<const Vec3> x;
    View<const Triangle> triangles;
    const Incidence& corners;
    View<Vec3> relaxed; // [vertices] out [m]

    void operator()(int v) const
    {
        // Average the incident triangles' centroids by area: this evens out areas, not only angles.
        Vec3 sum = Vec3::Zero();
        double total = 0.0;
        for (const int corner : corners.of(v)) {
            const Triangle& t = triangles[corner / 3];
            const double area = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
            sum += area * (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0;
            total += area;
        }
        Vec3 move = sum / total - x[v];

        const Vec3 g = gradient(x[v]);
        move -= move.dot(g) / g.squaredNorm() * g;
        const Vec3 moved = x[v] + 0.7 * move;
        relaxed[v] = moved - shape.distance(moved) / g.squaredNorm() * g;
    }

    Vec3 gradient(const Vec3& p) const
    {
        Vec3 g;
        for (int k = 0; k < 3; ++k) {
            const Vec3 step = kGradientStep * Vec3::Unit(k);
            g[k] = (shape.distance(p + step) - shape.distance(p - step)) / (2.0 * kGradientStep);
        }
        return g;
    }
};

} // namespace

TriangleMesh polygonise(const MannequinShape& shape, double edge_length)
{
    const Loft& arm = shape.arm();
    const double reach = std::max(arm.center(0.76).x(), 0.25) + 0.05;
    const Grid grid(edge_length, {reach, kMannequinHeight + 0.02, 0.30});
    std::vector<double> value(grid.count());
    parallel_for(kCpu, "avatars/mannequin_field", grid.count(), SampleShape{shape, grid, value});
    TriangleMesh mesh = SurfaceNets(grid, value).mesh;

    const Topology topology = build_topology(mesh.triangles, mesh.vertex_count(), "mannequin");
    if (!topology.is_closed())
        throw InvalidInput("mannequin: the surface is not closed at this edge_length; make it smaller");
    std::vector<Vec3> relaxed(mesh.positions.size());
    for (int pass = 0; pass < kRelaxPasses; ++pass) {
        parallel_for(
            kCpu, "avatars/mannequin_relax", mesh.vertex_count(),
            RelaxVertices{shape, mesh.positions, mesh.triangles, topology.corners_of_vertex, relaxed});
        mesh.positions.swap(relaxed);
    }
    return mesh;
}

} // namespace toile::avatars
