#pragma once

#include "garment/energy/membrane_kernels.h"
#include "garment/energy/principal_stretch.h"
#include "garment/energy/stretch_curvature.h"

namespace toile::garment {

/// Parameters of the tension for one kind of triangle; see StretchTension.
struct TensionLimits {
    double allowed = 1.06;    ///< [-] maximum principal stretch
    double watched = 1.042;   ///< [-] stretch above which a triangle is near its limit; slivers: infinite
    double stiffness = 250.0; ///< [N/m] k
    double max_tension = 1.0; ///< [-] of k
};

/// Triangles that may carry tension.
struct TensionTriangles {
    View<const Triangle> tri;  ///< [triangles] vertex indices
    View<const Mat2> rest_inv; ///< [triangles] inverse rest edge matrices [1/m]
    View<const double> area;   ///< [triangles] rest areas [m^2]
    View<const int> kind;      ///< [triangles] into limits
    View<const TensionLimits> limits;

    TOILE_HD Mat32 deformation_gradient(int t, View<const Vec3> x) const
    {
        return garment::deformation_gradient(x, tri[t], rest_inv[t]);
    }
};

/// G - P(G), P the projection onto the matrices with singular values up to `allowed`.
TOILE_HD inline Mat32 stretch_excess(const Mat32& G, double allowed)
{
    if (!(largest_stretch(G) > allowed))
        return Mat32::Zero();
    const PrincipalStretch stretch = principal_stretch(G);
    const double first = 1.0 - allowed / std::fmax(stretch.sigma[0], allowed);
    const double second = 1.0 - allowed / std::fmax(stretch.sigma[1], allowed);
    return G.lazyProduct(stretch.with(first, second));
}

/// Selects the triangles near their limit and rotates their tension with them.
struct WatchTriangle {
    TensionTriangles triangles;
    View<const Vec3> x;          ///< [vertices] [m] at the start of the step
    View<const Mat2> tension;    ///< [triangles] T_t / k in material axes
    View<unsigned char> near;    ///< [triangles] out
    View<Mat32> rotated_tension; ///< [triangles] out if near: T_t / k of this step

    TOILE_HD void operator()(int t) const
    {
        const Mat2 T = tension[t];
        const bool is_taut = T(0, 0) != 0.0 || T(0, 1) != 0.0 || T(1, 0) != 0.0 || T(1, 1) != 0.0;
        const Mat32 F = triangles.deformation_gradient(t, x);
        near[t] = is_taut || largest_stretch(F) > triangles.limits[triangles.kind[t]].watched ? 1 : 0;
        if (near[t])
            rotated_tension[t] = closest_isometry<double>(F).lazyProduct(T);
    }
};

/// Tension force of a triangle near its limit.
struct TensionPull {
    TensionTriangles triangles;
    View<const Vec3> x;                ///< [vertices] [m]
    View<const Mat32> rotated_tension; ///< [triangles] from WatchTriangle

    /// True if the larger principal stretch is beyond the limit: det(C - a^2) < 0 or trace(C - a^2) > 0.
    TOILE_HD bool exceeds(int t) const
    {
        const Mat32 G = triangles.deformation_gradient(t, x) + rotated_tension[t];
        const double allowed = triangles.limits[triangles.kind[t]].allowed, square = allowed * allowed;
        const double u = G.col(0).squaredNorm() - square, v = G.col(1).squaredNorm() - square;
        const double shear = G.col(0).dot(G.col(1));
        return u * v < shear * shear || u > 0.0 || v > 0.0;
    }
    TOILE_HD Mat32 excess(int t) const
    {
        return stretch_excess(triangles.deformation_gradient(t, x) + rotated_tension[t],
                              triangles.limits[triangles.kind[t]].allowed);
    }
    /// Stiffness times area [J].
    TOILE_HD double weight(int t) const
    {
        return triangles.limits[triangles.kind[t]].stiffness * triangles.area[t];
    }
    TOILE_HD MembraneResponse<double> of(int t) const
    {
        const Mat32 stress = excess(t);
        MembraneResponse<double> response;
        response.energy = 0.5 * weight(t) * stress.squaredNorm();
        response.corner_gradient = stress.lazyProduct(triangles.rest_inv[t].transpose());
        response.corner_gradient *= weight(t);
        return response;
    }
    /// Second derivative per weight. The excess is convex in x, so exact and projected curvature are equal.
    TOILE_HD StretchCurvature curvature(int t) const
    {
        return excess_curvature(triangles.deformation_gradient(t, x) + rotated_tension[t],
                                triangles.limits[triangles.kind[t]].allowed);
    }
};

/// Tension of the i-th triangle near its limit, as the CPU evaluates it.
struct PullTautTriangle {
    TensionPull pull;
    View<const int> taut;                    ///< triangles
    View<MembraneResponse<double>> response; ///< [taut] out

