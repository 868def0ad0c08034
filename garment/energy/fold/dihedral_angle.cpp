#include "garment/energy/fold/dihedral_angle.h"

#include <cmath>

#include <Eigen/Geometry>

namespace toile::garment {

namespace {

Mat3 cross_matrix(const Vec3& v)
{
    Mat3 M;
    M << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return M;
}

/// Term of a triangle over the edge from `start` to `end`: q = n / h on its tip, and -(1 - t) q and -t q on
/// the ends, t where its height meets the edge.
struct Flap {
    Vec3 edge, to_tip, normal; ///< normal: edge x to_tip [m^2]
    double length = 0.0;       ///< [m] of the edge
    double t = 0.0;            ///< [-]
    Vec3 q = Vec3::Zero();     ///< [1/m]
    bool has_area = false;

    Flap(const Vec3& start, const Vec3& end, const Vec3& tip)
        : edge(end - start), to_tip(tip - start), normal(edge.cross(to_tip)), length(edge.norm())
    {
        has_area = normal.squaredNorm() > 0.0;
        if (!has_area)
            return;
        t = edge.dot(to_tip) / (length * length);
        q = length / normal.squaredNorm() * normal;
    }

    std::array<double, 3> weights() const { return {t - 1.0, -t, 1.0}; } ///< start, end, tip
};

using RowOf9 = Eigen::Matrix<double, 1, 9>;
using RowsOf9 = Eigen::Matrix<double, 3, 9>;

/// Derivative of a value by start, end and tip from those by the edge and by to_tip.
template <typename Rows, typename Part>
Rows by_corners(const Part& by_edge, const Part& by_tip)
{
    Rows result;
    result << -by_edge - by_tip, by_edge, by_tip;
    return result;
}

/// Adds the derivative of the flap's gradient.
/// @param slot  [3] numbers of start, end and tip among the four corners
void add_hessian(const Flap& flap, const std::array<int, 3>& slot, DihedralDerivatives& sum)
{
    if (!flap.has_area)
        return;
    const Vec3 along = flap.edge / flap.length, n = flap.normal.normalized();
    const double square = flap.normal.squaredNorm();
    const Mat3 turned = flap.length / square * (Mat3::Identity() - 2.0 * n * n.transpose());
    const Mat3 q_by_edge = -turned * cross_matrix(flap.to_tip) + flap.normal * along.transpose() / square;
    const Mat3 q_by_tip = turned * cross_matrix(flap.edge);
    const auto dq = by_corners<RowsOf9>(q_by_edge, q_by_tip);

    const double squared_length = flap.length * flap.length;
    const Eigen::RowVector3d t_by_edge =
        (flap.to_tip - 2.0 * flap.t * flap.edge).transpose() / squared_length;
    const Eigen::RowVector3d t_by_tip = flap.edge.transpose() / squared_length;
    const auto dt = by_corners<RowOf9>(t_by_edge, t_by_tip);

    const std::array<double, 3> weight = flap.weights(), weight_by_t = {1.0, -1.0, 0.0};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            sum.hessian.block<3, 3>(3 * slot[i], 3 * slot[j]) +=
                weight[i] * dq.middleCols<3>(3 * j) + weight_by_t[i] * flap.q * dt.middleCols<3>(3 * j);
}

/// Triangle of a, and triangle of b, over the edge in their own direction.
std::array<Flap, 2> flaps_of(const HingeCorners& x) { return {Flap(x.v0, x.v1, x.a), Flap(x.v1, x.v0, x.b)}; }

/// Numbers of start, end and tip of both flaps among v0, v1, a, b.
constexpr std::array<std::array<int, 3>, 2> kSlots{{{0, 1, 2}, {1, 0, 3}}};

} // namespace

double dihedral_angle(const HingeCorners& x)
{
    const Vec3 edge = x.v1 - x.v0;
    const Vec3 a = edge.cross(x.a - x.v0), b = (x.b - x.v1).cross(edge); // normals
    if (!(a.squaredNorm() * b.squaredNorm() > 0.0))
        return 0.0;
    return std::atan2(b.cross(a).dot(edge) / edge.norm(), a.dot(b));
}

std::array<Vec3, 4> dihedral_gradient(const HingeCorners& x)
{
    std::array<Vec3, 4> gradient;
    gradient.fill(Vec3::Zero());
    const std::array<Flap, 2> flaps = flaps_of(x);
    for (int f = 0; f < 2; ++f)
        for (int i = 0; i < 3; ++i)
            gradient[kSlots[f][i]] += flaps[f].weights()[i] * flaps[f].q;
    return gradient;
}

DihedralDerivatives dihedral_derivatives(const HingeCorners& x)
{
    DihedralDerivatives result;
    const std::array<Vec3, 4> gradient = dihedral_gradient(x);
    for (int i = 0; i < 4; ++i)
        result.gradient.segment<3>(3 * i) = gradient[i];
    const std::array<Flap, 2> flaps = flaps_of(x);
    for (int f = 0; f < 2; ++f)
        add_hessian(flaps[f], kSlots[f], result);
    result.hessian = (0.5 * (result.hessian + result.hessian.transpose())).eval(); // but for rounding
    return result;
}

} // namespace toile::garment
