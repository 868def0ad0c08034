#include "garment/energy/curvature_stencil.h"

#include <algorithm>
#include <array>

#include <Eigen/Dense>

namespace toile::garment {

namespace {

/// Weight of the edge-averaged operator beside the exact fit [-]. The six points of a fit may lie nearly on a
/// conic. A larger weight is smoother there and less exact on irregular meshes.
constexpr double kAveragedWeight = 0.05;

/// Weights below this fraction of the stencil's largest are dropped [-]: on regular meshes the outer ring
/// cancels exactly, and dropping it halves the entries of H.
constexpr double kNegligibleWeight = 1e-10;

/// Corners of triangle t in its material axes.
std::array<Vec2, 3> flat_corners(const RestShape& rest, int t)
{
    return {Vec2(0.0, 0.0), Vec2(rest.edges[t].col(0)), Vec2(rest.edges[t].col(1))};
}

/// Neighbours of triangles; hinges are borders.
class Neighbours {
public:
    Neighbours(const RestShape& rest, const std::vector<int>& hinges)
        : topology_(rest.topology), is_hinge_(rest.topology.edges.size(), false)
    {
        for (const int edge : hinges)
            is_hinge_[edge] = true;
    }

    /// Triangle across edge k of t, or -1 at the border.
    int across(int t, int k) const
    {
        const int e = topology_.triangle_edge[t][k];
        const Edge& edge = topology_.edges[e];
        if (is_hinge_[e])
            return -1;
        return edge.triangle[0] == t ? edge.triangle[1] : edge.triangle[0];
    }

private:
    const Topology& topology_;
    std::vector<bool> is_hinge_; ///< [edges]
};

/// Index in triangle s of the edge that is edge k of its neighbour t.
int shared_edge(const RestShape& rest, int t, int k, int s)
{
    const std::array<int, 3>& edges = rest.topology.triangle_edge[s];
    return int(std::find(edges.begin(), edges.end(), rest.topology.triangle_edge[t][k]) - edges.begin());
}

/// Position of the vertex across edge k, unfolded into the plane of triangle t: same position along the
/// shared edge and same height above it. The handedness of each triangle is independent, so mirrored pattern
/// pieces unfold identically.
Vec2 unfold(const RestShape& rest, int t, int k, int s, int m)
{
    const std::array<Vec2, 3> ours = flat_corners(rest, t);
    const std::array<Vec2, 3> theirs = flat_corners(rest, s);
    const Vec2 their_edge = theirs[(m + 1) % 3] - theirs[m];
    const Vec2 to_flap = theirs[(m + 2) % 3] - theirs[m];
    const double along = their_edge.dot(to_flap) / their_edge.squaredNorm();
    const double height =
        std::abs(their_edge.x() * to_flap.y() - their_edge.y() * to_flap.x()) / their_edge.norm();

    // The edge is reversed in the neighbour: its corner m is our corner k + 1.
    const Vec2 our_edge = ours[k] - ours[(k + 1) % 3];
    Vec2 away = Vec2(-our_edge.y(), our_edge.x()).normalized();
    if (away.dot(ours[(k + 2) % 3] - ours[k]) > 0.0)
        away = -away;
    return ours[(k + 1) % 3] + along * our_edge + height * away;
}

/// Deviation of the vertex across an edge from the plane of the triangle, as weights on four vertices.
struct Deviation {
    std::array<int, 4> vertex{-1, -1, -1, -1}; ///< corners, then the vertex across; all -1 at the border
    Eigen::Vector4d weight = Eigen::Vector4d::Zero();
    double height = 0.0; ///< of the vertex above the edge [m]
};

/// The quadratic through a triangle and the opposite vertices of its neighbours. Across a border edge, where
/// there is no such vertex, it has no curvature. With equal rigidities no moment acts there then, as
/// Poisson's ratio is zero.
struct Fit {
    std::array<Deviation, 3> deviation;
    Mat3 slopes;  ///< fit's slopes across the edges, by deviations [1/m]
    Mat3 hessian; ///< (f_uu, f_uv, f_vv), by slopes [1/m]
};

Vec3 monomials(const Vec2& q) { return {0.5 * q.x() * q.x(), q.x() * q.y(), 0.5 * q.y() * q.y()}; }

Fit fit_triangle(const RestShape& rest, const Neighbours& neighbours, int t)
{
    const std::array<Vec2, 3> corner = flat_corners(rest, t);
    const Mat2 to_barycentric = rest.edges_inv[t];
    Fit result;
    Mat3 deviations = Mat3::Zero(); // of the opposite vertices, by second derivatives; 0 across borders
    Mat3 averaged = Mat3::Zero();   // second derivatives of the edge-averaged operator, by deviations
    for (int k = 0; k < 3; ++k) {
        const Vec2 edge = corner[(k + 1) % 3] - corner[k];
        Vec2 m = Vec2(edge.y(), -edge.x()).normalized();
        if (m.dot(corner[(k + 2) % 3] - corner[k]) > 0.0)
            m = -m;
        result.hessian.col(k) =
            edge.norm() / rest.areas[t] * Vec3(m.x() * m.x(), m.x() * m.y(), m.y() * m.y());

        const int s = neighbours.across(t, k);
        if (s < 0) {
            deviations.row(k) = rest.areas[t] * Vec3(m.x() * m.x(), 2.0 * m.x() * m.y(), m.y() * m.y());
            continue;
        }
        const int e = shared_edge(rest, t, k, s);
        const Vec2 p = unfold(rest, t, k, s, e);
        const Vec2 b = to_barycentric * p;
        const Vec3 barycentric(1.0 - b.sum(), b.x(), b.y());

        Deviation& far = result.deviation[k];
        far.vertex = {rest.triangles[t][0], rest.triangles[t][1], rest.triangles[t][2],
                      rest.triangles[s][(e + 2) % 3]};
        far.weight << -barycentric, 1.0;
        far.height = m.dot(p - corner[k]);
        averaged.col(k) = result.hessian.col(k) / (2.0 * far.height);
        deviations.row(k) = monomials(p);
        for (int i = 0; i < 3; ++i)
            deviations.row(k) -= barycentric[i] * monomials(corner[i]);
    }

    // min_S |deviations S - d|^2 + scale^2 |S - averaged d|^2; the triangle's area makes both terms lengths.
    const double scale = kAveragedWeight * rest.areas[t];
    const Mat3 normal = deviations.transpose() * deviations + scale * scale * Mat3::Identity();
    const Mat3 fitted = normal.ldlt().solve(deviations.transpose() + scale * scale * averaged);
    result.slopes = result.hessian.inverse() * fitted;
    return result;
}

/// Accumulates weights per vertex while a stencil is assembled.
class StencilSum {
public:
    void add(const Vec3& factor, const Deviation& deviation)
    {
        if (deviation.vertex[0] < 0)
            return;
        for (int i = 0; i < 4; ++i)
            column(deviation.vertex[i]) += deviation.weight[i] * factor;
    }