    TOILE_HD void operator()(int i) const
    {
        if (pull.exceeds(taut[i]))
            response[i] = pull.of(taut[i]);
        else
            response[i].energy = 0.0;
    }
};

/// Tension at the vertices of triangles near their limit, as a GPU evaluates it. A fixed number of thread
/// teams processes a list of such vertices, so a short list costs next to nothing.
struct PullWatchedVertices {
    TensionPull pull;
    View<const unsigned char> near; ///< [triangles]
    View<const int> watched;        ///< vertices with a triangle that is near, ascending
    View<const int> watched_count;  ///< [1]
    View<const int> first;          ///< [vertices + 1]
    View<const int> corners;        ///< 3 * triangle + corner, ascending per vertex
    View<Vec3> gradient;            ///< [vertices] added to [N]
    View<double> energy;            ///< [vertices] added to; corner 0 of a triangle adds its energy [J]
    int team_count;

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        // All teams run the same number of batches, since a sum needs every thread of a warp.
        for (int batch = 0; batch < watched_count[0]; batch += team_count) {
            const bool has_one = is_in_range && batch + i < watched_count[0];
            const int v = watched[has_one ? batch + i : 0];
            Vec3 sum(0.0, 0.0, 0.0);
            double energy_sum = 0.0;
            for (int k = first[v] + team.thread; has_one && k < first[v + 1]; k += Team::kThreads)
                add_corner(corners[k], sum, energy_sum);
            for (int a = 0; a < 3; ++a)
                sum[a] = team.sum(1, sum[a]);
            energy_sum = team.sum(1, energy_sum);
            if (!has_one || team.thread > 0)
                continue;
            gradient[v] += sum;
            energy[v] += energy_sum;
        }
    }

private:
    TOILE_HD void add_corner(int corner_of_triangle, Vec3& sum, double& energy_sum) const
    {
        const int t = corner_of_triangle / 3, corner = corner_of_triangle % 3;
        if (!near[t])
            return;
        const MembraneResponse<double> response = pull.of(t);
        if (corner > 0) {
            sum += response.corner_gradient.col(corner - 1);
            return;
        }
        sum -= response.corner_gradient.col(0) + response.corner_gradient.col(1);
        energy_sum += response.energy;
    }
};

/// Marks vertex v if it has a triangle near its limit.
struct WatchVertex {
    View<const unsigned char> near; ///< [triangles]
    View<const int> first;          ///< [vertices + 1]
    View<const int> corners;        ///< 3 * triangle + corner
    View<unsigned char> has_near;   ///< [vertices] out

    TOILE_HD void operator()(int v) const
    {
        unsigned char found = 0;
        for (int k = first[v]; k < first[v + 1] && !found; ++k)
            found = near[corners[k] / 3];
        has_near[v] = found;
    }
};

/// Stores the tension at the minimiser.
struct RememberTension {
    TensionPull pull;               ///< x: the minimiser
    View<const unsigned char> near; ///< [triangles]
    View<Mat2> tension;             ///< [triangles] T_t / k in material axes

    TOILE_HD void operator()(int t) const
    {
        const double max_tension = pull.triangles.limits[pull.triangles.kind[t]].max_tension;
        if (!near[t] || max_tension == 0.0)
            return; // zero since the start
        const Mat32 R = closest_isometry<double>(pull.triangles.deformation_gradient(t, pull.x));
        Mat2 T = R.transpose().lazyProduct(pull.excess(t));
        const double size = T.norm();
        if (size > max_tension)
            T *= max_tension / size;
        tension[t] = T;
    }
};

/// Resets the tension of a triangle to zero.
struct ForgetTension {
    View<Mat2> tension;

    TOILE_HD void operator()(int t) const { tension[t].setZero(); }
};

} // namespace toile::garment
