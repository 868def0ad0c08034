#include "garment/energy/fold/fold_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace toile::garment {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Angle from half a turn within which an edge counts as folded flat where nothing tells on which side [rad].
constexpr double kFlat = 1e-3;

/// Bound of the angle's second derivative by the triangles' Laplacians of weight 1 / height^2 [-]: 0.662 is
/// the largest value of 40 000 random shapes.
constexpr double kSecondDerivative = 0.7;

using Block = Eigen::Matrix<double, 12, 12>;

void require_valid(const RestShape& rest, const FoldEdge& fold, const std::string& source)
{
    const int count = int(rest.topology.edges.size());
    const auto refuse = [&](const std::string& what) {
        throw InvalidInput(source + ": fold of edge " + std::to_string(fold.edge) + ": " + what);
    };
    if (fold.edge < 0 || fold.edge >= count)
        refuse("there are " + std::to_string(count) + " edges");
    if (rest.topology.edges[fold.edge].is_border())
        refuse("it is at the border; a fold lies between two triangles");
    if (!(std::abs(fold.angle) <= std::numbers::pi))
        refuse("angle = " + std::to_string(fold.angle) + " rad; it must be from -pi to pi");
    if (!(fold.stiffness > 0.0) || !std::isfinite(fold.stiffness))
        refuse("stiffness = " + std::to_string(fold.stiffness) + " N; it must be positive");
}

/// Triangle over one of its edges, at rest.
struct RestFlap {
    double length; ///< [m] of the edge
    double t;      ///< [-] along the edge at which the height meets it
    double height; ///< [m] over the edge
    double least_height;

    /// @param k  corner at which the edge starts
    RestFlap(const RestShape& rest, int triangle, int k)
    {
        const Mat2& edges = rest.edges[triangle];
        const std::array<Vec2, 3> corner{Vec2(0.0, 0.0), Vec2(edges.col(0)), Vec2(edges.col(1))};
        const Vec2 edge = corner[(k + 1) % 3] - corner[k], to_tip = corner[(k + 2) % 3] - corner[k];
        length = edge.norm();
        t = edge.dot(to_tip) / edge.squaredNorm();
        height = 2.0 * rest.areas[triangle] / length;
        const double longest =
            std::max({length, to_tip.norm(), (corner[(k + 2) % 3] - corner[(k + 1) % 3]).norm()});
        least_height = 2.0 * rest.areas[triangle] / longest;
    }
};

/// Corner of a triangle at which an edge starts.
int corner_of(const RestShape& rest, int triangle, int edge)
{
    const std::array<int, 3>& edges = rest.topology.triangle_edge[triangle];
    return int(std::find(edges.begin(), edges.end(), edge) - edges.begin());
}

} // namespace

FoldLines::Fold FoldLines::fold_of(const RestShape& rest, const FoldEdge& fold)
{
    const Edge& edge = rest.topology.edges[fold.edge];
    const RestFlap a(rest, edge.triangle[0], corner_of(rest, edge.triangle[0], fold.edge));
    const RestFlap b(rest, edge.triangle[1], corner_of(rest, edge.triangle[1], fold.edge));
    Fold made;
    made.vertex = {edge.vertex[0], edge.vertex[1], edge.opposite[0], edge.opposite[1]};
    made.weight[0] = {(a.t - 1.0) / a.height, -a.t / a.height, 1.0 / a.height, 0.0};
    made.weight[1] = {-b.t / b.height, (b.t - 1.0) / b.height, 0.0, 1.0 / b.height};
    made.height = {a.least_height, b.least_height};
    made.rest_angle = fold.angle;
    made.stiffness = fold.stiffness * 0.5 * (a.length + b.length);
    return made;
}

double FoldLines::Fold::angle_near_start(View<const Vec3> x) const
{
    const double angle = dihedral_angle(corners(x));
    return angle + kTurn * std::round((start - angle) / kTurn);
}

FoldLines::FoldLines(const RestShape& rest, const std::vector<FoldEdge>& folds, View<const Vec3> x,
                     const std::string& source)
{
    for (const FoldEdge& fold : folds) {
        require_valid(rest, fold, source);
        folds_.push_back(fold_of(rest, fold));
    }
    restart(x);
}

void FoldLines::begin_step(View<const Vec3> x)
{
    for (Fold& fold : folds_)
        fold.start = fold.angle_near_start(x);
}

void FoldLines::restart(View<const Vec3> x)
{
    for (Fold& fold : folds_) {
        fold.start = dihedral_angle(fold.corners(x));
        if (std::abs(fold.start) > std::numbers::pi - kFlat && fold.start * fold.rest_angle < 0.0)
            fold.start += std::copysign(kTurn, fold.rest_angle);
    }
}

void FoldLines::add_hessian(Triplets& H) const
{
    for (const Fold& fold : folds_) {
        Eigen::Matrix4d block = Eigen::Matrix4d::Zero();
        const double largest = std::numbers::pi + std::abs(fold.rest_angle); // change of the angle [rad]
        for (int triangle = 0; triangle < 2; ++triangle) {
            // |g_a + g_b|^2 is at most 2 |g_a|^2 + 2 |g_b|^2, for any two normals.
            const Eigen::Map<const Eigen::Vector4d> weight(fold.weight[triangle].data());
            block += 2.0 * weight * weight.transpose();
            Eigen::Vector4d is_corner = Eigen::Vector4d::Ones();
            is_corner[3 - triangle] = 0.0;
            const Eigen::Matrix4d laplacian =
                3.0 * Eigen::Matrix4d(is_corner.asDiagonal()) - is_corner * is_corner.transpose();
            block +=
                largest * kSecondDerivative / (fold.height[triangle] * fold.height[triangle]) * laplacian;
        }
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                H.emplace_back(fold.vertex[i], fold.vertex[j], fold.stiffness * block(i, j));
    }
}

double FoldLines::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    double value = 0.0;
    for (const Fold& fold : folds_) {
        const double change = fold.angle_near_start(x) - fold.rest_angle;
        const std::array<Vec3, 4> of_angle = dihedral_gradient(fold.corners(x));
        for (int i = 0; i < 4; ++i)
            gradient[fold.vertex[i]] += fold.stiffness * change * of_angle[i];
        value += 0.5 * fold.stiffness * change * change;
    }
    return value;
}

void FoldLines::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    for (const Fold& fold : folds_)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                couplings.emplace_back(fold.vertex[i], fold.vertex[j]);
}

void FoldLines::add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K)
{
    for (const Fold& fold : folds_) {
        const DihedralDerivatives angle = dihedral_derivatives(fold.corners(x));
        Block block = angle.gradient * angle.gradient.transpose();
        if (definiteness == Definiteness::Exact)
            block += (fold.angle_near_start(x) - fold.rest_angle) * angle.hessian;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                K.block(fold.vertex[i], fold.vertex[j]) += fold.stiffness * block.block<3, 3>(3 * i, 3 * j);
    }
}

} // namespace toile::garment
