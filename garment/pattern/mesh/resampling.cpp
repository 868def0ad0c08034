#include "garment/pattern/mesh/resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace toile::garment {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Point of a triangle nearest to another.
struct NearestPoint {
    double distance2 = std::numeric_limits<double>::infinity(); ///< [m^2]
    int triangle = -1;
    Vec3 weights = Vec3::Zero();
};

/// Point of the side from corner k to the next that is nearest to x.
NearestPoint nearest_on_side(const PatternMesh& mesh, int triangle, int k, const Vec2& x)
{
    const Triangle& t = mesh.triangles[triangle];
    const Vec2 &a = mesh.uv[t[k]], &b = mesh.uv[t[(k + 1) % 3]];
    const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    NearestPoint point{(x - a - s * (b - a)).squaredNorm(), triangle};
    point.weights[k] = 1.0 - s;
    point.weights[(k + 1) % 3] = s;
    return point;
}

NearestPoint nearest_on_triangle(const PatternMesh& mesh, int triangle, const Vec2& x)
{
    const Triangle& t = mesh.triangles[triangle];
    const double area = cross(mesh.uv[t[1]] - mesh.uv[t[0]], mesh.uv[t[2]] - mesh.uv[t[0]]);
    Vec3 weights;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &b = mesh.uv[t[(k + 1) % 3]], &c = mesh.uv[t[(k + 2) % 3]];
        weights[k] = cross(b - x, c - x) / area;
    }
    if (weights.minCoeff() >= 0.0)
        return {0.0, triangle, weights / weights.sum()};
    NearestPoint nearest;
    for (int k = 0; k < 3; ++k)
        if (const NearestPoint point = nearest_on_side(mesh, triangle, k, x);
            point.distance2 < nearest.distance2)
            nearest = point;
    return nearest;
}

/// Triangles of a panel by the square cells that their bounding boxes meet.
class TriangleGrid {
public:
    TriangleGrid(const PatternMesh& mesh, int panel) : mesh_(mesh), cell_(2.0 * mesh.edge[panel])
    {
        const int first = mesh.first_vertex[panel], last = mesh.first_vertex[panel + 1];
        Vec2 upper = mesh.uv[first];
        lower_ = upper;
        for (int v = first; v < last; ++v) {
            lower_ = lower_.cwiseMin(mesh.uv[v]);
            upper = upper.cwiseMax(mesh.uv[v]);
        }
        columns_ = cell_of(upper).x() + 1;
        rows_ = cell_of(upper).y() + 1;
        cells_.resize(size_t(columns_) * rows_);
        for (int t = mesh.first_triangle[panel]; t < mesh.first_triangle[panel + 1]; ++t)
            add(t);
    }

    NearestPoint nearest(const Vec2& x) const
    {
        const Eigen::Vector2i middle = clamped(cell_of(x));
        NearestPoint best;
        // A ring of cells further out is at least that many cells less one away.
        for (int ring = 0; ring <= std::max(columns_, rows_); ++ring) {
            const double distance = (ring - 1) * cell_;
            if (ring > 0 && best.triangle >= 0 && best.distance2 <= distance * distance)
                break;
            if (best.distance2 == 0.0)
                break;
            search_ring(middle, ring, x, best);
        }
        return best;
    }

private:
    Eigen::Vector2i cell_of(const Vec2& x) const
    {
        return {int(std::floor((x.x() - lower_.x()) / cell_)), int(std::floor((x.y() - lower_.y()) / cell_))};
    }
    Eigen::Vector2i clamped(const Eigen::Vector2i& cell) const
    {
        return {std::clamp(cell.x(), 0, columns_ - 1), std::clamp(cell.y(), 0, rows_ - 1)};
    }

    void add(int triangle)
    {
        const Triangle& t = mesh_.triangles[triangle];
        const Vec2 &a = mesh_.uv[t[0]], &b = mesh_.uv[t[1]], &c = mesh_.uv[t[2]];
        const Eigen::Vector2i low = cell_of(a.cwiseMin(b).cwiseMin(c));
        const Eigen::Vector2i high = cell_of(a.cwiseMax(b).cwiseMax(c));
        for (int row = low.y(); row <= high.y(); ++row)
            for (int column = low.x(); column <= high.x(); ++column)
                cells_[size_t(row) * columns_ + column].push_back(triangle);
    }

