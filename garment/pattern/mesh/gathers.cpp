#include "garment/pattern/mesh/gathers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/base/assert.h"
#include "garment/pattern/mesh/material_coordinates.h"
#include "garment/pattern/seam_measure.h"

namespace toile::garment {

namespace {

/// Fraction of the strain on the seam that vertices beside it have [-].
constexpr double kFade = 0.5;

/// Least information about a direction of strain [-], in sewn edges: two edges at more than 45 degrees have
/// strains of their own, nearer ones a mean. Lower values let edges that are almost parallel, but differ,
/// ask for large strains across.
constexpr double kMinInformation = 0.5;

/// Area of a triangle whose edges agree with its neighbours' over that by its own strain [-], below which it
/// takes the latter.
constexpr double kMinAreaRatio = 0.5;

using Ends = std::array<int, 2>; ///< vertices of an edge, ascending

Ends ends_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Edge of an outline or a line that is sewn.
struct SewnEdge {
    Ends ends;
    Vec2 direction;      ///< [-] unit
    double length = 0.0; ///< [m] in the panel
    double target = 0.0; ///< [m] at rest

    bool is_strained() const { return target != length; }
    double log_stretch() const { return std::log(target / length); }
};

/// Neighbours along the outlines of panels and the lines inside of them.
class Neighbours {
public:
    explicit Neighbours(const PatternMesh& mesh) : next_(size_t(mesh.vertex_count()), -1)
    {
        for (const auto& panel : mesh.edge_vertices)
            for (const auto& edge : panel)
                for (size_t i = 0; i + 1 < edge.size(); ++i)
                    next_[edge[i].vertex] = edge[i + 1].vertex;
        for (const auto& panel : mesh.panel_lines)
            for (const auto& line : panel)
                for (size_t i = 0; i + 1 < line.size(); ++i)
                    on_lines_.insert(ends_of(line[i].vertex, line[i + 1].vertex));
    }

    bool are(int a, int b) const
    {
        return next_[a] == b || next_[b] == a || on_lines_.contains(ends_of(a, b));
    }

