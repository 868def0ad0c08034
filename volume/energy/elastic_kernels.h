#pragma once

#include "volume/energy/svd.h"

namespace toile::volume {

/// Lame's constants [Pa].
template <typename T>
struct LameOf {
    T mu;     ///< shear modulus
    T lambda; ///< 0 for a Poisson's ratio of 0
};
using Lame = LameOf<double>;

/// Derivatives of the energy per volume by the singular values of F; see ElasticSolid.
template <typename T>
struct SingularValueEnergy {
    T energy;           ///< [Pa]
    Vec3Of<T> gradient; ///< [Pa]
    Vec3Of<T> diagonal; ///< second derivatives by s_0, s_1, s_2 twice [Pa]
    Vec3Of<T> mixed;    ///< by the other two than s_k [Pa]
    Vec3Of<T> twist;    ///< (g_i + g_j) / (s_i + s_j) for the two others than k [Pa]
    Vec3Of<T> flip;     ///< (g_i - g_j) / (s_i - s_j) [Pa]
};

/// Smallest sum of two singular values [-] by which the twist is divided: those of an element that is turned
/// inside out may cancel.
constexpr double kLeastTwist = 1e-3;

template <typename T>
TOILE_HD SingularValueEnergy<T> singular_value_energy(const Vec3Of<T>& s, const LameOf<T>& lame)
{
    const T &mu = lame.mu, &lambda = lame.lambda;
    const T one(1.0), two(2.0), least(kLeastTwist);
    const T excess = s[0] * s[1] * s[2] - one; // of volume
    SingularValueEnergy<T> W;
    W.energy = T(0.5) * lambda * excess * excess;
    for (int k = 0; k < 3; ++k) {
        const T &a = s[(k + 1) % 3], &b = s[(k + 2) % 3];
        const T stretch = s[k] - one;
        W.energy += mu * stretch * stretch;
        W.gradient[k] = two * mu * stretch + lambda * excess * a * b;
        W.diagonal[k] = two * mu + lambda * a * a * b * b;
        W.mixed[k] = lambda * s[k] * (two * excess + one);
        const T sum = select(a + b > least, a + b, least);
        W.twist[k] = two * mu * (one - two / sum) + lambda * excess * s[k];
        W.flip[k] = two * mu - lambda * excess * s[k];
    }
    return W;
}

/// Energy of an element [J] and the forces on three of its corners (the first balances them).
template <typename T>
struct ElasticResponse {
    Mat3Of<T> corner_gradient; ///< dW/dx1, dW/dx2, dW/dx3 [N]; dW/dx0 is minus their sum
    T energy;
};

/// @param F         deformation gradient
/// @param rest_inv  inverse rest edge matrix [1/m]
/// @param volume    at rest [m^3]
template <typename T>
TOILE_HD ElasticResponse<T> elastic_response(const Mat3Of<T>& F, const Mat3Of<T>& rest_inv, const T& volume,
                                             const LameOf<T>& lame)
{
    const Svd<T> svd = singular_values<T>(F);
    const SingularValueEnergy<T> W = singular_value_energy<T>(svd.sigma, lame);
    Mat3Of<T> U = svd.U;
    for (int k = 0; k < 3; ++k)
        U.col(k) *= volume * W.gradient[k];
    const Mat3Of<T> stress = U.lazyProduct(svd.V.transpose());
    return {stress.lazyProduct(rest_inv.transpose()), volume * W.energy};
}

/// Second derivative of the energy per volume by F, in the axes of its singular vectors [Smith et al. 2019,
/// sec. 4]. With F' = U^T F V and k the third of i, j:
///
///   d2W / dF'_ii dF'_jj = stretch_ij,   d2W / dF'_ij^2 = shear_k,   d2W / dF'_ij dF'_ji = turn_k
template <typename T>
struct ElasticCurvature {
    Mat3Of<T> U, V;
    Mat3Of<T> stretch;     ///< symmetric [Pa]
    Vec3Of<T> shear, turn; ///< [Pa]
};

/// Sets the negative eigenvalues of a symmetric matrix to zero.
template <typename T>
TOILE_HD Mat3Of<T> positive_part(const Mat3Of<T>& A)
{
    // Shifted by more than its norm, A is positive, and its singular vectors are its eigenvectors.
    const T shift = T(1.5) * square_root(A.squaredNorm());
    Mat3Of<T> shifted = A;
    for (int k = 0; k < 3; ++k)
        shifted(k, k) += shift;
    const Mat3Of<T> V = singular_values<T>(shifted).V;
    Mat3Of<T> positive = A;
    for (int k = 0; k < 3; ++k) {
        const Vec3Of<T> v = V.col(k);
        const T eigenvalue = v.dot(A.lazyProduct(v));
        positive -= select(eigenvalue < T(0.0), eigenvalue, T(0.0)) * v.lazyProduct(v.transpose());
    }
    return positive;
}

template <typename T>
TOILE_HD ElasticCurvature<T> elastic_curvature(const Mat3Of<T>& F, const LameOf<T>& lame, bool is_projected)
{
    const T zero(0.0), half(0.5);
    const Svd<T> svd = singular_values<T>(F);
    SingularValueEnergy<T> W = singular_value_energy<T>(svd.sigma, lame);
    ElasticCurvature<T> H{svd.U, svd.V, {}, {}, {}};
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        H.stretch(k, k) = W.diagonal[k];
        H.stretch(i, j) = H.stretch(j, i) = W.mixed[k];
        if (is_projected) {
            W.twist[k] = select(W.twist[k] > zero, W.twist[k], zero);
            W.flip[k] = select(W.flip[k] > zero, W.flip[k], zero);
        }
        H.shear[k] = half * (W.twist[k] + W.flip[k]);
        H.turn[k] = half * (W.flip[k] - W.twist[k]);
    }
    if (is_projected)
        H.stretch = positive_part<T>(H.stretch);
    return H;
}