    void search_ring(const Eigen::Vector2i& middle, int ring, const Vec2& x, NearestPoint& best) const
    {
        for (int row = std::max(0, middle.y() - ring); row <= std::min(rows_ - 1, middle.y() + ring); ++row) {
            const bool is_whole = std::abs(row - middle.y()) == ring;
            for (int column = middle.x() - ring; column <= middle.x() + ring;
                 column += is_whole || ring == 0 ? 1 : 2 * ring)
                if (column >= 0 && column < columns_)
                    search_cell(cells_[size_t(row) * columns_ + column], x, best);
        }
    }

    void search_cell(const std::vector<int>& triangles, const Vec2& x, NearestPoint& best) const
    {
        for (const int t : triangles)
            if (const NearestPoint point = nearest_on_triangle(mesh_, t, x); point.distance2 < best.distance2)
                best = point;
    }

    const PatternMesh& mesh_;
    double cell_; ///< [m]
    Vec2 lower_;
    int columns_ = 0, rows_ = 0;
    std::vector<std::vector<int>> cells_;
};

/// [vertices] triangle with the outline's edge from this vertex to the next; -1 inside
std::vector<int> outline_triangles(const PatternMesh& mesh)
{
    std::vector<int> next(mesh.vertex_count(), -1), result(mesh.vertex_count(), -1);
    for (const auto& panel : mesh.edge_vertices)
        for (const auto& edge : panel)
            for (size_t i = 0; i + 1 < edge.size(); ++i)
                next[edge[i].vertex] = edge[i + 1].vertex;
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k)
            if (const int a = mesh.triangles[t][k]; next[a] == mesh.triangles[t][(k + 1) % 3])
                result[a] = t;
    return result;
}

/// Samples the vertices of one edge by arc length.
void sample_edge(const PatternMesh& coarse, const std::vector<int>& triangles,
                 const std::vector<EdgeVertex>& from, const std::vector<EdgeVertex>& to, Resampling& result)
{
    size_t i = 0;
    for (const EdgeVertex& vertex : to) {
        while (i + 2 < from.size() && from[i + 1].fraction < vertex.fraction)
            ++i;
        const EdgeVertex &a = from[i], &b = from[i + 1];
        const double s = std::clamp((vertex.fraction - a.fraction) / (b.fraction - a.fraction), 0.0, 1.0);
        const int t = triangles[a.vertex];
        const Triangle& corners = coarse.triangles[t];
        Vec3 weights = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            weights[k] = corners[k] == a.vertex ? 1.0 - s : corners[k] == b.vertex ? s : 0.0;
        result.triangle[vertex.vertex] = t;
        result.weights[vertex.vertex] = weights;
    }
}

void require_one_pattern(const PatternMesh& coarse, const PatternMesh& fine)
{
    bool is_one = coarse.panel_count() == fine.panel_count();
    for (int p = 0; is_one && p < coarse.panel_count(); ++p)
        is_one = coarse.edge_vertices[p].size() == fine.edge_vertices[p].size();
    if (!is_one)
        throw InvalidUse("resample: the meshes differ in panels or edges; both must be of one pattern");
}

} // namespace

Resampling resample(const PatternMesh& coarse, const PatternMesh& fine)
{
    require_one_pattern(coarse, fine);
    Resampling result{std::vector<int>(fine.vertex_count(), -1),
                      std::vector<Vec3>(fine.vertex_count(), Vec3::Zero())};
    const std::vector<int> triangles = outline_triangles(coarse);
    for (int p = 0; p < fine.panel_count(); ++p) {
        for (size_t e = 0; e < fine.edge_vertices[p].size(); ++e)
            sample_edge(coarse, triangles, coarse.edge_vertices[p][e], fine.edge_vertices[p][e], result);

        const TriangleGrid grid(coarse, p);
        for (int v = fine.first_vertex[p]; v < fine.first_vertex[p + 1]; ++v) {
            if (result.triangle[v] >= 0)
                continue;
            const NearestPoint nearest = grid.nearest(fine.uv[v]);
            result.triangle[v] = nearest.triangle;
            result.weights[v] = nearest.weights;
        }
    }
    return result;
}

} // namespace toile::garment