    CurvatureStencil stencil() const
    {
        double largest = 0.0;
        for (const Vec3& column : columns_)
            largest = std::max(largest, column.lpNorm<Eigen::Infinity>());
        CurvatureStencil result;
        result.weights.resize(3, 0);
        for (size_t i = 0; i < vertex_.size(); ++i) {
            if (columns_[i].lpNorm<Eigen::Infinity>() <= kNegligibleWeight * largest)
                continue;
            result.vertex.push_back(vertex_[i]);
            result.weights.conservativeResize(3, result.weights.cols() + 1);
            result.weights.rightCols<1>() = columns_[i];
        }
        return result;
    }

private:
    Vec3& column(int v)
    {
        const auto found = std::find(vertex_.begin(), vertex_.end(), v);
        if (found != vertex_.end())
            return columns_[found - vertex_.begin()];
        vertex_.push_back(v);
        columns_.push_back(Vec3::Zero());
        return columns_.back();
    }

    std::vector<int> vertex_;
    std::vector<Vec3> columns_;
};

CurvatureStencil assemble(const RestShape& rest, const Neighbours& neighbours, const std::vector<Fit>& fits,
                          int t)
{
    const Fit& fit = fits[t];
    StencilSum sum;
    for (int k = 0; k < 3; ++k) {
        const Vec3 hessian = fit.hessian.col(k);
        const int s = neighbours.across(t, k);
        const double fraction = s < 0 ? 1.0 : 0.5;
        for (int j = 0; j < 3; ++j)
            sum.add(fraction * fit.slopes(k, j) * hessian, fit.deviation[j]);
        if (s < 0)
            continue;

        sum.add(0.5 / fit.deviation[k].height * hessian, fit.deviation[k]);
        const int e = shared_edge(rest, t, k, s);
        for (int j = 0; j < 3; ++j)
            sum.add(-0.5 * fits[s].slopes(e, j) * hessian, fits[s].deviation[j]);
    }
    return sum.stencil();
}

} // namespace

std::vector<CurvatureStencil> curvature_stencils(const RestShape& rest, const std::vector<int>& hinges)
{
    const Neighbours neighbours(rest, hinges);
    const int triangles = int(rest.triangles.size());
    std::vector<Fit> fits;
    std::vector<CurvatureStencil> stencils;
    fits.reserve(triangles);
    stencils.reserve(triangles);
    for (int t = 0; t < triangles; ++t)
        fits.push_back(fit_triangle(rest, neighbours, t));
    for (int t = 0; t < triangles; ++t)
        stencils.push_back(assemble(rest, neighbours, fits, t));
    return stencils;
}

} // namespace toile::garment