    /// The vertex after a on its outline, if b comes next; -1: it does not.
    int between(int a, int b) const
    {
        const int tip = next_[a];
        return tip >= 0 && next_[tip] == b ? tip : -1;
    }

private:
    std::vector<int> next_; ///< [vertices] along the outline; -1 inside of it
    std::set<Ends> on_lines_;
};

/// [vertices] whether they are joined to another
std::vector<bool> are_stitched(const PatternMesh& mesh)
{
    std::vector<bool> stitched(size_t(mesh.vertex_count()), false);
    for (const auto& seam : mesh.stitches)
        for (const auto& [a, b] : seam)
            stitched[a] = stitched[b] = true;
    return stitched;
}

/// Pairs of outline edges that a seam joins, each from one stitch to the next. [pairs][sides][ends]
std::vector<std::array<Ends, 2>> sewn_pairs(const std::vector<std::array<int, 2>>& stitches,
                                            const Neighbours& neighbours, const std::vector<bool>& stitched)
{
    std::vector<std::array<Ends, 2>> pairs;
    for (size_t i = 0; i + 1 < stitches.size(); ++i) {
        const auto &low = stitches[i], &high = stitches[i + 1];
        if (neighbours.are(low[0], high[0]) && neighbours.are(low[1], high[1]))
            pairs.push_back({ends_of(low[0], high[0]), ends_of(low[1], high[1])});
    }
    // The tip of a dart meets itself and has no stitch. Openings have more than one vertex.
    for (const auto& [a, b] : stitches)
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
            if (const int tip = neighbours.between(from, to); tip >= 0 && !stitched[tip])
                pairs.push_back({ends_of(a, tip), ends_of(b, tip)});
    return pairs;
}

using SidesOfEdge = std::array<SewnEdge, 2>; ///< both sides of an edge of the sewn surface

/// @param pairs  sewn_pairs()
std::vector<SidesOfEdge> sides_of(const std::vector<std::array<Ends, 2>>& pairs, const PatternMesh& mesh)
{
    std::vector<SidesOfEdge> edges;
    for (const auto& pair : pairs) {
        SidesOfEdge& sides = edges.emplace_back();
        for (int k = 0; k < 2; ++k) {
            const Vec2 e = mesh.uv[pair[k][1]] - mesh.uv[pair[k][0]];
            sides[k] = {pair[k], e.normalized(), e.norm(), e.norm()};
        }
    }
    return edges;
}

bool has_shrinking_panel(const Pattern& pattern, const Seam& seam)
{
    for (const auto* side : {&seam.a, &seam.b})
        for (const EdgePart& part : *side)
            if (shrinks(pattern.panels[size_t(part.panel)]))
                return true;
    return false;
}

/// Lengths of the sides of a seam, and whether they are sewn as they are.
struct SideLengths {
    double a = 0.0, b = 0.0; ///< [m]
    bool are_even = true;
};

SideLengths cut_lengths(const Pattern& pattern, const Seam& seam)
{
    const SeamMeasure measure = measure_seam(pattern, seam);
    return {measure.length_a, measure.length_b, measure.ratio() < 1.0 + kEvenSides};
}

/// Sides that shrink by one ratio in all can do so by different ones along the seam.
SideLengths shrunk_lengths(const std::vector<SidesOfEdge>& edges)
{
    SideLengths lengths;
    for (const auto& [a, b] : edges) {
        lengths.a += a.length;
        lengths.b += b.length;
        lengths.are_even = lengths.are_even &&
                           std::max(a.length, b.length) < (1.0 + kEvenSides) * std::min(a.length, b.length);
    }
    return lengths;
}

/// Side of a seam that keeps its length; none if both are equally long.
std::optional<int> kept_side(const SideLengths& lengths, Gather gather)
{
    if (lengths.are_even)
        return std::nullopt;
    const int shorter = lengths.a < lengths.b ? 0 : 1;
    return gather == Gather::Short ? shorter : 1 - shorter;
}

std::vector<SewnEdge> sewn_edges(const Pattern& pattern, const PatternMesh& mesh)
{
    const Neighbours neighbours(mesh);
    const std::vector<bool> stitched = are_stitched(mesh);
    std::vector<SewnEdge> edges;
    for (size_t s = 0; s < mesh.stitches.size(); ++s) {
        const Seam& seam = pattern.seams[s];
        std::vector<SidesOfEdge> seam_edges =
            sides_of(sewn_pairs(mesh.stitches[s], neighbours, stitched), mesh);
        const std::optional<int> kept = kept_side(
            has_shrinking_panel(pattern, seam) ? shrunk_lengths(seam_edges) : cut_lengths(pattern, seam),
            seam.gather);
        for (SidesOfEdge& sides : seam_edges) {
            if (kept)
                sides[1 - *kept].target = sides[*kept].length;
            edges.insert(edges.end(), sides.begin(), sides.end());
        }
    }
    return edges;
}

// --- strain at vertices ---

/// f of the principal values of a symmetric matrix.
template <typename F>
Mat2 of_principal_values(const Mat2& symmetric, const F& f)
{
    const Eigen::SelfAdjointEigenSolver<Mat2> eigen(symmetric);
    return eigen.eigenvectors() * eigen.eigenvalues().unaryExpr(f).asDiagonal() *
           eigen.eigenvectors().transpose();
}

/// Least symmetric H with d^T H d = log_stretch for the given edges, in the mean where they disagree. [-]
Mat2 least_strain(const std::vector<SewnEdge>& edges, const std::vector<int>& given)
{
    // Normal equations of (h_xx, h_yy, sqrt(2) h_xy), whose norm is that of H.
    Mat3 normal = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (const int i : given) {
        const Vec2& d = edges[i].direction;
        const Vec3 row(d.x() * d.x(), d.y() * d.y(), std::numbers::sqrt2 * d.x() * d.y());
        normal += row * row.transpose();
        right += edges[i].log_stretch() * row;
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(normal);
    Vec3 h = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        if (eigen.eigenvalues()[k] > kMinInformation) {
            const Vec3 axis = eigen.eigenvectors().col(k);
            h += axis * (axis.dot(right) / eigen.eigenvalues()[k]);
        }
    const double xy = h[2] / std::numbers::sqrt2;
    return (Mat2() << h[0], xy, xy, h[1]).finished();
}

/// Strain of vertices on gathered seams and beside them. [vertices]; none elsewhere
std::vector<std::optional<Mat2>> vertex_strains(const PatternMesh& mesh, const std::vector<SewnEdge>& edges)
{
    // Sewn edges that each vertex ends, if one of them is strained.
    std::vector<std::vector<int>> at(size_t(mesh.vertex_count()));
    std::vector<bool> is_gathered(size_t(mesh.vertex_count()), false);
    for (int i = 0; i < int(edges.size()); ++i)
        for (const int v : edges[i].ends) {
            at[v].push_back(i);
            is_gathered[v] = is_gathered[v] || edges[i].is_strained();
        }

    // Those of gathered vertices that are one edge of the mesh away.
    std::vector<std::vector<int>> near(size_t(mesh.vertex_count()));
    for (const Triangle& t : mesh.triangles)
        for (const int v : t)
            for (const int other : t)
                if (!is_gathered[v] && is_gathered[other])
                    near[v].insert(near[v].end(), at[other].begin(), at[other].end());

    std::vector<std::optional<Mat2>> strains(size_t(mesh.vertex_count()));
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        std::sort(near[v].begin(), near[v].end());
        near[v].erase(std::unique(near[v].begin(), near[v].end()), near[v].end());
        if (is_gathered[v])
            strains[v] = least_strain(edges, at[v]);
        else if (!near[v].empty())
            strains[v] = kFade * least_strain(edges, near[v]);
    }
    return strains;
}

// --- triangles ---

/// Triangle with what is given about its rest shape. Side k goes from corner k to the next.
struct GatheredTriangle {
    FlatTriangle flat;                            ///< [m]
    std::array<Mat2, 3> strain;                   ///< [-] of its corners
    std::array<std::optional<double>, 3> targets; ///< [m] lengths of sides that are sewn

