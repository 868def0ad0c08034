#pragma once

#include <Eigen/Geometry>

#include "core/compute/lanes.h"

namespace toile::volume {

/// F = U diag(sigma) V^T with rotations U and V: sigma_0 >= sigma_1 >= |sigma_2|, and sigma_2 has the sign of
/// det F [Irving et al. 2004, sec. 4].
template <typename T>
struct Svd {
    Mat3Of<T> U, V;
    Vec3Of<T> sigma;
};

namespace detail {

/// Makes columns p and q of B orthogonal by a rotation, and applies it to V.
template <typename T>
TOILE_HD void orthogonalise(Mat3Of<T>& B, Mat3Of<T>& V, int p, int q)
{
    const T zero(0.0), one(1.0);
    const T a = B.col(p).squaredNorm(), b = B.col(q).squaredNorm(), between = B.col(p).dot(B.col(q));
    const auto is_skew = between * between > T(1e-32) * a * b;
    const T zeta = (b - a) / select(is_skew, between + between, one);
    const T size = select(zeta < zero, -zeta, zeta) + square_root(one + zeta * zeta);
    const T tangent = select(is_skew, select(zeta < zero, -one, one) / size, zero);
    const T cosine = one / square_root(one + tangent * tangent), sine = tangent * cosine;
    for (Mat3Of<T>* M : {&B, &V}) {
        const Vec3Of<T> old = M->col(p);
        M->col(p) = cosine * old - sine * M->col(q);
        M->col(q) = sine * old + cosine * M->col(q);
    }
}

/// Swaps columns p and q of B and V, one of them turned round, where column q of B is longer.
template <typename T>
TOILE_HD void sort_columns(Mat3Of<T>& B, Mat3Of<T>& V, int p, int q)
{
    const auto is_longer = B.col(q).squaredNorm() > B.col(p).squaredNorm();
    for (Mat3Of<T>* M : {&B, &V})
        for (int i = 0; i < 3; ++i) {
            const T old = (*M)(i, p);
            (*M)(i, p) = select(is_longer, (*M)(i, q), old);
            (*M)(i, q) = select(is_longer, -old, (*M)(i, q));
        }
}

/// v over its length, or `other` if that is zero.
template <typename T>
TOILE_HD Vec3Of<T> unit_or(const Vec3Of<T>& v, const Vec3Of<T>& other)
{
    const T length = square_root(v.squaredNorm());
    const auto has_length = length > T(1e-150);
    const T scale = T(1.0) / select(has_length, length, T(1.0));
    Vec3Of<T> unit;
    for (int i = 0; i < 3; ++i)
        unit[i] = select(has_length, scale * v[i], other[i]);
    return unit;
}

/// A vector at right angles to the unit vector u, of length 0.5 or more.
template <typename T>
TOILE_HD Vec3Of<T> across(const Vec3Of<T>& u)
{
    const T zero(0.0);
    const auto is_along_x = u[0] * u[0] > T(1.0 / 3.0);
    return {select(is_along_x, u[1], zero), select(is_along_x, -u[0], u[2]), select(is_along_x, zero, -u[1])};
}

} // namespace detail

/// By one-sided Jacobi rotations [Hestenes 1958], which keep the relative accuracy of small singular values.
/// For F of any rank.
template <typename T>
TOILE_HD Svd<T> singular_values(const Mat3Of<T>& F)
{
    constexpr int kSweeps = 5; // the rotations converge quadratically
    Mat3Of<T> B = F;
    Svd<T> svd;
    for (int i = 0; i < 9; ++i)
        svd.V(i) = T(i % 4 == 0 ? 1.0 : 0.0);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        detail::orthogonalise(B, svd.V, 0, 1);
        detail::orthogonalise(B, svd.V, 0, 2);
        detail::orthogonalise(B, svd.V, 1, 2);
    }
    detail::sort_columns(B, svd.V, 0, 1);
    detail::sort_columns(B, svd.V, 0, 2);
    detail::sort_columns(B, svd.V, 1, 2);

    const Vec3Of<T> axis(T(1.0), T(0.0), T(0.0));
    const Vec3Of<T> u0 = detail::unit_or<T>(B.col(0), axis);
    const Vec3Of<T> free = detail::unit_or<T>(detail::across<T>(u0), axis);
    const Vec3Of<T> b1 = B.col(1);
    const Vec3Of<T> u1 = detail::unit_or<T>(b1 - u0 * u0.dot(b1), free);
    svd.U.col(0) = u0;
    svd.U.col(1) = u1;
    svd.U.col(2) = u0.cross(u1);
    for (int i = 0; i < 3; ++i)
        svd.sigma[i] = svd.U.col(i).dot(B.col(i));
    return svd;
}

} // namespace toile::volume