/// Blocks between the corners of an element [N/m]; those of (j, i) are the transposes of those of (i, j).
template <typename T>
struct ElasticBlocks {
    static constexpr int kCount = 10;
    Mat3Of<T> of[kCount];

    /// Number of the block of corners i <= j.
    static constexpr int number(int i, int j) { return i * (7 - i) / 2 + j; }
};

/// Second derivatives of an element between its corners.
template <typename T>
class ElasticCorners {
public:
    /// @param rest_inv  inverse rest edge matrix [1/m]
    /// @param volume    at rest [m^3]
    TOILE_HD ElasticCorners(const ElasticCurvature<T>& H, const Mat3Of<T>& rest_inv, const T& volume)
        : H_(H), volume_(volume)
    {
        for (int k = 1; k < 4; ++k)
            hats_[k] = H.V.transpose().lazyProduct(rest_inv.row(k - 1).transpose());
        hats_[0] = -hats_[1] - hats_[2] - hats_[3];
    }

    /// Block of two corners [N/m].
    TOILE_HD Mat3Of<T> block(int first, int second) const
    {
        const Vec3Of<T> a = volume_ * hats_[first];
        const Vec3Of<T>& b = hats_[second];
        Mat3Of<T> K;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            K(i, i) = H_.stretch(i, i) * a[i] * b[i] + H_.shear[k] * a[j] * b[j] + H_.shear[j] * a[k] * b[k];
            K(i, j) = H_.stretch(i, j) * a[i] * b[j] + H_.turn[k] * a[j] * b[i];
            K(j, i) = H_.stretch(i, j) * a[j] * b[i] + H_.turn[k] * a[i] * b[j];
        }
        const Mat3Of<T> UK = H_.U.lazyProduct(K);
        return UK.lazyProduct(H_.U.transpose());
    }

private:
    const ElasticCurvature<T>& H_;
    T volume_;
    Vec3Of<T> hats_[4]; ///< gradients of the corners' hat functions, in the axes of V [1/m]
};

/// @param rest_inv  inverse rest edge matrix [1/m]
/// @param volume    at rest [m^3]
template <typename T>
ElasticBlocks<T> elastic_blocks(const ElasticCurvature<T>& H, const Mat3Of<T>& rest_inv, const T& volume)
{
    const ElasticCorners<T> corners(H, rest_inv, volume);
    ElasticBlocks<T> blocks;
    for (int first = 0; first < 4; ++first)
        for (int second = first; second < 4; ++second)
            blocks.of[ElasticBlocks<T>::number(first, second)] = corners.block(first, second);
    return blocks;
}

} // namespace toile::volume