    Vec2 side(int k) const { return flat[(k + 1) % 3] - flat[k]; }
    int sewn_count() const
    {
        return int(
            std::count_if(targets.begin(), targets.end(), [](const auto& t) { return t.has_value(); }));
    }
};

/// Lengths of the sides by the strain of their ends. [m]
std::array<double, 3> compatible_lengths(const GatheredTriangle& triangle)
{
    std::array<Mat2, 3> C;
    for (int k = 0; k < 3; ++k)
        C[k] = of_principal_values(triangle.strain[k], [](double h) { return std::exp(2.0 * h); });
    std::array<double, 3> lengths;
    for (int k = 0; k < 3; ++k) {
        const Vec2 e = triangle.side(k);
        lengths[k] = triangle.targets[k].value_or(std::sqrt(0.5 * e.dot((C[k] + C[(k + 1) % 3]) * e)));
    }
    return lengths;
}

/// Deformation by the mean strain of the corners. [-]
Mat2 mean_deformation(const GatheredTriangle& triangle)
{
    const Mat2 mean = (triangle.strain[0] + triangle.strain[1] + triangle.strain[2]) / 3.0;
    return of_principal_values(mean, [](double h) { return std::exp(h); });
}

/// Lengths of the sides by one deformation of the triangle, but for sewn sides; one at least is not sewn. [m]
std::array<double, 3> affine_lengths(const GatheredTriangle& triangle, const Mat2& F)
{
    // Sewn sides get their length along the direction that they have. A single one takes the triangle along.
    std::array<Vec2, 3> sides;
    int free = 0;
    for (int k = 0; k < 3; ++k) {
        sides[k] = F * triangle.side(k);
        free = triangle.targets[k] ? free : k;
    }
    for (int k = 0; k < 3; ++k) {
        if (!triangle.targets[k])
            continue;
        const Vec2 u = sides[k].normalized();
        const double stretch = *triangle.targets[k] / sides[k].norm();
        sides[k] = *triangle.targets[k] * u;
        if (triangle.sewn_count() == 1)
            for (const int other : {(k + 1) % 3, (k + 2) % 3})
                sides[other] += (stretch - 1.0) * u.dot(sides[other]) * u;
    }
    sides[free] = -sides[(free + 1) % 3] - sides[(free + 2) % 3];
    return {sides[0].norm(), sides[1].norm(), sides[2].norm()};
}

/// Inner products of the first two sides of a triangle with these lengths. Its determinant is four times the
/// squared area [m^4], and not positive if there is no such triangle. [m^2]
Mat2 gram_matrix(const std::array<double, 3>& lengths)
{
    const double a = lengths[0] * lengths[0], b = lengths[1] * lengths[1], c = lengths[2] * lengths[2];
    const double ab = 0.5 * (c - a - b);
    return (Mat2() << a, ab, ab, b).finished();
}

/// Inner products by lengths that neighbours agree about, unless the triangle would collapse.
Mat2 rest_gram_matrix(const GatheredTriangle& triangle)
{
    TOILE_ASSERT(triangle.sewn_count() < 3); // narrow panels have shorter edges: none is a single triangle
    Mat2 compatible = gram_matrix(compatible_lengths(triangle));
    const Mat2 F = mean_deformation(triangle);
    const double area = F.determinant() * std::abs(signed_area(triangle.flat));
    if (compatible.determinant() >= 4.0 * std::pow(kMinAreaRatio * area, 2))
        return compatible;
    return gram_matrix(affine_lengths(triangle, F));
}

/// The triangle with the given inner products of its first two sides, which is the flat one deformed without
/// rotation about its centroid.
FlatTriangle shape_of(const GatheredTriangle& triangle, const Mat2& gram)
{
    // (F D)^T F D = gram, F symmetric.
    const Mat2 D = (Mat2() << triangle.side(0), triangle.side(1)).finished();
    const Mat2 inverse = D.inverse();
    const Mat2 F = of_principal_values(inverse.transpose() * gram * inverse,
                                       [](double value) { return std::sqrt(value); });
    const Vec2 centroid = (triangle.flat[0] + triangle.flat[1] + triangle.flat[2]) / 3.0;
    FlatTriangle shape;
    for (int k = 0; k < 3; ++k)
        shape[k] = centroid + F * (triangle.flat[k] - centroid);
    return shape;
}

/// @param mesh  at rest, before gathering
std::vector<FlatTriangle> gather(const Pattern& pattern, const PatternMesh& mesh)
{
    const std::vector<SewnEdge> edges = sewn_edges(pattern, mesh);
    const std::vector<std::optional<Mat2>> strains = vertex_strains(mesh, edges);
    std::map<Ends, double> targets;
    for (const SewnEdge& edge : edges)
        targets[edge.ends] = edge.target;

    std::vector<FlatTriangle> rest;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& corner = mesh.triangles[t];
        GatheredTriangle triangle;
        bool is_strained = false;
        for (int k = 0; k < 3; ++k) {
            triangle.flat[k] = mesh.uv[corner[k]];
            triangle.strain[k] = strains[corner[k]].value_or(Mat2::Zero());
            is_strained = is_strained || strains[corner[k]];
            if (const auto target = targets.find(ends_of(corner[k], corner[(k + 1) % 3]));
                target != targets.end())
                triangle.targets[k] = target->second;
        }
        if (!is_strained) {
            rest.push_back(triangle.flat);
            continue;
        }
        rest.push_back(shape_of(triangle, rest_gram_matrix(triangle)));
    }
    return rest;
}

} // namespace

std::vector<FlatTriangle> gathered_rest(const Pattern& pattern, const PatternMesh& mesh)
{
    PatternMesh at_rest = mesh;
    at_rest.uv = material_coordinates(pattern, mesh);
    return gather(pattern, at_rest);
}

} // namespace toile::garment
